//! `arcade run`: measures planners' win rates.

use crate::console::{Console, Stopwatch};
use crate::failure::{Answer, Failure};
use crate::input;
use crate::input::game_input::GameInput;
use crate::shell;
use crate::whole_file;
use agents::{Budget, Limits, PlannerSpec, play};
use base::MessagePath;
use base::Seed;
use base::count;
use engine::{Game, Level, Limit, Outcome, SEMANTICS};
use evaluation::run::{MAX_DECISIONS, MAX_EPISODES};
use rayon::prelude::*;
use report::visible;
use serde::{Serialize, Serializer};
use statistics::{Summary, Z95, wilson};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Runs planners on games and reports win rates with 95% intervals, per game and pooled.
///
/// Exit status 0: done. 1: the engine stopped an episode because of a fault in its game, so that the rate says nothing about the
/// player.
///
/// Example: arcade run corpora --planner random,mcts,olets:500 --budget 1000 --runs 5
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Games, or folders of games; corpus games by name. A level file is played instead of its game's other levels
    #[arg(value_name = "GAMES", required = true)]
    games: Vec<String>,
    /// Planners, each optionally with its own budget: `mcts,olets:500` (see `arcade docs planners`)
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "mcts")]
    planner: Vec<String>,
    /// Forward-model calls per decision
    #[arg(long, value_name = "CALLS", default_value_t = 1000, allow_negative_numbers = true,
        value_parser = clap::value_parser!(u64).range(0..=Budget::MOST.0))]
    budget: u64,
    /// Number of episodes per planner and level
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=MAX_EPISODES), allow_negative_numbers = true)]
    runs: u64,
    /// Maximum number of ticks per episode
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u64).range(1..=MAX_DECISIONS), allow_negative_numbers = true)]
    max_ticks: u64,
    /// Text to derive all seeds from
    #[arg(long, value_name = "TEXT", default_value = "run")]
    seed: String,
    /// Add a row for each level
    #[arg(long)]
    by_level: bool,
    /// Load games as the reference engine does, and tolerate the faults that it tolerates
    #[arg(long)]
    as_reference: bool,
    /// Also write one line per episode to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

struct Subject {
    title: String,
    game: Game,
    /// The levels and their numbers.
    levels: Vec<(usize, Level)>,
}

struct Entry<'a> {
    subject: &'a Subject,
    level: usize,
    planner: &'a PlannerSpec,
    run: u64,
}

/// A played episode, written as one line of `--csv`.
#[derive(Serialize)]
struct Line<'a> {
    #[serde(skip)]
    entry: &'a Entry<'a>,
    #[serde(serialize_with = "field")]
    game: &'a str,
    planner: &'a str,
    budget: u64,
    level: usize,
    run: u64,
    outcome: &'static str,
    /// The limit that stopped the episode, or `None` if the engine did not stop it.
    #[serde(skip)]
    stop: Option<Limit>,
    score: f64,
    ticks: usize,
    calls: u64,
    #[serde(skip)]
    seconds: f64,
}

/// The `--json` answer. The schema is in `docs/reference/run.md`.
#[derive(Serialize)]
struct Report<'a> {
    semantics: u32,
    seed: &'a str,
    runs: u64,
    max_ticks: u64,
    as_reference: bool,
    /// The episodes stopped by the engine.
    stopped: Vec<Stopped<'a>>,
    rows: Vec<Row<'a>>,
}

/// The episodes of one game that the engine stopped for the same reason.
#[derive(Serialize)]
struct Stopped<'a> {
    game: &'a str,
    reason: String,
    plays: u64,
}

/// One planner's results on a set of episodes.
#[derive(Serialize)]
struct Row<'a> {
    /// The game, or `None` for all games together.
    game: Option<&'a str>,
    /// The level, or `None` for all levels together.
    level: Option<usize>,
    planner: &'a str,
    budget: u64,
    plays: u64,
    wins: u64,
    losses: u64,
    /// The number of episodes stopped by the engine.
    stopped: u64,
    interval: [f64; 2],
    mean_score: f64,
    mean_ticks: f64,
    calls: u64,
    calls_per_decision: f64,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let planners = args.planner.iter().map(|name| name.parse().map_err(Failure::malformed));
    let planners: Vec<PlannerSpec> = planners.collect::<Result<_, _>>()?;
    reject_duplicates(args, &planners)?;
    let inputs = input::named_games(&args.games)?;
    if let Some(path) = &args.csv {
        whole_file::check(path, &inputs.iter().flat_map(GameInput::files).collect::<Vec<_>>())?;
    }
    let subjects = subjects(args, inputs)?;
    let levels: usize = subjects.iter().map(|subject| subject.levels.len()).sum();
    let episodes = (args.runs as usize).saturating_mul(levels).saturating_mul(planners.len());
    if episodes > MAX_EPISODES as usize {
        bail!(
            "{} of each planner on {}, {episodes} episodes in total, exceed the limit of {MAX_EPISODES}; \
             lower --runs, or pass fewer games",
            count(args.runs as usize, "episode"),
            count(levels, "level")
        );
    }
    let mut entries = Vec::new();
    for subject in &subjects {
        for planner in &planners {
            for level in 0..subject.levels.len() {
                entries.extend((0..args.runs).map(|run| Entry { subject, level, planner, run }));
            }
        }
    }
    let bar = console.progress(entries.len() as u64, "playing");
    let started = Stopwatch::start();
    let lines: Vec<Line<'_>> =
        entries.par_iter().map(|entry| play_entry(args, entry)).inspect(|_| bar.inc(1)).collect();
    bar.finish_and_clear();
    speeds(console, &planners, &lines, started.seconds());

    let report = Report {
        semantics: SEMANTICS,
        seed: &args.seed,
        runs: args.runs,
        max_ticks: args.max_ticks,
        as_reference: args.as_reference,
        stopped: stopped(&lines),
        rows: rows(args, &subjects, &planners, &lines),
    };
    // Print the answer first, so that it is not lost if the file cannot be written.
    console.document(&report)?;
    console.say(table(&report.rows).trim_end());
    for Stopped { game, reason, plays } in &report.stopped {
        let of = lines.iter().filter(|line| line.game == *game).count();
        console.say(format_args!(
            "{}: the engine stopped {plays} of {}: {reason}; the rates say nothing about the players, and {} shows the fault",
            visible(game),
            count(of, "episode"),
            shell::command([Path::new("validate"), Path::new(game)])
        ));
    }
    if let Some(path) = &args.csv {
        whole_file::write(
            path,
            &csv(&lines).map_err(|error| Failure::environment(error, path.in_message()))?,
        )?;
    }
    Ok(report.stopped.is_empty())
}

/// Returns the episodes stopped by the engine, grouped by game and reason.
fn stopped<'a>(lines: &[Line<'a>]) -> Vec<Stopped<'a>> {
    let mut stops: Vec<Stopped<'a>> = Vec::new();
    for line in lines {
        let Some(reason) = line.stop.map(|limit| limit.to_string()) else { continue };
        match stops.iter_mut().find(|stop| stop.game == line.game && stop.reason == reason) {
            Some(stop) => stop.plays += 1,
            None => stops.push(Stopped { game: line.game, reason, plays: 1 }),
        }
    }
    stops
}

/// Rejects a planner specified twice with the same budget, because its episodes would count twice.
fn reject_duplicates(args: &Args, planners: &[PlannerSpec]) -> Result<(), Failure> {
    let mut seen = BTreeMap::new();
    for planner in planners {
        let key = (planner.name(), planner.looks_ahead().then(|| budget(args, planner)));
        if let Some(first) = seen.insert(key, planner) {
            bail!(
                "--planner: `{first}` and `{planner}` are the same player; pass it once, or with different \
                 budgets"
            );
        }
    }
    Ok(())
}

fn subjects(args: &Args, inputs: Vec<GameInput>) -> Result<Vec<Subject>, Failure> {
    let mut subjects = Vec::new();
    for input in inputs {
        let game = input.compile(args.as_reference)?;
        let levels = input.numbered_levels()?.into_iter();
        let levels = levels.map(|(number, named)| Ok((number, named.level(&game)?)));
        let levels = levels.collect::<Result<Vec<_>, Failure>>()?;
        if levels.is_empty() {
            bail!("{}: there are no levels next to the game; pass level files after it", input.source.name);
        }
        subjects.push(Subject { title: input.title, game, levels });
    }
    Ok(subjects)
}

/// Plays an episode. The episode's seed depends only on the game, level, planner and run, so adding a game or
/// a planner does not affect other episodes.
fn play_entry<'a>(args: &Args, entry: &'a Entry<'a>) -> Line<'a> {
    let Entry { subject, level, planner, run } = *entry;
    let (number, level) = &subject.levels[level];
    let seed = Seed::from_text(&args.seed)
        .child(&subject.game.digest().to_string(), 0)
        .child("level", *number as u64)
        .child("run", run);
    let mut player = planner.player(seed.child(planner.name(), 0));
    let budget = budget(args, planner);
    let limits = Limits { ticks: usize::try_from(args.max_ticks).unwrap_or(usize::MAX), ..Limits::default() };
    let started = Stopwatch::start();
    let chance = seed.child("chance", 0);
    let played = play(&subject.game, level, &mut player, Budget(budget), chance, limits);
    Line {
        entry,
        game: &subject.title,
        planner: planner.name(),
        budget,
        level: *number,
        run,
        outcome: match played.episode.outcome {
            Outcome::Ongoing => "ongoing",
            Outcome::Won => "won",
            Outcome::Lost => "lost",
            Outcome::Ended => "ended",
            Outcome::Stopped(_) => "stopped",
        },
        stop: match played.episode.outcome {
            Outcome::Stopped(limit) => Some(limit),
            _ => None,
        },
        score: played.episode.score,
        ticks: played.episode.actions.len(),
        calls: played.calls,
        seconds: started.seconds(),
    }
}

fn budget(args: &Args, planner: &PlannerSpec) -> u64 {
    planner.budget().map_or(args.budget, |Budget(calls)| calls)
}

/// Reports each planner's speed, in calls per second on one thread.
fn speeds(console: &Console, planners: &[PlannerSpec], lines: &[Line<'_>], seconds: f64) {
    let calls: u64 = lines.iter().map(|line| line.calls).sum();
    let rate = calls as f64 / seconds;
    console.remark(format_args!("{} episodes, {calls} forward-model calls, {rate:.0} calls/s", lines.len()));
    for planner in planners.iter().filter(|_| planners.len() > 1) {
        let own = lines.iter().filter(|line| line.entry.planner == planner);
        let (calls, seconds) =
            own.fold((0, 0.0), |(calls, seconds), line| (calls + line.calls, seconds + line.seconds));
        let rate = calls as f64 / seconds;
        console.remark(format_args!("  {planner}: {calls} calls, {rate:.0} calls/s per thread"));
    }
}

fn rows<'a>(
    args: &Args,
    subjects: &'a [Subject],
    planners: &'a [PlannerSpec],
    lines: &[Line<'a>],
) -> Vec<Row<'a>> {
    let row = |subject: Option<&'a Subject>, level: Option<usize>, planner: &'a PlannerSpec| {
        let is_own = |line: &&Line<'_>| {
            line.entry.planner == planner
                && subject.is_none_or(|subject| std::ptr::eq(subject, line.entry.subject))
                && level.is_none_or(|level| level == line.level)
        };
        let lines: Vec<&Line<'_>> = lines.iter().filter(is_own).collect();
        let outcomes = |outcome| lines.iter().filter(|line| line.outcome == outcome).count() as u64;
        let mean = |of: fn(&Line<'_>) -> f64| {
            let values: Vec<f64> = lines.iter().map(|line| of(line)).collect();
            Summary::of(&values).map_or(0.0, |summary| summary.mean)
        };
        let (plays, wins) = (lines.len() as u64, outcomes("won"));
        let interval = wilson(wins, plays, Z95);
        let calls = lines.iter().map(|line| line.calls).sum();
        let decisions: usize = lines.iter().map(|line| line.ticks).sum();
        Row {
            game: subject.map(|subject| subject.title.as_str()),
            level,
            planner: planner.name(),
            budget: budget(args, planner),
            plays,
            wins,
            losses: outcomes("lost"),
            stopped: outcomes("stopped"),
            interval: [interval.low, interval.high],
            mean_score: mean(|line| line.score),
            mean_ticks: mean(|line| line.ticks as f64),
            calls,
            calls_per_decision: calls as f64 / decisions.max(1) as f64,
        }
    };
    let mut rows = Vec::new();
    for subject in subjects {
        for planner in planners {
            if args.by_level {
                let numbers = subject.levels.iter().map(|(number, _)| *number);
                rows.extend(numbers.map(|number| row(Some(subject), Some(number), planner)));
            }
            rows.push(row(Some(subject), None, planner));
        }
    }
    if subjects.len() > 1 {
        rows.extend(planners.iter().map(|planner| row(None, None, planner)));
    }
    rows
}

fn table(rows: &[Row<'_>]) -> String {
    let title = |row: &Row<'_>| match (row.game, row.level) {
        (None, _) => "all games".to_owned(),
        (Some(game), None) => visible(game).into_owned(),
        (Some(game), Some(level)) => format!("{} lvl{level}", visible(game)),
    };
    let widest =
        |of: &dyn Fn(&Row<'_>) -> usize, least: usize| rows.iter().map(of).max().unwrap_or(0).max(least);
    let width = widest(&|row| title(row).chars().count(), "game".len());
    let planners = widest(&|row| row.planner.len(), "planner".len());
    let mut text = format!(
        "{:<width$}  {:<planners$}  {:>6}  {:>11}  {:>12}  {:>8}  {:>7}\n",
        "game", "planner", "budget", "won", "95%", "score", "ticks"
    );
    for row in rows {
        let Row { planner, budget, plays, wins, interval: [low, high], mean_score, mean_ticks, .. } = row;
        let interval = format!("{:.0} to {:.0}%", 100.0 * low, 100.0 * high);
        let won = format!("{wins} of {plays}");
        let _ = writeln!(
            text,
            "{:<width$}  {planner:<planners$}  {budget:>6}  {won:>11}  {interval:>12}  {mean_score:>8.2}  {mean_ticks:>7.0}",
            title(row),
        );
    }
    text
}

/// Serialises a text so that spreadsheets do not interpret it as a formula.
fn field<S: Serializer>(text: &str, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&report::in_csv(text))
}

fn csv(lines: &[Line<'_>]) -> Result<Vec<u8>, anyhow::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for line in lines {
        table.serialize(line)?;
    }
    Ok(table.into_inner().map_err(|error| error.into_error())?)
}
