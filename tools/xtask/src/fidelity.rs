//! `cargo xtask fidelity` tests whether this suite's planners play as well as the reference's own.
//!
//! The reference's episodes are recorded, with one row per episode: game, level, agent, run, calls per
//! decision, outcome, ticks and score. This suite's planners play the same games and levels with the same
//! budgets and tick limit (`spec/04` §10.2). No parameters are fitted, so any deviation means that the rules
//! differ somewhere, and the difference must be found.

use crate::levels::load;
use agents::{Budget, Limits, PlannerSpec, Play, play};
use anyhow::{Context, bail};
use base::Seed;
use engine::{Game, Level, Outcome};
use rayon::prelude::*;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Plays the planners MCTS, OLETS and RHEA in the cells for which episodes of the reference were recorded,
/// and compares wins, scores and ticks.
///
/// The exit status is 1 if a cell differs (Fisher, two-sided, Benjamini–Hochberg over the cells at 5%), or if the win
/// rates differ by more than 10 percentage points on average. It is also 1 if a mean score in aliens or boulderdash
/// differs by more than 20%.
///
/// Example: cargo xtask fidelity --games gvgai/games --recorded agents-1000.csv
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of game folders, each with game.txt or game.vgdl and lvl*.txt
    #[arg(long, value_name = "DIR")]
    games: PathBuf,
    /// CSV file with the reference's episodes
    #[arg(long, value_name = "FILE")]
    recorded: PathBuf,
    /// Published win rates to show for comparison: a CSV with the columns agent, setting and the games
    #[arg(long, value_name = "FILE")]
    paper: Option<PathBuf>,
    /// Number of episodes per planner and level
    #[arg(long, value_name = "N", default_value_t = 5)]
    runs: u64,
    /// Maximum number of ticks per episode
    #[arg(long, value_name = "N", default_value_t = 1000)]
    ticks: usize,
    /// Text from which all seeds are derived
    #[arg(long, value_name = "TEXT", default_value = "fidelity")]
    seed: String,
    /// Only these games
    #[arg(long, value_name = "NAME")]
    game: Vec<String>,
    /// Only this planner
    #[arg(long, value_name = "NAME")]
    planner: Option<String>,
    /// Number of threads, or 0 for all cores. Does not affect the figures
    #[arg(long, value_name = "N", default_value_t = 0)]
    jobs: usize,
}

/// Pairs of a recorded agent and the corresponding planner in this suite.
const PAIRS: [(&str, &str); 3] = [("sampleMCTS", "mcts"), ("olets", "olets"), ("sampleRHEA", "rhea")];
/// The tests' false discovery rate.
const FALSE_DISCOVERIES: f64 = 0.05;
/// The maximum mean difference between win rates.
const MEAN_DIFFERENCE: f64 = 0.10;
/// The maximum relative difference between mean scores in [`SCORED_GAMES`].
const SCORE_DIFFERENCE: f64 = 0.20;
/// The games whose mean scores are compared.
const SCORED_GAMES: [&str; 2] = ["aliens", "boulderdash"];

/// An episode's figures, for comparison.
#[derive(Clone, Copy)]
struct Result {
    level: usize,
    won: bool,
    ticks: f64,
    score: f64,
    /// The mean number of calls per decision. The amount by which a search exceeds its budget indicates its
    /// depth.
    calls: f64,
}

/// An agent's recorded episodes of a game, and the corresponding planner's episodes.
struct Cell {
    game: String,
    agent: &'static str,
    planner: &'static str,
    calls: u64,
    theirs: Vec<Result>,
    ours: Vec<Result>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let mut cells = recorded(&args.recorded)?;
    cells.retain(|cell| {
        (args.game.is_empty() || args.game.contains(&cell.game))
            && args.planner.as_deref().is_none_or(|name| name == cell.planner)
    });
    if cells.is_empty() {
        bail!("{}: no episodes of these games and planners", args.recorded.display());
    }
    let paper = args.paper.as_deref().map(published).transpose()?.unwrap_or_default();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build()?;
    let played = pool.install(|| -> anyhow::Result<Vec<Vec<Result>>> {
        let games: Vec<_> =
            cells.iter().map(|cell| load(&args.games.join(&cell.game))).collect::<anyhow::Result<_>>()?;
        let cells = cells.iter().zip(&games).collect::<Vec<_>>();
        cells.par_iter().map(|(cell, (game, levels))| play_cell(args, cell, game, levels)).collect()
    })?;
    for (cell, ours) in cells.iter_mut().zip(played) {
        cell.ours = ours;
    }
    if report(&cells, &paper) {
        Ok(())
    } else {
        bail!("our planners play differently from the reference's planners")
    }
}

fn play_cell(args: &Args, cell: &Cell, game: &Game, levels: &[Level]) -> anyhow::Result<Vec<Result>> {
    let spec: PlannerSpec = cell.planner.parse()?;
    let limits = Limits { ticks: args.ticks, ..Limits::default() };
    let mut entries: Vec<(usize, u64)> = Vec::new();
    for level in 0..levels.len() {
        if cell.theirs.iter().any(|result| result.level == level) {
            entries.extend((0..args.runs).map(|run| (level, run)));
        }
    }
    let results = entries.par_iter().map(|&(level, run)| {
        let seed = Seed::from_text(&args.seed).child(&cell.game, level as u64).child("run", run);
        let mut player = spec.player(seed.child(cell.planner, 0));
        let chance = seed.child("chance", 0);
        let Play { episode, calls } =
            play(game, &levels[level], &mut player, Budget(cell.calls), chance, limits);
        let (won, ticks) = (episode.outcome == Outcome::Won, episode.actions.len() as f64);
        Result { level, won, ticks, score: episode.score, calls: calls as f64 / ticks }
    });
    Ok(results.collect())
}

/// Prints the table and the thresholds. Returns `true` if every threshold is met.
fn report(cells: &[Cell], paper: &[(String, String, f64)]) -> bool {
    println!(
        "{:<12} {:<7} {:>9} {:>9} {:>6} {:>6} {:>6}  {:>15}  {:>13}  {:>15}  wins by level",
        "game", "planner", "won", "recorded", "p", "q", "paper", "score", "ticks", "calls"
    );
    let wins = |results: &[Result]| results.iter().filter(|result| result.won).count() as u64;
    let rate = |results: &[Result]| wins(results) as f64 / results.len() as f64;
    let mean = |results: &[Result], of: fn(&Result) -> f64| {
        results.iter().map(of).sum::<f64>() / results.len() as f64
    };
    let p: Vec<f64> = cells
        .iter()
        .map(|Cell { ours, theirs, .. }| {
            statistics::fisher([wins(ours), wins(theirs)], [ours.len() as u64, theirs.len() as u64])
        })
        .collect();
    let q = statistics::benjamini_hochberg(&p);
    let mut faults = Vec::new();
    for ((cell, p), q) in cells.iter().zip(&p).zip(&q) {
        let Cell { game, agent, planner, theirs, ours, .. } = cell;
        let published = paper.iter().find(|(of, in_game, _)| of == agent && in_game == game);
        let published = published.map_or(String::new(), |(_, _, rate)| format!("{rate:.0}%"));
        let means = |of: fn(&Result) -> f64| [ours, theirs].map(|results| mean(results, of));
        let [score, their_score] = means(|result| result.score);
        let [ticks, their_ticks] = means(|result| result.ticks);
        let [calls, their_calls] = means(|result| result.calls);
        let by_level = |results: &[Result]| {
            let last = results.iter().map(|result| result.level).max().unwrap_or(0);
            let of = |level| results.iter().filter(|result| result.level == level && result.won).count();
            (0..=last).map(|level| of(level).to_string()).collect::<Vec<_>>().join(" ")
        };
        let [won, they_won] = [ours, theirs].map(|results| format!("{} of {}", wins(results), results.len()));
        let [levels, their_levels] = [ours, theirs].map(|results| by_level(results));
        println!(
            "{game:<12} {planner:<7} {won:>9} {they_won:>9} {p:>6.3} {q:>6.3} {published:>6}  {score:>6.2} / {their_score:>6.2}  \
             {ticks:>5.0} / {their_ticks:>5.0}  {calls:>6.1} / {their_calls:>6.1}  {levels} / {their_levels}"
        );
        if *q <= FALSE_DISCOVERIES {
            faults.push(format!("{game}, {planner}: win rates differ, q = {q:.4}"));
        }
        let apart = (score - their_score).abs() / their_score.abs();
        if SCORED_GAMES.contains(&game.as_str()) && apart > SCORE_DIFFERENCE {
            faults.push(format!("{game}, {planner}: mean scores differ by {:.0}%", 100.0 * apart));
        }
    }
    let apart = cells.iter().map(|cell| (rate(&cell.ours) - rate(&cell.theirs)).abs()).sum::<f64>();
    let apart = apart / cells.len() as f64;
    println!("mean absolute difference between win rates: {:.1} points", 100.0 * apart);
    if apart > MEAN_DIFFERENCE {
        faults.push(format!("win rates differ by {:.1} points on average", 100.0 * apart));
    }
    faults.iter().for_each(|fault| println!("{fault}"));
    faults.is_empty()
}

/// A row in the recorded episodes.
#[derive(Deserialize)]
struct Line {
    game: String,
    level: usize,
    agent: String,
    calls_per_decision: u64,
    calls_used_mean: f64,
    ticks: f64,
    result: String,
    score: f64,
}

/// Reads the recorded episodes, grouped by game and agent, in file order.
fn recorded(path: &Path) -> anyhow::Result<Vec<Cell>> {
    let mut cells: Vec<Cell> = Vec::new();
    for line in csv::Reader::from_path(path)?.deserialize() {
        let line: Line = line.with_context(|| path.display().to_string())?;
        let Line { game, level, ticks, score, calls_per_decision: calls, .. } = line;
        let pair = PAIRS.iter().find(|(agent, _)| *agent == line.agent);
        let Some(&(agent, planner)) = pair else { continue };
        let result = Result { level, won: line.result == "win", ticks, score, calls: line.calls_used_mean };
        match cells.iter_mut().find(|cell| cell.game == game && cell.agent == agent) {
            Some(cell) => cell.theirs.push(result),
            None => cells.push(Cell { game, agent, planner, calls, theirs: vec![result], ours: Vec::new() }),
        }
    }
    Ok(cells)
}

/// Reads the published win rates of search agents, in percent, each with its agent and game.
fn published(path: &Path) -> anyhow::Result<Vec<(String, String, f64)>> {
    let mut rates = Vec::new();
    for line in csv::Reader::from_path(path)?.deserialize::<BTreeMap<String, String>>() {
        let line = line.with_context(|| path.display().to_string())?;
        let agent = line.get("agent").with_context(|| format!("{}: no agents", path.display()))?;
        // All other columns are games.
        let games = line.iter().filter(|(name, _)| !["agent", "setting"].contains(&name.as_str()));
        for (game, rate) in games {
            rates.push((agent.clone(), game.clone(), rate.parse()?));
        }
    }
    Ok(rates)
}
