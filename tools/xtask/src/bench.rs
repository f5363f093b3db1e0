//! `cargo xtask bench` measures the engine's speed on each game, and compares it with the reference's speed.
//!
//! The method is the same as for the reference's own figures. Level 0 is played, with actions drawn uniformly
//! from all of the avatar's actions except NIL. Episodes start from copies made outside the measurement.
//! Complete steps are measured, including the state hash after each of them. Time is the CPU time of the
//! stepping thread.

use crate::episode_run::{EpisodeRun, Subject, first_digest, subjects};
use crate::instructions;
use agents::{Batch, Budget, Mcts, MctsConfig, Planner};
use anyhow::Context;
use base::Seed;
use cpu_time::ThreadTime;
use engine::analysis::{Analysis, Spatiality};
use engine::{Action, State};
use rayon::ThreadPoolBuilder;
use std::fmt::Write;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The number of states in the batch for measuring the speedup.
const BATCH: usize = 1024;
/// The number of states in the batch for measuring the rate. Learners step batches of this size.
const LARGE_BATCH: usize = 4096;

/// Reports the ticks per second, the duration of a copy, and the ratio to the reference, for every game in a
/// folder.
///
/// Example: cargo xtask bench --games gvgai/games --reference gvgai/java-speed.csv --csv speed.csv
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of game folders, each with game.txt or game.vgdl and lvl0.txt
    #[arg(long, value_name = "DIR")]
    games: PathBuf,
    /// Only these games
    #[arg(long, value_name = "NAME")]
    game: Vec<String>,
    /// The reference's figures: a CSV with the columns game and ticks_per_s
    #[arg(long, value_name = "FILE")]
    reference: Option<PathBuf>,
    /// Seconds of stepping for each game, in addition to a warm-up of a fifth of that time
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0)]
    seconds: f64,
    /// Also measure the forward-model calls per second of MCTS
    #[arg(long)]
    mcts: bool,
    /// Also measure the rate of one thread that steps a batch of 4096 states, one tick at a time. For a batch
    /// of 1024 states, also measure the speedup of two threads over one thread, at one tick and at 32 ticks
    /// at a time
    #[arg(long)]
    batch: bool,
    /// Also count the instructions per tick, if valgrind is installed
    #[arg(long)]
    instructions: bool,
    /// Write the table to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Play this number of ticks and print only the digest of the visited states
    #[arg(long, value_name = "TICKS")]
    ticks: Option<u64>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let subjects = subjects(&args.games, &args.game)?;
    if let Some(ticks) = args.ticks {
        for subject in &subjects {
            let mut episode_run = EpisodeRun::new(subject);
            episode_run.warm_up(ticks);
            while episode_run.ticks < ticks {
                episode_run.batch(ticks);
            }
            println!("{} {} ticks {:032x}", subject.name, episode_run.ticks, episode_run.digest);
        }
        return Ok(());
    }
    let reference = args.reference.as_deref().map(figures).transpose()?.unwrap_or_default();
    let mut csv = String::from(
        "game,ticks_per_s,ratio,clone_ns,state_bytes,instructions_per_tick,mcts_calls_per_s,batch_ticks_per_s,batch_step,batch_play,digest\n",
    );
    println!("{}", csv.trim_end());
    let (mut grid, mut continuous) = (Vec::new(), Vec::new());
    for subject in &subjects {
        let speed = speed(subject, args.seconds);
        let known = reference.iter().find(|(name, _)| *name == subject.name);
        let ratio = known.map(|(_, ticks)| speed / ticks);
        if Analysis::of(&subject.game).taxonomy().spatiality >= Spatiality::Continuous {
            continuous.extend(ratio);
        } else {
            grid.extend(ratio);
        }
        let count = || instructions::per_tick(&args.games, &subject.name);
        let shown = |figure: Option<f64>| figure.map_or(String::new(), |figure| format!("{figure:.0}"));
        let [batch_step, batch_play] = [1, 32]
            .map(|ticks| if args.batch { format!("{:.2}", speedup(subject, ticks)) } else { String::new() });
        let row = format!(
            "{},{speed:.0},{},{:.0},{},{},{},{},{batch_step},{batch_play},{:032x}",
            subject.name,
            ratio.map_or(String::new(), |ratio| format!("{ratio:.1}")),
            clone_time(&subject.start) * 1e9,
            subject.start.size_in_bytes(),
            shown(if args.instructions { count()?.map(|count| count as f64) } else { None }),
            shown(args.mcts.then(|| mcts_calls(subject))),
            shown(args.batch.then(|| batch_rate(subject))),
            first_digest(subject)?,
        );
        println!("{row}");
        writeln!(csv, "{row}")?;
    }
    summarise("grid", grid);
    summarise("continuous", continuous);
    if let Some(path) = &args.csv {
        fs::write(path, csv).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// Measures a game's ticks per second after a warm-up.
fn speed(subject: &Subject, seconds: f64) -> f64 {
    let [_, speed] = [seconds / 5.0, seconds].map(|seconds| {
        let mut episode_run = EpisodeRun::new(subject);
        while episode_run.time.as_secs_f64() < seconds {
            episode_run.batch(u64::MAX);
        }
        episode_run.ticks as f64 / episode_run.time.as_secs_f64()
    });
    speed
}

fn summarise(kind: &str, mut ratios: Vec<f64>) {
    ratios.sort_by(f64::total_cmp);
    if let Some(least) = ratios.first() {
        let median = ratios[ratios.len() / 2];
        println!("{} {kind} games: median ratio {median:.1}, minimum {least:.1}", ratios.len());
    }
}

/// Reads the reference's ticks per second for each game.
fn figures(path: &Path) -> anyhow::Result<Vec<(String, f64)>> {
    let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let row = |line: &str| {
        let mut fields = line.split(',');
        Some((fields.next()?.to_owned(), fields.next()?.parse().ok()?))
    };
    Ok(text.lines().skip(1).filter_map(row).collect())
}

/// Measures the duration of `clone_from` into a warm copy, in seconds.
fn clone_time(start: &State) -> f64 {
    let mut copy = start.clone();
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        const COPIES: u32 = 20_000;
        let clock = ThreadTime::now();
        for _ in 0..COPIES {
            copy.clone_from(black_box(start));
            black_box(&copy);
        }
        best = best.min(clock.elapsed().as_secs_f64() / f64::from(COPIES));
    }
    best
}

/// Measures the forward-model calls per second that MCTS makes during an episode, including copies of states.
fn mcts_calls(subject: &Subject) -> f64 {
    let mut planner = Mcts::new(MctsConfig::default(), Seed::from_text("bench"));
    let mut state = subject.start.clone();
    let (mut calls, mut time) = (0, Duration::ZERO);
    while time < Duration::from_secs(2) {
        if state.is_over() {
            state.clone_from(&subject.start);
        }
        let clock = ThreadTime::now();
        let (action, cost) = planner.plan(&subject.game, &state, Budget(1000));
        time += clock.elapsed();
        calls += cost;
        subject.game.step(&mut state, action);
    }
    calls as f64 / time.as_secs_f64()
}

#[allow(clippy::disallowed_methods, reason = "the duration is printed only")]
pub(crate) fn now() -> Instant {
    Instant::now()
}

/// Returns the ticks per second of CPU time that one thread achieves with a batch of [`LARGE_BATCH`] states,
/// in the best of three runs.
fn batch_rate(subject: &Subject) -> f64 {
    let pool = ThreadPoolBuilder::new().num_threads(1).build().expect("threads can be started");
    (0..3).map(|_| pool.install(|| batch_speed(subject, LARGE_BATCH, 1)[1])).fold(0.0, f64::max)
}

/// Returns the speedup of two threads over one thread, for a batch stepped by `ticks` ticks at a time. It is
/// computed from the best of three runs per number of threads. Runs with one thread and with two threads
/// alternate.
fn speedup(subject: &Subject, ticks: usize) -> f64 {
    let pools = [1, 2].map(|threads| {
        ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
    });
    let mut best = [0.0f64; 2];
    for _ in 0..3 {
        for (pool, best) in pools.iter().zip(&mut best) {
            *best = best.max(pool.install(|| batch_speed(subject, BATCH, ticks)[0]));
        }
    }
    best[1] / best[0]
}

/// Returns the ticks per second of wall-clock time, and the ticks per second of the calling thread's CPU
/// time. Both rates include starting new episodes.
fn batch_speed(subject: &Subject, size: usize, ticks: usize) -> [f64; 2] {
    let seed = Seed::from_text(&subject.name);
    let mut batch = Batch::fork(&subject.game, &subject.start, size, seed);
    let mut sampler = seed.sampler();
    let actions = subject.game.actions(&subject.start);
    let plans: Vec<Vec<Action>> =
        (0..16).map(|_| (0..size * ticks).map(|_| *sampler.choose(actions)).collect()).collect();
    let mut round = |count: usize| {
        for plan in plans.iter().cycle().take(count) {
            batch.play(plan).expect("every lane has a plan");
            batch.reset_over();
        }
    };
    // Before the measurement, the buffers must have grown, the threads must have started, and the episodes
    // must have diverged.
    round(512 / ticks);
    let (clock, own) = (now(), ThreadTime::now());
    let mut rounds = 0;
    // The speed of a game depends on the part of its episodes that is played. A large batch plays the same
    // part as learners do.
    let least = if size == LARGE_BATCH { 640 } else { 1 };
    while rounds * ticks < least || clock.elapsed() < Duration::from_millis(300) {
        round(1);
        rounds += 1;
    }
    [clock.elapsed(), own.elapsed()].map(|time| (rounds * size * ticks) as f64 / time.as_secs_f64())
}
