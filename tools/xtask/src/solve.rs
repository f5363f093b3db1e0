//! `cargo xtask solve` determines which levels the planner portfolio wins, for all games in a folder.

use crate::bench::now;
use crate::levels::{folders, load};
use agents::{PortfolioConfig, Solution, solve};
use anyhow::Context;
use base::Seed;
use engine::analysis::Spatiality;
use engine::{Analysis, Game, Level, Outcome};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

/// Searches for a win on every level of every game with the portfolio of planners, and lists the results.
///
/// A result is one of: won (every win is replayed), proven impossible, unknown, or no win that the rules
/// allow the avatar to reach.
///
/// Example: cargo xtask solve --games gvgai/games --csv solved.csv
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of game folders, each with game.txt or game.vgdl and lvl*.txt
    #[arg(long, value_name = "DIR")]
    games: PathBuf,
    /// Forward-model calls per level
    #[arg(long, value_name = "CALLS", default_value_t = PortfolioConfig::default().budget)]
    budget: u64,
    /// Fraction of the calls that is used to find the shortest win, in deterministic games
    #[arg(long, value_name = "SHARE", default_value_t = PortfolioConfig::default().shortest)]
    shortest: f64,
    /// Maximum memory of a systematic search, in bytes
    #[arg(long, value_name = "BYTES", default_value_t = PortfolioConfig::default().bytes)]
    bytes: usize,
    /// Text from which all seeds are derived
    #[arg(long, value_name = "TEXT", default_value = "solve")]
    seed: String,
    /// Only these games
    #[arg(long, value_name = "NAME")]
    game: Vec<String>,
    /// Include games with continuous space
    #[arg(long)]
    continuous: bool,
    /// Number of threads, or 0 for all cores. Does not affect the results
    #[arg(long, value_name = "N", default_value_t = 0)]
    jobs: usize,
    /// Write one line per level to this file, with the columns game, level, found, ticks, whether proven
    /// shortest, calls, seconds
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

struct Entry<'a> {
    game: &'a str,
    number: usize,
    level: &'a Level,
    analysis: &'a Analysis,
}

/// The result of searching a level.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Found {
    Won,
    Impossible,
    Unknown,
    NoWin,
}

impl Found {
    const ALL: [Found; 4] = [Found::Won, Found::Impossible, Found::Unknown, Found::NoWin];

    fn name(self) -> &'static str {
        match self {
            Found::Won => "won",
            Found::Impossible => "impossible",
            Found::Unknown => "unknown",
            Found::NoWin => "no-win",
        }
    }
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let mut subjects: Vec<(String, Analysis, Vec<Level>)> = Vec::new();
    for (name, folder) in folders(&args.games, &args.game)? {
        let (game, levels): (Game, Vec<Level>) = load(&folder)?;
        let analysis = Analysis::of(&game);
        if args.continuous || analysis.taxonomy().spatiality < Spatiality::Continuous {
            subjects.push((name, analysis, levels));
        }
    }
    let entries: Vec<Entry<'_>> = subjects
        .iter()
        .flat_map(|(game, analysis, levels)| {
            levels.iter().enumerate().map(move |(number, level)| Entry { game, number, level, analysis })
        })
        .collect();
    let config = PortfolioConfig {
        budget: args.budget,
        shortest: args.shortest,
        bytes: args.bytes,
        ..PortfolioConfig::default()
    };
    let started = now();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build()?;
    let rows: Vec<(Found, String)> =
        pool.install(|| entries.par_iter().map(|entry| entry.solve(&config, &args.seed)).collect());
    let mut counts: BTreeMap<Found, usize> = BTreeMap::new();
    let mut csv = String::from("game,level,found,ticks,shortest,calls,seconds\n");
    for (found, row) in &rows {
        *counts.entry(*found).or_default() += 1;
        writeln!(csv, "{row}")?;
    }
    for found in Found::ALL {
        println!("{:<10} {}", found.name(), counts.get(&found).unwrap_or(&0));
    }
    let winnable = rows.iter().filter(|(found, _)| *found != Found::NoWin).count();
    let won = counts.get(&Found::Won).unwrap_or(&0);
    println!(
        "{won} of {winnable} levels whose rules can be won, {:.1}%; {:.0} s",
        100.0 * *won as f64 / winnable.max(1) as f64,
        started.elapsed().as_secs_f64()
    );
    if let Some(path) = &args.csv {
        fs::write(path, csv).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

impl Entry<'_> {
    fn solve(&self, config: &PortfolioConfig, seed: &str) -> (Found, String) {
        let Entry { game, number, level, analysis } = *self;
        let started = now();
        let (found, detail) = if analysis.can_win() && analysis.reach(level).can_win() {
            let seed = Seed::from_text(seed).child(game, number as u64);
            let solved = solve(analysis, level, config, seed);
            let calls = solved.calls;
            match solved.solution {
                Solution::Won { episode, shortest } => {
                    let state = episode.replay(analysis.game(), level).expect("a witness replays");
                    assert_eq!(state.outcome(), Outcome::Won, "a witness wins");
                    (Found::Won, format!("{},{shortest},{calls}", episode.actions.len()))
                }
                Solution::Impossible { .. } => (Found::Impossible, format!(",,{calls}")),
                Solution::Unknown => (Found::Unknown, format!(",,{calls}")),
            }
        } else {
            (Found::NoWin, ",,0".to_owned())
        };
        let row = format!("{game},{number},{},{detail},{:.2}", found.name(), started.elapsed().as_secs_f64());
        println!("{row}");
        (found, row)
    }
}
