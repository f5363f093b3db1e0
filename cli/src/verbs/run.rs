//! `arcade run`: how often do planners win?

use crate::console::{Console, Stopwatch};
use crate::failure::{Answer, Failure};
use crate::input::{self, Named};
use crate::render;
use agents::{Budget, Limits, Play, planner, play};
use engine::{Game, Level, Seed};
use rayon::prelude::*;
use serde::Serialize;
use statistics::Summary;
use std::fmt::Write;
use std::path::PathBuf;
use validators::Rate;

/// Plays planners on games and reports win rates with 95 % intervals, per game and pooled.
///
/// Example: arcade run corpora --planner random,mcts --budget 500 --runs 5
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Games, or folders of games; corpus games by name
    #[arg(value_name = "GAMES", required = true)]
    games: Vec<String>,
    /// Planners: do-nothing, random, mcts
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "mcts")]
    planner: Vec<String>,
    /// Forward-model calls of one decision
    #[arg(long, value_name = "CALLS", default_value_t = 1000)]
    budget: u64,
    /// Episodes of each planner on each level
    #[arg(long, value_name = "N", default_value_t = 5)]
    runs: u64,
    /// Ticks of an episode at most
    #[arg(long, value_name = "N", default_value_t = 2000)]
    max_ticks: usize,
    /// Text that all seeds come from
    #[arg(long, value_name = "TEXT", default_value = "run")]
    seed: String,
    /// Load games as the reference engine does: overlook faults that it overlooks
    #[arg(long)]
    as_reference: bool,
    /// Also write one line an episode to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

struct Subject {
    title: String,
    game: Game,
    levels: Vec<Level>,
}

/// One episode to play.
struct Entry<'a> {
    subject: &'a Subject,
    level: usize,
    planner: &'a str,
    run: u64,
}

#[derive(Serialize)]
struct Row {
    game: String,
    planner: String,
    #[serde(flatten)]
    rate: Rate,
    mean_ticks: f64,
    calls_per_decision: f64,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    for name in &args.planner {
        planner(name, Seed::from_text("")).map_err(Failure::malformed)?;
    }
    let mut subjects = Vec::new();
    for name in &args.games {
        for input in input::games(name)? {
            let game = input.compile(args.as_reference)?;
            let levels =
                input.levels()?.iter().map(|text| level(&game, text)).collect::<Result<Vec<_>, _>>()?;
            if levels.is_empty() {
                return Err(Failure::malformed(format!("{}: the game has no levels", input.source.name)));
            }
            subjects.push(Subject { title: input.title, game, levels });
        }
    }
    let mut entries = Vec::new();
    for subject in &subjects {
        for planner in &args.planner {
            for level in 0..subject.levels.len() {
                entries.extend((0..args.runs).map(|run| Entry { subject, level, planner, run }));
            }
        }
    }
    let bar = console.progress(entries.len() as u64, "playing");
    let started = Stopwatch::start();
    let plays: Vec<Play> = entries
        .par_iter()
        .map(|entry| {
            let play = play_entry(args, entry);
            bar.inc(1);
            play
        })
        .collect();
    bar.finish_and_clear();
    let seconds = started.seconds();
    let calls: u64 = plays.iter().map(|play| play.calls).sum();
    console.remark(format_args!(
        "{} episodes, {calls} forward-model calls, {:.0} calls/s",
        plays.len(),
        calls as f64 / seconds
    ));

    let played: Vec<(&Entry<'_>, &Play)> = entries.iter().zip(&plays).collect();
    let mut rows = Vec::new();
    for subject in &subjects {
        for planner in &args.planner {
            let own = |entry: &Entry<'_>| std::ptr::eq(entry.subject, subject) && entry.planner == planner;
            rows.push(row(
                &subject.title,
                planner,
                played.iter().filter(|(entry, _)| own(entry)).map(|(_, play)| *play),
            ));
        }
    }
    if subjects.len() > 1 {
        for planner in &args.planner {
            let own = played.iter().filter(|(entry, _)| entry.planner == planner).map(|(_, play)| *play);
            rows.push(row("all games", planner, own));
        }
    }
    if let Some(path) = &args.csv {
        std::fs::write(path, csv(&played)).map_err(|error| Failure::surroundings(error, path.display()))?;
    }
    console.document(&rows)?;
    console.say(table(&rows).trim_end());
    Ok(true)
}

fn level(game: &Game, text: &Named) -> Result<Level, Failure> {
    game.level(&text.text).map_err(|problems| Failure::malformed(render::problems(text, &problems.0)))
}

/// Seeds hang on game, level, planner and run only: adding a game or a planner changes no other episode.
fn play_entry(args: &Args, entry: &Entry<'_>) -> Play {
    let Entry { subject, level, run, .. } = *entry;
    let chance = Seed::from_text(&args.seed)
        .child(&subject.game.digest().to_string(), 0)
        .child("level", level as u64)
        .child("run", run);
    let own = chance.child(entry.planner, 0);
    let mut planner = planner(entry.planner, own).expect("names were checked");
    let limits = Limits { ticks: args.max_ticks, ..Limits::default() };
    play(
        &subject.game,
        &subject.levels[level],
        planner.as_mut(),
        Budget(args.budget),
        chance.child("chance", 0),
        limits,
    )
}

fn row<'a>(game: &str, planner: &str, plays: impl Iterator<Item = &'a Play>) -> Row {
    let plays: Vec<&Play> = plays.collect();
    let ticks: Vec<f64> = plays.iter().map(|play| play.episode.actions.len() as f64).collect();
    let rate = Rate::of(plays);
    let all_ticks: f64 = ticks.iter().sum();
    Row {
        game: game.to_owned(),
        planner: planner.to_owned(),
        mean_ticks: Summary::of(&ticks).map_or(0.0, |summary| summary.mean),
        calls_per_decision: rate.calls as f64 / all_ticks.max(1.0),
        rate,
    }
}

fn table(rows: &[Row]) -> String {
    let width = rows.iter().map(|row| row.game.len()).max().unwrap_or(0).max("game".len());
    let mut text = format!(
        "{:<width$}  {:<10}  {:>9}  {:>12}  {:>8}  {:>7}\n",
        "game", "planner", "won", "95 %", "score", "ticks"
    );
    for Row { game, planner, rate, mean_ticks, .. } in rows {
        let Rate { wins, plays, interval: [low, high], mean_score, .. } = rate;
        let interval = format!("{:.0} to {:.0} %", 100.0 * low, 100.0 * high);
        let won = format!("{wins} of {plays}");
        let _ = writeln!(
            text,
            "{game:<width$}  {planner:<10}  {won:>9}  {interval:>12}  {mean_score:>8.2}  {mean_ticks:>7.0}"
        );
    }
    text
}

fn csv(played: &[(&Entry<'_>, &Play)]) -> String {
    let mut text = String::from("game,planner,level,run,outcome,score,ticks,calls\n");
    for (Entry { subject, level, planner, run }, Play { episode, calls }) in played {
        let outcome = format!("{:?}", episode.outcome).to_lowercase();
        let title = subject.title.replace([',', '"', '\n'], "_");
        let (score, ticks) = (episode.score, episode.actions.len());
        let _ = writeln!(text, "{title},{planner},{level},{run},{outcome},{score},{ticks},{calls}");
    }
    text
}
