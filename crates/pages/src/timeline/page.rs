//! The timeline page, a single self-contained HTML file without scripts.

use super::told;
use crate::PageError;
use crate::page::facts::Fact;
use crate::page::plots::{MonthPlot, MonthPoint, MonthSeries, over_months};
use crate::page::tables::Shown;
use crate::page::words;
use evaluation::scale::{Estimate, Span, Timeline, TimelinePlayer};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::Z95;

const TEMPLATE: &str = include_str!("page.html");

/// The number of distinct line colours.
const HUES: usize = 6;
/// The width and height in pixels of the plotting area for all players together.
const WIDE: [f64; 2] = [860.0, 420.0];
/// The width and height in pixels of the plotting areas in the lower plots.
const LOW: [f64; 2] = [860.0, 220.0];
/// The width and height in pixels of the plotting area for a single player.
const SMALL: [f64; 2] = [300.0, 170.0];

#[derive(Serialize)]
struct Page {
    title: String,
    subtitle: String,
    headlines: Vec<Fact>,
    answers: Vec<String>,
    refusals: Vec<String>,
    /// The plot of all players' abilities on one axis.
    abilities: String,
    /// The plots for individual players, with intervals.
    panels: Vec<Panel>,
    difficulties: String,
    /// The plot of the additional difficulty for readers (players that see only prompts). Empty if no anchor (an
    /// unchanging reader) has played.
    drift: String,
    correlation: String,
    tables: Vec<Shown>,
}

#[derive(Serialize)]
struct Panel {
    name: String,
    note: String,
    svg: String,
}

/// Renders the page. The same timeline gives identical bytes.
pub(super) fn render(timeline: &Timeline, tables: &[Table]) -> Result<String, PageError> {
    let months = timeline.months.iter().map(|month| month.name.clone()).collect_vec();
    let shown = |player: &&TimelinePlayer| player.ability.months.iter().any(|month| month.ability.is_some());
    let players = timeline.players.iter().filter(shown).collect_vec();
    let range = range(&players);
    // The lines of players placed on the scale are drawn over the lines of the reference players that define it.
    let mut lines = players
        .iter()
        .filter(|one| one.is_examinee)
        .map(|one| series(&months, one, "mark", false))
        .collect_vec();
    let placed = players.iter().filter(|one| !one.is_examinee).enumerate();
    lines.extend(placed.map(|(at, one)| series(&months, one, &format!("hue{}", at % HUES), true)));
    if lines.iter().all(|line| !line.whiskers) {
        lines.iter_mut().enumerate().for_each(|(at, line)| line.class = format!("hue{}", at % HUES));
    }
    let label = "Ability over the months, logits";
    let abilities =
        over_months(&MonthPlot { label, months: &months, series: &lines, range, plane: WIDE, names: true });
    let mut hue = 0;
    let panels = players.iter().map(|player| {
        let class = match player.is_examinee {
            true => "mark".to_owned(),
            false => {
                hue += 1;
                format!("hue{}", (hue - 1) % HUES)
            }
        };
        let line = [series(&months, player, &class, true)];
        let plot = MonthPlot {
            label: &player.ability.player,
            months: &months,
            series: &line,
            range,
            plane: SMALL,
            names: false,
        };
        let note =
            player.change.as_ref().map_or("no month with wins and losses to compare".to_owned(), |change| {
                let Span { value, low, high } = change.from_first_to_last;
                format!(
                    "last − first {value:+.2} ({low:+.2} to {high:+.2}); p {} for no change",
                    TableCell::Probability(change.p).plain()
                )
            });
        Panel { name: player.ability.player.clone(), note, svg: over_months(&plot) }
    });
    let page = Page {
        title: told::title(timeline),
        subtitle: told::subtitle(timeline),
        headlines: headlines(timeline),
        answers: told::answers(timeline),
        refusals: told::refusals(timeline),
        abilities,
        panels: panels.collect(),
        difficulties: difficulties(timeline, &months),
        drift: drift(timeline, &months),
        correlation: timeline
            .correlation
            .map_or(String::new(), |Span { value, low, high }| format!("{value:.2} ({low:.2} to {high:.2})")),
        tables: tables.iter().map(Shown::of).collect(),
    };
    crate::page::render(&[], TEMPLATE, &page)
}

fn headlines(timeline: &Timeline) -> Vec<Fact> {
    let best = timeline.players.iter().filter(|player| !player.is_examinee).take(3);
    let mut facts = best
        .filter_map(|player| {
            let change = player.change.as_ref()?;
            let half = Z95 * change.mean.error;
            let band = format!("{:+.2} to {:+.2}", change.mean.value - half, change.mean.value + half);
            let fact = Fact::plain(&*player.ability.player, told::signed(change.mean.value));
            Some(fact.of("mean ability".to_owned()).within(band))
        })
        .collect_vec();
    let (changed, tested) = timeline.changed();
    facts.push(Fact::plain("players changed", changed.len().to_string()).of(format!("of {tested}")));
    if let Some((hardest, easiest)) = told::extremes(timeline) {
        let range = hardest.planners_shift.value - easiest.planners_shift.value;
        facts.push(
            Fact::plain("hardest − easiest month", format!("{range:.2}"))
                .of("logits, for planners".to_owned()),
        );
    }
    let measured = timeline.months.iter().filter(|month| month.drift.is_some()).count();
    let flagged = timeline.months.iter().filter(|month| month.is_drift_flagged).count();
    let value = if measured == 0 { words::NONE.to_owned() } else { flagged.to_string() };
    facts.push(Fact::plain("months with drift", value).of(format!("of {measured}")));
    facts
}

/// Returns a player's line in a plot over the months.
fn series(months: &[String], player: &TimelinePlayer, class: &str, whiskers: bool) -> MonthSeries {
    let point = |name: &String| {
        let month = player.ability.months.iter().find(|month| month.month == *name)?;
        let Span { value, low, high } = month.ability?;
        Some(MonthPoint { value, band: [low, high], is_bounded: month.is_bounded })
    };
    let points = months.iter().map(point).collect();
    MonthSeries { name: player.ability.player.clone(), class: class.to_owned(), points, whiskers }
}

/// Returns the range of the ability axis. It includes all abilities whose intervals have two ends, and the part of
/// each interval that is within two logits of its ability.
fn range(players: &[&TimelinePlayer]) -> [f64; 2] {
    let months = players.iter().flat_map(|player| &player.ability.months);
    let spans = months.filter(|month| month.is_bounded == [true, true]).filter_map(|month| month.ability);
    let ends =
        spans.map(|span| [span.low.max(span.value - 2.0), span.high.min(span.value + 2.0)]).collect_vec();
    whole(&ends)
}

/// Returns the smallest range that has integer logits at its ends, and includes −0.5 to 0.5 and all given ranges.
fn whole(ends: &[[f64; 2]]) -> [f64; 2] {
    let least = ends.iter().fold(0.0_f64, |least, [low, _]| least.min(*low));
    let most = ends.iter().fold(0.0_f64, |most, [_, high]| most.max(*high));
    [libm::floor(least.min(-0.5)), libm::ceil(most.max(0.5))]
}

fn estimates(name: &str, class: &str, all: impl Iterator<Item = Option<Estimate>>) -> MonthSeries {
    let point = |one: Estimate| {
        let half = Z95 * one.error;
        MonthPoint { value: one.value, band: [one.value - half, one.value + half], is_bounded: [true, true] }
    };
    let points = all.map(|one| one.map(point)).collect();
    MonthSeries { name: name.to_owned(), class: class.to_owned(), points, whiskers: true }
}

/// Returns the interval ends of all given lines.
fn ends(lines: &[MonthSeries]) -> Vec<[f64; 2]> {
    lines.iter().flat_map(|line| &line.points).flatten().map(|point| point.band).collect()
}

fn difficulties(timeline: &Timeline, months: &[String]) -> String {
    let of = |side: usize| timeline.months.iter().map(move |month| Some(month.shifts[side]));
    let these = timeline.months.iter().map(|month| Some(month.planners_shift));
    let lines = [
        estimates("these planners", "hue0", these),
        estimates("any planner", "mark", of(0)),
        estimates("any reader", "hue1", of(1)),
    ];
    let label = "Mean difficulty above the first month, logits";
    over_months(&MonthPlot {
        label,
        months,
        series: &lines,
        range: whole(&ends(&lines)),
        plane: LOW,
        names: true,
    })
}

fn drift(timeline: &Timeline, months: &[String]) -> String {
    let lines = [estimates("drift", "hue1", timeline.months.iter().map(|month| month.drift))];
    if lines[0].points.iter().all(Option::is_none) {
        return String::new();
    }
    let label = "Drift according to anchors, logits";
    over_months(&MonthPlot {
        label,
        months,
        series: &lines,
        range: whole(&ends(&lines)),
        plane: LOW,
        names: false,
    })
}
