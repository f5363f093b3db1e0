//! `arcade study scale`: computes players' abilities on a common scale across releases.

use crate::console::Console;
use crate::failure::Answer;
use crate::paths;
use base::count;
use evaluation::scale::{MonthAbility, PersonAbility, Refusal, ScaleFile, abilities, played};
use itertools::Itertools;
use report::visible;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Places players on a scale: their ability on each release, with a breakdown of the error.
///
/// Ability and difficulty are in logits above the mean difficulty of the scale's first release. The error has three
/// parts (see `arcade docs scale`). Sampling depends on the number of episodes. Mismatch is due to games that suit the
/// player well or badly. Link is the error of the release's position relative to the first release.
///
/// Exit status 0: all players are placed. 1: a player cannot be placed; the message says what is needed. 2: malformed
/// input.
///
/// Example: arcade study scale results/a-model/2026-11 results/a-model/2026-12 --scale scales/2026-12/scale.json
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Results folders written by `arcade evaluate`
    #[arg(value_name = "RESULTS", required = true)]
    results: Vec<PathBuf>,
    /// The scale, a scale.json written by `arcade study calibrate`
    #[arg(long, value_name = "FILE")]
    scale: PathBuf,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let scale = ScaleFile::read(&args.scale)?;
    let persons = played(&args.results, scale.max_steps)?;
    let found = abilities(&scale, &persons);
    if found.iter().all(|person| person.months.is_empty() && person.left_out.is_empty()) {
        bail!(
            "no level in these results is on the scale; evaluate a release that is on the scale: {}",
            scale.months.iter().map(|month| visible(&month.name)).join(", ")
        );
    }
    console.document(&json!({ "scale": paths::in_json(&args.scale), "players": found }))?;
    for person in &found {
        console.say(format_args!("{}", person.player));
        for month in &person.months {
            console.say(format_args!("  {}: {}", visible(&month.month), words(month)));
        }
        if person.unknown > 0 {
            console.remark(format_args!(
                "{}: {} episodes on levels that are not on the scale were left out",
                person.player, person.unknown
            ));
        }
        left_out(&person.player, &person.left_out, scale.max_steps)
            .iter()
            .for_each(|line| console.remark(line));
    }
    let is_placed = |person: &PersonAbility| {
        let is_out = person.months.is_empty() && !person.left_out.is_empty();
        !is_out && person.months.iter().all(|month| month.ability.is_some())
    };
    Ok(found.iter().all(is_placed))
}

/// Returns one line for each difference in settings because of which some of the player's episodes were left
/// out.
pub(crate) fn left_out(player: &str, left_out: &BTreeMap<String, u64>, max_steps: u64) -> Vec<String> {
    let line = |(flags, &episodes): (&String, &u64)| {
        let (episodes, were) =
            (count(episodes as usize, "episode"), if episodes == 1 { "was" } else { "were" });
        format!(
            "{player}: {episodes} with {flags} {were} left out: the scale requires the track `told`, \
             --commit 1 and --max-steps {max_steps}; evaluate the player with these settings"
        )
    };
    left_out.iter().map(line).collect()
}

fn words(month: &MonthAbility) -> String {
    let MonthAbility { won, episodes, games, .. } = month;
    let played = format!("{won} of {episodes} won, {games} games");
    if let Some(Refusal::FewAnchors { anchors, correlation_low }) = &month.refusal {
        let low = correlation_low
            .map_or("is not known".to_owned(), |low| format!("may be as low as {low:.2}, below 0.5"));
        let anchors = count(*anchors as usize, "anchor");
        return format!(
            "not placed ({played}): only planners and {anchors} played this release, and the correlation \
             between the difficulty for planners and for readers {low}; calibrate the release with at \
             least two anchors, which are readers that also played the first release (--readers)"
        );
    }
    let (Some(found), Some(error)) = (month.ability, month.error) else {
        return format!("not placed ({played}): no episode has ended");
    };
    let interval = match month.is_bounded {
        [true, true] => format!("{:+.2} ({:+.2} to {:+.2})", found.value, found.low, found.high),
        [false, _] => format!("below {:+.2}, with no win", found.high),
        [_, false] => format!("above {:+.2}, with no loss", found.low),
    };
    let drift = month.drift.filter(|drift| drift.value.abs() > 1.96 * drift.error);
    let drift = drift.map_or(String::new(), |drift| {
        format!("; anchors indicate a drift of {:+.2} in this release", drift.value)
    });
    format!(
        "{interval}; error {:.2}: sampling {:.2}, mismatch {:.2}, link {:.2} ({played}){drift}",
        error.total, error.sampling, error.mismatch, error.link
    )
}
