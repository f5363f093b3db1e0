//! `cargo xtask instructions` tests whether a step has become slower. The task counts instructions instead of
//! measuring time, because other load on the machine does not affect them. Even a change of a few percent is
//! therefore visible.

use crate::episode_run::{Subject, subjects};
use anyhow::{Context, bail};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Counts the instructions per tick for the games in a folder, and compares the counts with a file.
///
/// The task requires valgrind. Without valgrind, or if the expected counts are for a different compiler, it
/// prints a message and passes, because different compilers emit different instructions.
///
/// The expected counts are for the development profile, which CI tests. Build with CARGO_INCREMENTAL=0, and
/// rewrite the file with --bless after an update of the toolchain.
///
/// Example: CARGO_INCREMENTAL=0 cargo run --locked --package xtask -- instructions
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of game folders
    #[arg(long, value_name = "DIR", default_value = "corpora")]
    games: PathBuf,
    /// CSV file with the expected counts, in the columns game and instructions_per_tick
    #[arg(long, value_name = "FILE", default_value = "tools/xtask/instructions.csv")]
    expected: PathBuf,
    /// Tolerated increase in the cost of a tick, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 5.0)]
    tolerance: f64,
    /// Write the file of expected counts instead of comparing with it
    #[arg(long)]
    bless: bool,
    /// Count only one of every NUMBER games
    #[arg(long, value_name = "NUMBER", default_value = "1", conflicts_with = "bless")]
    every: NonZeroUsize,
}

/// The number of ticks whose instructions are counted.
const TICKS: u64 = 1000;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let count =
        |subject: Subject| Ok(per_tick(&args.games, &subject.name)?.map(|count| (subject.name, count)));
    let counts: anyhow::Result<Option<BTreeMap<String, u64>>> =
        subjects(&args.games, &[])?.into_par_iter().step_by(args.every.get()).map(count).collect();
    let Some(counts) = counts? else {
        println!("SKIPPED: valgrind is not installed, so instructions are not counted");
        return Ok(());
    };
    let path = args.expected.display();
    let compiler = compiler()?;
    if args.bless {
        let mut csv = format!("# {compiler}\ngame,instructions_per_tick\n");
        for (name, count) in &counts {
            writeln!(csv, "{name},{count}")?;
        }
        return fs::write(&args.expected, csv).with_context(|| path.to_string());
    }
    let text = fs::read_to_string(&args.expected).with_context(|| path.to_string())?;
    let known = text.lines().next().and_then(|line| line.strip_prefix("# ")).unwrap_or_default();
    if known != compiler {
        println!("SKIPPED: {path} was recorded with {known}; this is {compiler}");
        return Ok(());
    }
    let mut slower = false;
    for line in text.lines().skip(2).step_by(args.every.get()) {
        let (name, expected) =
            line.split_once(',').with_context(|| format!("{path}: `{line}` is not a row"))?;
        let expected: u64 =
            expected.parse().with_context(|| format!("{path}: `{line}` contains no number"))?;
        let count = *counts.get(name).with_context(|| format!("{path}: there is no game `{name}`"))?;
        let change = 100.0 * (count as f64 / expected as f64 - 1.0);
        println!("{name}: {count} instructions per tick, expected {expected} ({change:+.1}%)");
        slower |= change > args.tolerance;
    }
    if slower {
        bail!(
            "a tick costs over {}% more than {path} records; if this is intended, run this command with \
             --bless",
            args.tolerance
        );
    }
    Ok(())
}

fn compiler() -> anyhow::Result<String> {
    let output = Command::new("rustc").arg("--version").output().context("rustc --version")?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Returns the number of instructions per warm tick on level 0 of a game, including the hash. Returns `None`
/// if valgrind is not installed.
pub(crate) fn per_tick(games: &Path, name: &str) -> anyhow::Result<Option<u64>> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=*play_measured*")
        .arg(env::current_exe()?)
        .arg("bench")
        .arg("--games")
        .arg(games)
        .args(["--game", name, "--ticks", &TICKS.to_string()])
        .output();
    let output = match output {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        output => output.context("valgrind")?,
    };
    let text = String::from_utf8_lossy(&output.stderr);
    let collected =
        text.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse::<u64>().ok());
    // An interrupted run ends with a count of 0, which is below every expected count.
    let collected = collected.filter(|&count| count > 0 && output.status.success());
    let collected = collected.with_context(|| format!("{name}: valgrind reported no count:\n{text}"))?;
    Ok(Some(collected / TICKS))
}
