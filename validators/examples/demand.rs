//! Prints the measured demands of levels on a player, one line per level, and the levels of each tier (difficulty
//! class).
//!
//! ```sh
//! cargo run --release -p infinite-arcade-validators --example demand -- CALLS corpora/*
//! ```
#![allow(clippy::print_stdout, reason = "a program")]

use agents::{PortfolioConfig, Solution, solve};
use base::Seed;
use engine::{Analysis, Game};
use infinite_arcade_validators::{Demand, shorter_win};
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let calls = arguments.next().ok_or("CALLS FOLDERS...")?.parse()?;
    let folders: Vec<PathBuf> = arguments.map(PathBuf::from).collect();
    let tables: Vec<Result<Vec<String>, String>> =
        folders.par_iter().map(|folder| rows(folder, calls)).collect();
    println!(
        "| level | ticks | decisions | pushes | proved | commitment | dead ends | won | movers | lost of 8 | astray | tier |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|"
    );
    for table in tables {
        table?.iter().for_each(|row| println!("{row}"));
    }
    Ok(())
}

/// Returns the rows for a folder with a game and its levels. The search for each win takes up to `budget` calls.
fn rows(folder: &Path, budget: u64) -> Result<Vec<String>, String> {
    let read = |file: &str| fs::read_to_string(folder.join(file));
    let source = read("game.vgdl").map_err(|error| format!("{}: {error}", folder.display()))?;
    let game = Game::from_source(&source).map_err(|_| format!("{}: no valid game", folder.display()))?;
    let analysis = Analysis::of(&game);
    let name = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut rows = Vec::new();
    for number in 0.. {
        let Ok(text) = read(&format!("lvl{number}.txt")) else { break };
        let level = game.level(&text).map_err(|_| format!("{name} {number}: no valid level"))?;
        let seed = Seed::from_text("demand").child(&name, number);
        let config = PortfolioConfig { budget, shortest: 0.4, ..PortfolioConfig::default() };
        let solved = solve(&analysis, &level, &config, seed.child("win", 0));
        let Solution::Won { episode, shortest } = solved.solution else {
            rows.push(format!("| {name} {number} | no win found | | | | | | | | | | |"));
            continue;
        };
        let shorter = shorter_win(&analysis, &level, &episode, seed.child("shorter win", 0));
        let episode = shorter.unwrap_or(*episode);
        let demand = Demand::of(&analysis, &level, &episode, shortest, seed).ok_or("a win")?;
        let dead = demand.dead_ends.map_or(["-".to_owned(), "-".to_owned()], |found| {
            [found.dead, found.won]
                .map(|count| format!("{:.0} %", 100.0 * count as f64 / found.states.max(1) as f64))
        });
        rows.push(format!(
            "| {name} {number} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.1} | {} |",
            demand.ticks,
            demand.decisions,
            demand.pushes,
            if shortest { "yes" } else { "no" },
            demand.commitment.name(),
            dead[0],
            dead[1],
            demand.movers,
            demand.deception.lost,
            demand.deception.astray,
            demand.tier()
        ));
    }
    Ok(rows)
}
