//! `arcade report`: compares evaluation results.

use crate::console::Console;
use crate::failure::Answer;
use crate::input::trusted::{digest, refuse};
use crate::paths;
use crate::protected;
use base::Digest;
use base::MessagePath;
use evaluation::study::Study;
use evaluation::{Evaluation, EvaluationError};
use pages::{Results, evaluation_report};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Compares the results of evaluations in tables, plots and a single HTML page.
///
/// Every number is recomputed from the logs, whose episodes are replayed. The command writes to DIR: report.html (one
/// file, for any browser), report.md, report.json, and every table as tables/*.csv and tables/*.tex.
///
/// Example: arcade report results/random results/mcts-100 --out report
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Results folders written by `arcade evaluate`
    #[arg(value_name = "RESULTS", required = true)]
    results: Vec<PathBuf>,
    /// Folder for the report (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Number of episodes per player that the page shows step by step, failures first; 0 for none
    #[arg(long, value_name = "N", default_value_t = 4)]
    replays: usize,
    /// The published root of the release to which all results must belong
    #[arg(long, value_name = "DIGEST", value_parser = digest)]
    root: Option<Digest>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    // A non-empty output folder is reported before the work starts.
    if std::fs::read_dir(&args.out).is_ok_and(|mut entries| entries.next().is_some()) {
        let mut names = (2..).map(|number| PathBuf::from(format!("{}-{number}", args.out.display())));
        let free = names.find(|free| !free.exists()).unwrap_or_default();
        bail!(
            "`{}` is not empty, and a report never overwrites files: delete it, or pass --out {}",
            args.out.in_message(),
            crate::shell::quoted(&free)
        );
    }
    let draft = protected::draft(&args.out)?;
    let open = |folder: &PathBuf| Evaluation::open(folder);
    let evaluations = args.results.iter().map(open).collect::<Result<Vec<_>, EvaluationError>>();
    let evaluations = evaluations?;
    if let Some(root) = args.root {
        let other =
            args.results.iter().zip(&evaluations).filter(|(_, found)| found.settings.snapshot != Some(root));
        let problems: Vec<String> = other
            .map(|(folder, found)| match found.settings.snapshot {
                Some(on) => format!(
                    "`{}`: the results belong to the release with root {on}, not {root}",
                    folder.in_message()
                ),
                None => format!(
                    "`{}`: these results do not belong to a release; evaluate a release folder",
                    folder.in_message()
                ),
            })
            .collect();
        if !problems.is_empty() {
            return refuse(&problems, console);
        }
    }
    let study = Study::read(&args.results)?;
    if study.episodes.is_empty() && study.left_out.is_empty() {
        bail!(
            "these results do not contain any played episodes yet; `arcade evaluate … --resume` plays them"
        );
    }
    let results = Results { study: &study, evaluations: &evaluations, replays: args.replays };
    let files = protected::publish(draft, evaluation_report(&results)?)?;
    console.document(&summary(args, &study, &files))?;
    for row in &study.leaderboard {
        let rate = row.scores.win_rate.map_or("–".to_owned(), |rate| {
            let [value, low, high] = [rate.value, rate.low, rate.high].map(|share| 100.0 * share);
            format!("{value:.0}% ({low:.0} to {high:.0})")
        });
        let (player, wins, episodes) =
            (study.players[row.player].label(), row.scores.wins, row.scores.episodes);
        console.say(format_args!("{player}: {wins} of {episodes} won, {rate}"));
    }
    if let Some(lead) = study.verdict().first() {
        console.say(lead);
    }
    study.notes.iter().for_each(|note| console.remark(note));
    console.say(format_args!("report in {}", args.out.join("report.html").in_message()));
    Ok(true)
}

fn summary(args: &Args, study: &Study, files: &[String]) -> Value {
    let players: Vec<Value> = study
        .leaderboard
        .iter()
        .map(|row| {
            let player = &study.players[row.player];
            json!({
                "player": player,
                "reference": player.is_reference(),
                "scores": row.scores,
                "bounds": row.bounds,
                "choices": row.choices,
                "spending": row.spending,
                "broken_off": row.aborted,
            })
        })
        .collect();
    let ended = study.episodes.iter().filter(|episode| episode.metrics.counts()).count();
    json!({
        "report": paths::in_json(&args.out),
        "root_compared": args.root.is_some(),
        "files": files,
        "episodes": study.episodes.len(),
        "ended": ended,
        "players": players,
        "verdict": study.verdict(),
        "notes": study.notes,
    })
}
