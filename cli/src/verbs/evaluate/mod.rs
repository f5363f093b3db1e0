//! `arcade evaluate`: how well does a player do on these games?

mod subjects;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::verbs::release::in_pool;
use agents::{Budget, PlannerSpec};
use engine::{Outcome, SEMANTICS};
use evaluation::player::{Contestant, Replay};
use evaluation::run::{FORMAT, Left, Progress, Tally, Task};
use evaluation::{Entrant, Evaluation, EvaluationError, Halt, Settings};
use indicatif::ProgressBar;
use serde_json::json;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// Has a player play a snapshot or games, and records every episode.
///
/// The results folder holds settings, games and a log for each episode; `arcade report` makes tables and a page of it.
///
/// Exit status 0: all episodes have ended. 1: a cap was met before; raise it and --resume. 2: malformed. 3: network, server
/// or disk failed; --resume goes on.
///
/// Example: arcade evaluate releases/starter --player mcts:100 --out results/mcts
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A snapshot's folder; or games, folders of games, corpus games by name, `corpus` for all of them
    #[arg(value_name = "SNAPSHOT|GAME", required = true)]
    subjects: Vec<String>,
    /// A player that comes with the suite: `random`, `nil`, a planner such as `mcts:100` (docs/planners.md), `replay:FILE`
    #[arg(long, value_name = "NAME")]
    player: String,
    /// Only these of the games
    #[arg(long, value_name = "GAME", value_delimiter = ',')]
    games: Vec<String>,
    /// Only these levels, by number
    #[arg(long, value_name = "N", value_delimiter = ',')]
    levels: Vec<usize>,
    /// Forward-model calls of a decision, for planners whose name has none
    #[arg(long, value_name = "CALLS", default_value_t = 1000)]
    budget: u64,
    /// Episodes on each level
    #[arg(long, value_name = "N", default_value_t = 1)]
    runs: u64,
    /// Decisions of an episode at most
    #[arg(long, value_name = "N", default_value_t = 1000)]
    max_steps: u64,
    /// Text that the games' chance comes from: the same for every player, so that runs are paired
    #[arg(long, value_name = "TEXT", default_value = "evaluate")]
    seed: String,
    /// Folder for the results, absent or empty; default: results/ and the player's name
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Go on with what is in the folder
    #[arg(long)]
    resume: bool,
    /// Load games as the reference engine does: overlook faults that it overlooks
    #[arg(long)]
    as_reference: bool,
    /// Episodes at a time; all cores if not given. Changes no result
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

/// Who plays, as it was asked for.
enum Asked {
    Planner(PlannerSpec),
    Replay(Replay),
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.runs == 0 || args.max_steps == 0 {
        return Err(Failure::malformed("--runs and --max-steps take a number, at least 1"));
    }
    let asked = asked(&args.player)?;
    let choice =
        subjects::Choice { games: &args.games, levels: &args.levels, as_reference: args.as_reference };
    let subjects = subjects::read(&args.subjects, &choice)?;
    let entrant = entrant(&asked, args);
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from("results").join(file_name(&entrant.name)));
    let settings = Settings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: env!("CARGO_PKG_VERSION").to_owned(),
        snapshot: subjects.snapshot,
        entrant,
        seed: args.seed.clone(),
        runs: args.runs,
        max_steps: args.max_steps,
        games: Evaluation::entries(&subjects.games),
    };
    let evaluation = if args.resume && folder.exists() {
        Evaluation::resume(&folder, &settings)
    } else {
        Evaluation::create(&folder, settings, subjects.games)
    };
    let evaluation = evaluation.map_err(failure)?;
    let bar = Bar::new(console, evaluation.tasks().len() as u64);
    let contestant = |_: &Task<'_>| Ok::<_, Halt>(asked.contestant(args.budget));
    let tally = in_pool(args.jobs, || evaluation.run(contestant, &bar))?.map_err(failure)?;
    bar.bar.finish_and_clear();
    told(console, &folder, &evaluation.settings.entrant.name, &tally)
}

impl Asked {
    fn contestant(&self, budget: u64) -> Contestant {
        match self {
            Asked::Planner(spec) => Contestant::Planner { spec: spec.clone(), budget: Budget(budget) },
            Asked::Replay(replay) => Contestant::Agent(Box::new(replay.clone())),
        }
    }
}

fn asked(player: &str) -> Result<Asked, Failure> {
    if let Some(file) = player.strip_prefix("replay:") {
        let episode = crate::episodes::read(std::path::Path::new(file))?;
        return Ok(Asked::Replay(Replay::of(&episode)));
    }
    let name = if player == "nil" { "do-nothing" } else { player };
    name.parse().map(Asked::Planner).map_err(Failure::malformed)
}

/// Who plays, as results call it.
fn entrant(asked: &Asked, args: &Args) -> Entrant {
    let (name, details) = match asked {
        Asked::Planner(spec) => {
            let budget = spec.budget().unwrap_or(Budget(args.budget));
            let looks_ahead = !matches!(spec.name(), "do-nothing" | "random" | "random-with-nil");
            let name = match looks_ahead {
                true => format!("{}:{}", spec.name(), budget.0),
                false => spec.name().to_owned(),
            };
            (name, json!({ "planner": spec.name(), "budget": budget }))
        }
        Asked::Replay(_) => (args.player.clone(), json!({ "replay": args.player })),
    };
    Entrant { name, mode: None, aids: Vec::new(), details }
}

fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '-' | '_' | '.') { c } else { '-' }).collect()
}

/// What came of it.
fn told(console: &Console, folder: &std::path::Path, player: &str, tally: &Tally) -> Answer {
    console.document(&json!({ "results": folder, "player": player, "tally": tally }))?;
    let Tally { episodes, ended, won, open, halted, infrastructure } = tally;
    console.say(format_args!("{player}: {ended} of {episodes} episodes played, {won} won"));
    console.say(format_args!("results in {}", folder.display()));
    if let Some(why) = halted {
        console.say(format_args!("{open} episodes are open: {why}; --resume goes on with them"));
    }
    match (halted, infrastructure) {
        (Some(why), true) => {
            Err(Failure::surroundings(anyhow::anyhow!("{why}"), "not all episodes were played"))
        }
        _ => Ok(*open == 0),
    }
}

pub(crate) fn failure(error: EvaluationError) -> Failure {
    match error {
        EvaluationError::Io { .. } => Failure::Surroundings(error.into()),
        EvaluationError::Malformed(_) => Failure::Malformed(error.into()),
    }
}

/// Episodes that are played, and how many were won.
struct Bar {
    bar: ProgressBar,
    won: AtomicU64,
}

impl Bar {
    fn new(console: &Console, episodes: u64) -> Bar {
        Bar { bar: console.progress(episodes, "playing"), won: AtomicU64::new(0) }
    }
}

impl Progress for Bar {
    fn episode(&self, task: &Task<'_>, left: &Left) {
        if *left == Left::Ended(Outcome::Won) {
            self.won.fetch_add(1, Ordering::Relaxed);
        }
        if let Left::Halted(halt) = left {
            self.bar.println(format!("{}: {halt}", task.file_name()));
        }
        self.bar.set_message(format!("{} won", self.won.load(Ordering::Relaxed)));
        self.bar.inc(1);
    }
}
