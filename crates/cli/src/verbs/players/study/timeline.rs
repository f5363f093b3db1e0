//! `arcade study timeline`: shows all months of a scale on one page.

use super::scale::left_out;
use crate::console::Console;
use crate::failure::Answer;
use crate::paths;
use crate::protected;
use base::MessagePath;
use evaluation::scale::{ScaleFile, Timeline, played};
use itertools::Itertools;
use pages::timeline_report;
use report::TableCell;
use serde_json::json;
use std::path::PathBuf;

/// Shows the months of a scale on one page: abilities of players over the months, difficulties, drift, and who played what.
///
/// Use the scale with the latest month, which includes all earlier ones. Results may be from any of its months, in any
/// order. The results that calibrated it, in plays/ beside each scale.json, show how constant the examinees are. The
/// command writes to DIR: timeline.html (one file, for any browser), timeline.json, and every table as tables/*.csv and
/// tables/*.tex (see `arcade docs timeline`).
///
/// Exit status 0: written. 2: malformed input.
///
/// Example: arcade study timeline results/*/* scales/*/plays/* --scale scales/2027-12/scale.json --out timeline
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Results folders written by `arcade evaluate`
    #[arg(value_name = "RESULTS", required = true)]
    results: Vec<PathBuf>,
    /// The scale with all months, a scale.json written by `arcade study calibrate`
    #[arg(long, value_name = "FILE")]
    scale: PathBuf,
    /// Folder for the page and its numbers (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    // A non-empty output folder is reported before the work starts.
    let draft = protected::draft(&args.out)?;
    let scale = ScaleFile::read(&args.scale)?;
    let persons = played(&args.results, scale.max_steps)?;
    let timeline = Timeline::of(&scale, &persons);
    if timeline.players.iter().all(|player| player.ability.months.is_empty()) {
        let remarks = persons
            .iter()
            .flat_map(|person| left_out(&person.player.label(), &person.left_out, scale.max_steps));
        remarks.for_each(|line| console.remark(line));
        bail!(
            "no episode in these results is on the scale; evaluate a release that is on the scale: {}",
            scale.months.iter().map(|month| &month.name).join(", ")
        );
    }
    let files = protected::publish(draft, timeline_report(&timeline)?)?;
    console.document(&json!({ "timeline": paths::in_json(&args.out), "files": files }))?;
    for player in &timeline.players {
        let name = &player.ability.player;
        if let Some(change) = &player.change {
            let moved = change.from_first_to_last;
            console.say(format_args!(
                "{name}: {:+.2} over {} months, last − first {:+.2} ({:+.2} to {:+.2}), p {} for no change",
                change.mean.value,
                change.months,
                moved.value,
                moved.low,
                moved.high,
                TableCell::Probability(change.p).plain()
            ));
        }
        if player.ability.unknown > 0 {
            console.remark(format_args!(
                "{name}: {} episodes on levels that are not on the scale were left out",
                player.ability.unknown
            ));
        }
        left_out(name, &player.ability.left_out, scale.max_steps)
            .iter()
            .for_each(|line| console.remark(line));
    }
    console.say(format_args!("timeline in {}", args.out.join("timeline.html").in_message()));
    Ok(true)
}
