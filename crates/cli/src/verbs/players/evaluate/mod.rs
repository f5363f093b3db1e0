//! `arcade evaluate`: measures a player on games.

mod choice;
mod human;
mod mailbox;
mod model;
mod player;
mod progress;
mod prompt_args;
pub(crate) mod subjects;
mod track;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::flags::threads;
use crate::input::trusted::{OriginArgs, refuse};
use crate::interrupt;
use crate::paths;
use crate::protected;
use crate::shell;
use crate::whole_file;
use agents::Budget;
use base::MessagePath;
use base::count;
use choice::{Choice, ChoiceArgs};
use engine::SEMANTICS;
use evaluation::client::Spent;
use evaluation::run::{
    self, Answers, FORMAT, MAX_DECISIONS, MAX_EPISODES, SETTINGS_FILE, StoppedEpisodes, Tally, Task,
};
use evaluation::{Commitment, Entrant, Evaluation, EvaluationError, Halt, Settings, Subject, study};
use itertools::Itertools;
use model::{ConnectedModel, ModelArgs};
use player::{Connected, RequestedPlayer, reject_unused_flags, requested_player};
use progress::Bar;
use serde_json::json;
use statistics::{Design, Z95, wilson};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Lets a player play a snapshot or games, and records every episode.
///
/// The results folder contains the settings, the games and one log per episode; `arcade report` turns it into tables and a page.
///
/// Exit status 0: all episodes have ended. 1: a cap was reached first (raise it and use --resume), or the engine
/// stopped an episode because of a fault in its game. 2: malformed input. 3: network, server or disk failed; --resume
/// continues. 128 + signal, such as 130 for Ctrl-C: interrupted; --resume continues.
///
/// Example: arcade evaluate releases/starter --player mcts:100 --out results/mcts
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A snapshot's folder or .tar.zst; or games, folders of games, corpus games by name, `corpus` for all of them
    #[arg(value_name = "SNAPSHOT|GAME", required = true)]
    subjects: Vec<String>,
    /// A built-in player: `random`, `nil`, a planner such as `mcts:100` (see `arcade docs planners`), `replay:FILE`,
    /// `human`, `reflex` (see `arcade docs serve-player`), `touch-everything`; your own program, `"cmd:python3
    /// my_agent.py"` (see `arcade docs agents`); or `mailbox:DIR`, for any program or person that answers the files
    /// in a folder (see `arcade docs mailbox`)
    #[arg(long, value_name = "NAME", conflicts_with = "model")]
    player: Option<String>,
    /// The player's name in results, for a model (--model), `human` or `mailbox:DIR`
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Play only these games
    #[arg(long, value_name = "GAME", value_delimiter = ',')]
    games: Vec<String>,
    /// Play only these levels, given by number (`--games`, `--levels` and `--max-requests` limit an evaluation)
    #[arg(long, value_name = "N", value_delimiter = ',')]
    levels: Vec<usize>,
    /// Forward-model calls per decision, unless the planner's name states them [default: 1000]
    #[arg(long, value_name = "CALLS", value_parser = clap::value_parser!(u64).range(0..=Budget::MOST.0))]
    budget: Option<u64>,
    /// Number of episodes per level
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=MAX_EPISODES))]
    runs: u64,
    /// Maximum number of actions per episode [default: 1000, or the limit of the --scale]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_DECISIONS))]
    max_steps: Option<u64>,
    /// Actions that the player commits to per decision: a number, or `all` for the whole episode
    #[arg(long, value_name = "K", default_value_t = Commitment::ONE, allow_hyphen_values = true)]
    commit: Commitment,
    /// Text to derive the games' randomness from: the same for every player, so that runs are paired
    #[arg(long, value_name = "TEXT", default_value = evaluation::reference::SEED)]
    seed: String,
    /// Folder for the results (new or empty) [default: results/ and the player's name]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Resume the evaluation in the --out folder
    #[arg(long)]
    resume: bool,
    /// Load games as the reference engine does, and tolerate the faults that it tolerates
    #[arg(long)]
    as_reference: bool,
    /// Only print the forecast
    #[arg(long)]
    dry_run: bool,
    /// Continue even if the first 20 answers are all unusable
    #[arg(long)]
    keep_going: bool,
    #[command(flatten)]
    origin: OriginArgs,
    #[command(flatten)]
    choice: ChoiceArgs,
    #[command(flatten)]
    model: ModelArgs,
}

/// The default for `--budget`.
const BUDGET: u64 = 1000;

/// The default for `--max-steps`.
const MAX_STEPS: u64 = 1000;

/// The file in a results folder that records the checks passed by the release's root.
const ORIGIN_FILE: &str = "origin.json";

impl Args {
    fn wanted(&self) -> subjects::Wanted<'_> {
        subjects::Wanted {
            subjects: &self.subjects,
            games: &self.games,
            levels: &self.levels,
            as_reference: self.as_reference,
        }
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let requested = requested_player(args)?;
    track::check(args, &requested)?;
    reject_unused_flags(args, &requested)?;
    let mut subjects = subjects::read(&args.wanted())?;
    let origin = match (args.origin.is_empty(), &subjects.release, subjects.snapshot) {
        (true, ..) => None,
        (false, Some(name), Some(root)) => {
            match args.origin.check(Path::new(&args.subjects[0]), name, root)? {
                Ok(origin) => Some(origin),
                Err(problems) => return refuse(&problems, console),
            }
        }
        (false, ..) => bail!("--root and --key require a snapshot: pass one, or omit them"),
    };
    let mut settings = Settings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: env!("CARGO_PKG_VERSION").to_owned(),
        snapshot: subjects.snapshot,
        entrant: with_limits(requested.entrant(args, &subjects.games)?, args),
        seed: args.seed.clone(),
        runs: args.runs,
        max_steps: args.max_steps.unwrap_or(MAX_STEPS),
        commit: args.commit,
        max_output_tokens: args.model.client.max_output_tokens(),
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(&subjects.games),
    };
    if let Some(track) = args.model.prompt.track {
        settings = settings.on_track(track).map_err(Failure::malformed)?;
    }
    let mut choice = choice::choose(args, &requested, &mut settings, &mut subjects.games, console)?;
    settings
        .check()
        .map_err(|problem| malformed!("{problem}; see --runs, --max-steps, --games and --levels"))?;
    requested.check(&settings, &subjects.games)?;
    track::advise(args.model.prompt.track, &subjects.games, console);
    if let Choice::Planned(plan) = &choice {
        if args.only_plans() {
            return choice::print(plan, &settings, console);
        }
        console.remark(choice::words(plan));
    }
    if args.dry_run {
        return forecast(&requested, &settings, &subjects.games, console);
    }
    if let Some(warning) = settings.out_of_reach() {
        console.remark(format_args!("warning: {warning}; raise --max-steps"));
    }
    let folder = args.out.clone().unwrap_or_else(|| default_folder(&settings.entrant));
    protected::check(&folder)?;
    if args.resume && !Evaluation::is_begun(&folder) {
        bail!(
            "there is nothing to resume in {}; pass the evaluation's folder with --out, or omit --resume to \
             start a new evaluation",
            folder.in_message()
        );
    }
    let Connected { contestant, model, mailbox } =
        requested.connect(args, &settings, &subjects.games, console)?;
    let is_new = !(args.resume && folder.join(SETTINGS_FILE).exists());
    let evaluation = match is_new {
        true => Evaluation::create(&folder, settings, subjects.games),
        false => Evaluation::resume(&folder, &settings),
    };
    let evaluation = evaluation?;
    if let Some(origin) = origin {
        let mut text = serde_json::to_string_pretty(&origin).expect("checked settings are plain data");
        text.push('\n');
        whole_file::write(&folder.join(ORIGIN_FILE), text.as_bytes())?;
    }
    // Spending in earlier runs of this evaluation counts towards the caps.
    if let Some(model) = &model {
        for task in evaluation.tasks() {
            model.caps.charge_logged(&evaluation.events(&task)?);
        }
    }
    let hint = format!(
        "interrupted: finished episodes are in {}; run the same command with --resume to continue",
        folder.in_message()
    );
    interrupt::watch(end_players, hint);
    let episodes = evaluation.settings.adaptive.as_ref().map(|adaptive| adaptive.episodes as usize);
    let episodes = episodes.unwrap_or_else(|| evaluation.tasks().len());
    let bar = Bar {
        bar: console.progress(episodes as u64, "playing"),
        won: AtomicU64::new(0),
        limited: AtomicU64::new(0),
        console,
        refused: AtomicBool::new(false),
        keep_going: args.keep_going,
        logs: folder.join("episodes"),
        mailbox: mailbox.clone(),
    };
    let contestant = |task: &Task<'_>| Ok::<_, Halt>(contestant(task));
    let at_once = requested.threads(args, episodes, console);
    let tally = threads::on(at_once, || match &mut choice {
        Choice::Adaptive(choice) => {
            evaluation.run_chosen(contestant, &bar, |played| choice.next(&evaluation.settings, played))
        }
        Choice::All | Choice::Planned(_) => evaluation.run(contestant, &bar),
    });
    interrupt::defer();
    let tally = tally?.map_err(|error| Failure::from(error).resumable("evaluation"))?;
    bar.bar.finish_and_clear();
    if let Some(mailbox) = &mailbox {
        mailbox.finish(&tally)?;
    }
    if let Choice::Adaptive(choice) = &choice {
        console.remark(choice::record(choice, &folder)?);
    }
    let limited = bar.limited.load(Ordering::Relaxed);
    let settings = evaluation.settings.clone();
    // If the model's name is wrong, there is nothing to resume.
    let is_refused =
        is_new && tally.infrastructure && tally.ended == 0 && mailbox.is_none() && bar.is_refused();
    if is_refused && evaluation.delete_if_unplayed()? {
        let why = tally.halted.clone().unwrap_or_default();
        return Err(Failure::environment(
            anyhow::anyhow!("{why}"),
            "no request was answered, so no results folder was kept; correct the command and run it again",
        ));
    }
    print_results(console, &folder, &settings, &tally, limited, model.as_deref())
}

/// Prints the expected effort, and the differences between players that the evaluation could detect.
fn forecast(
    requested: &RequestedPlayer,
    settings: &Settings,
    subjects: &[Subject],
    console: &Console,
) -> Answer {
    let tasks = run::tasks(settings, subjects);
    let (mut document, text) = match requested {
        RequestedPlayer::Model(model) => {
            let forecast = model.forecast(&tasks)?;
            (json!(forecast), forecast.to_string())
        }
        _ => {
            // A game's Timeout may end an episode before --max-steps.
            let most = || tasks.iter().map(Task::most_steps);
            let (episodes, longest, steps) = (tasks.len(), most().max(), most().sum::<u64>());
            let longest = longest.unwrap_or(settings.max_steps);
            let [longest_in_words, in_total] = [longest, steps].map(|steps| count(steps as usize, "step"));
            let text = format!(
                "{} of at most {longest_in_words} each, {in_total} in total, at no cost",
                count(episodes, "episode")
            );
            (json!({ "episodes": episodes, "max_steps": longest, "steps": steps }), text)
        }
    };
    let levels: u64 = subjects.iter().map(|subject| subject.levels.len() as u64).sum();
    let games = subjects.len() as u64;
    let planned = Design { games, levels: levels.div_ceil(games), runs: settings.runs };
    let power = study::power(planned);
    document["power"] = json!(power);
    let out_of_reach = settings.out_of_reach();
    document["out_of_reach"] = json!(out_of_reach);
    console.document(&document)?;
    console.say(text);
    if let Some(warning) = out_of_reach {
        console.say(format_args!("warning: {warning}; raise --max-steps"));
    }
    console.say(format_args!("\n{}", study::power_table(&power).to_markdown().trim_end()));
    Ok(true)
}

/// Adds the commitment (the number of actions per decision) and the maximum number of tokens per answer to the settings
/// that distinguish the player from other players.
fn with_limits(mut entrant: Entrant, args: &Args) -> Entrant {
    entrant.aids.extend(args.commit.aid());
    entrant.aids.extend(args.model.client.max_output_tokens().map(evaluation::budget_aid));
    entrant.aids.sort();
    entrant
}

fn end_players() {
    #[cfg(unix)]
    evaluation::player::process::end_all();
}

/// Returns the default results folder: the player's name within `results/`.
fn default_folder(entrant: &Entrant) -> PathBuf {
    let name = [&entrant.name].into_iter().chain(&entrant.mode).chain(&entrant.aids).join("_");
    let is_other = |c: char| !(c.is_alphanumeric() || matches!(c, '-' | '_' | '.'));
    PathBuf::from("results").join(name.replace(is_other, "-"))
}

fn print_results(
    console: &Console,
    folder: &Path,
    settings: &Settings,
    tally: &Tally,
    limited: u64,
    model: Option<&ConnectedModel>,
) -> Answer {
    let Settings { entrant, max_steps, .. } = settings;
    let spent = model.map(|model| {
        let spent = model.caps.spent();
        (spent, model.is_priced.then(|| spent.cost.dollars()))
    });
    let spending = spent
        .map(|(spent, cost)| json!({ "requests": spent.requests, "tokens": spent.tokens, "cost": cost }));
    console.document(
        &json!({ "results": paths::in_json(folder), "entrant": entrant, "tally": tally, "spent": spending }),
    )?;
    let Tally { episodes, ended, won, answers, open, halted, infrastructure, stopped, unfit, practice } =
        tally;
    let practice = match practice {
        0 => String::new(),
        1 => format!("; 1 of the episodes is for practice, and {} count", episodes - 1),
        _ => format!("; {practice} of the episodes are for practice, and {} count", episodes - practice),
    };
    let counted = ended.saturating_sub(tally.practice);
    let interval = wilson(*won, counted, Z95);
    let rate = match counted {
        0 => String::new(),
        _ => {
            let [value, low, high] =
                [*won as f64 / counted as f64, interval.low, interval.high].map(|share| 100.0 * share);
            format!(", {value:.0}% ({low:.0} to {high:.0}% for these levels)")
        }
    };
    console.say(format_args!(
        "{}: {ended} of {episodes} episodes played, {won} won{rate}{practice}",
        entrant.name
    ));
    for StoppedEpisodes { game, reason, episodes } in stopped {
        console.say(format_args!(
            "{game}: the engine stopped {}: {reason}; these episodes say nothing about the player, and \
             `arcade validate` shows the fault",
            count(*episodes as usize, "episode")
        ));
    }
    if !unfit.is_empty() && unfit.len() < settings.games.len() {
        console.say(format_args!(
            "the player could not be evaluated on {}; it played the other games",
            unfit.iter().join(", ")
        ));
    }
    if let Some((Spent { requests, tokens, .. }, cost)) = spent {
        let cost = cost.map_or("cost unknown".to_owned(), |cost| format!("{cost:.4} USD"));
        console.say(format_args!("{requests} requests, {tokens} tokens, {cost}"));
    }
    if answers.unusable > 0 {
        console.remark(useless(answers, &folder.join("episodes")));
    }
    if limited > 0 {
        let (limited, limit) = (count(limited as usize, "episode"), count(*max_steps as usize, "step"));
        console.remark(format_args!(
            "{limited} reached the limit of {limit}, and counted as not won. To allow more steps, start a new evaluation; \
             --resume cannot raise the limit."
        ));
    }
    let open = match *open {
        1 => "1 episode is unfinished".to_owned(),
        _ => format!("{open} episodes are unfinished"),
    };
    console.say(format_args!("results in {}", folder.in_message()));
    if *ended > 0 {
        let mut names = (1..).map(|number| match number {
            1 => PathBuf::from("report"),
            _ => PathBuf::from(format!("report-{number}")),
        });
        let report = names.find(|name| !name.exists()).unwrap_or_default();
        let words = [Path::new("report"), folder, Path::new("--out"), &report];
        console.say(format_args!("next: {}", shell::command(words)));
    }
    match halted {
        Some(why) if *infrastructure => Err(Failure::environment(
            anyhow::anyhow!("{why}"),
            format_args!("{open}; continue with --resume"),
        )),
        Some(why) => {
            // No reason other than a cap mentions one of these flags.
            let caps = ["--max-cost", "--max-tokens", "--max-requests"];
            let raised = caps.into_iter().find(|flag| why.contains(flag));
            let raised = raised.map_or(String::new(), |flag| format!(" and a higher {flag}"));
            console.say(format_args!("{open}: {why}; continue with --resume{raised}"));
            Ok(false)
        }
        None => Ok(tally.open == 0 && stopped.is_empty()),
    }
}

/// Returns a warning about decisions that got no usable answer.
fn useless(answers: &Answers, logs: &Path) -> String {
    let longer = if answers.truncated > 0 {
        "; raise --max-output-tokens for the answers that were cut off"
    } else {
        ""
    };
    format!(
        "warning: {answers}, so the player did nothing in them; the answers are in {}{longer}",
        logs.in_message()
    )
}

impl From<EvaluationError> for Failure {
    fn from(error: EvaluationError) -> Failure {
        match error {
            EvaluationError::Io { action: "read", path, source } => Failure::read(&path, source),
            error @ EvaluationError::Io { .. } => Failure::Environment(error.into()),
            error => Failure::Malformed(error.into()),
        }
    }
}
