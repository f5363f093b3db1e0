//! Descriptions of the timeline in sentences.

use crate::page::words::{self, many};
use evaluation::scale::{Estimate, Span, Timeline, TimelineMonth, TimelinePlayer};
use itertools::Itertools;
use statistics::Z95;

/// Returns a title such as `2027-01 to 2027-12: 12 months on one scale`.
pub(super) fn title(timeline: &Timeline) -> String {
    let [first, .., last] = &timeline.months[..] else {
        return timeline.months.first().map_or(String::new(), |month| month.name.clone());
    };
    format!("{} to {}: {} on one scale", first.name, last.name, many(timeline.months.len() as u64, "month"))
}

/// Returns a line stating the numbers of levels, games, episodes and players.
pub(super) fn subtitle(timeline: &Timeline) -> String {
    let levels = timeline.months.iter().map(|month| month.levels).sum();
    let games = timeline.months.iter().map(|month| month.games).sum();
    let months = timeline.players.iter().flat_map(|player| &player.ability.months);
    let episodes = months.map(|month| month.episodes).sum();
    format!(
        "{} of {}, {} of {}, up to {} steps each",
        many(levels, "level"),
        many(games, "game"),
        many(episodes, "different episode"),
        many(timeline.players.len() as u64, "player"),
        words::grouped(timeline.max_steps)
    )
}

/// Returns the answers to the page's questions, one sentence each.
pub(super) fn answers(timeline: &Timeline) -> Vec<String> {
    let mut told = Vec::new();
    for (is_examinee, who) in [(false, "players"), (true, "players that calibrate the scale")] {
        let group = || timeline.players.iter().filter(move |player| player.is_examinee == is_examinee);
        let tested = group().filter(|player| player.change.is_some()).count() as u64;
        if tested == 0 {
            continue;
        }
        let (changed, _) = timeline.changed();
        let changed = changed.into_iter().filter(|player| player.is_examinee == is_examinee).collect_vec();
        told.push(match &changed[..] {
            [] => format!(
                "Among {} {who} with two months or more, no player changed by more than the monthly errors \
                 can explain.",
                words::grouped(tested)
            ),
            some => format!(
                "Among {} {who} with two months or more, {} changed by more than the monthly errors can \
                 explain: {}.",
                words::grouped(tested),
                some.len(),
                some.iter().map(|player| moved(player)).join("; ")
            ),
        });
    }
    if let Some((hardest, easiest)) = extremes(timeline) {
        let shift = |month: &TimelineMonth| match month.name == timeline.months[0].name {
            true => "0, as the first month".to_owned(),
            false => interval(month.planners_shift),
        };
        told.push(format!(
            "For the planners of the scale, {} was the hardest month ({}) and {} the easiest ({}), in logits above the first month.",
            hardest.name,
            shift(hardest),
            easiest.name,
            shift(easiest)
        ));
    }
    let measured = timeline.months.iter().filter(|month| month.drift.is_some()).collect_vec();
    let flagged =
        measured.iter().filter(|month| month.is_drift_flagged).map(|month| month.name.as_str()).join(", ");
    told.push(match (measured.len(), flagged.is_empty()) {
        (0, _) => "No readers that stay the same (anchors) played the later months, so drift cannot be \
                   measured."
            .to_owned(),
        (count, true) => format!(
            "According to the anchors, there is no drift in the {} that could be compared with the first.",
            many(count as u64, "month")
        ),
        (count, false) => format!(
            "According to the anchors, there is drift in {flagged}, out of the {} that could be compared with \
             the first. Without any drift, one month in twenty would be flagged, but not independently: all \
             months are compared with the same first month.",
            many(count as u64, "month")
        ),
    });
    told
}

/// Returns the reasons why abilities are missing in some months, one sentence per player.
pub(super) fn refusals(timeline: &Timeline) -> Vec<String> {
    let mut told = Vec::new();
    for player in &timeline.players {
        let name = &player.ability.player;
        let refused = player.ability.months.iter().filter(|month| month.refusal.is_some()).collect_vec();
        if !refused.is_empty() {
            told.push(format!(
                "{name} is not placed in {}: a reader needs two anchors (readers that stay the same), or a \
                 closer correlation between the difficulty for planners and for readers.",
                refused.iter().map(|month| &month.month).join(", ")
            ));
        }
        for (flags, episodes) in &player.ability.left_out {
            told.push(format!(
                "{name}: {} with {flags} left out, because the scale has different settings.",
                many(*episodes, "episode")
            ));
        }
        if player.ability.unknown > 0 {
            told.push(format!(
                "{name}: {} left out, because the levels are not on the scale.",
                many(player.ability.unknown, "episode")
            ));
        }
    }
    told
}

/// Returns the hardest and the easiest month; `None` for fewer than two months.
pub(super) fn extremes(timeline: &Timeline) -> Option<(&TimelineMonth, &TimelineMonth)> {
    let order = |one: &&TimelineMonth, other: &&TimelineMonth| {
        one.planners_shift.value.total_cmp(&other.planners_shift.value)
    };
    let months = &timeline.months;
    (months.len() > 1).then(|| Some((months.iter().max_by(order)?, months.iter().min_by(order)?))).flatten()
}

fn moved(player: &TimelinePlayer) -> String {
    let name = &player.ability.player;
    player.change.as_ref().map_or_else(
        || name.clone(),
        |change| {
            let Span { value, low, high } = change.from_first_to_last;
            format!("{name} ({value:+.2} from the first to the last, {low:+.2} to {high:+.2})")
        },
    )
}

/// Formats a number with its sign, such as `+0.31`, `-0.12` or `0.00`.
pub(super) fn signed(value: f64) -> String {
    if value.abs() < 0.005 { "0.00".to_owned() } else { format!("{value:+.2}") }
}

/// Formats an estimate with its interval, such as `+0.31, -0.12 to +0.74`.
fn interval(one: Estimate) -> String {
    let half = Z95 * one.error;
    format!("{}, {} to {}", signed(one.value), signed(one.value - half), signed(one.value + half))
}
