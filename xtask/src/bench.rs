//! `cargo xtask bench`: how fast is the engine, game by game, and against the reference?
//!
//! The rules are those of the reference's own figures: level 0, actions drawn uniformly from those of the avatar, NIL left
//! out; episodes start from copies made off the clock; on the clock are whole steps with the hash of the state after each.
//! Time is that of the processor, in the one thread that steps.

use agents::{Budget, Mcts, MctsConfig, Planner};
use anyhow::{Context, bail};
use cpu_time::ThreadTime;
use engine::{Chance, Game, Seed, State};
use std::fmt::Write;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Reports ticks per second, the time of a copy, and the ratio to the reference, for every game of a folder.
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
    /// Seconds of stepping for each game, after a fifth of that to warm up
    #[arg(long, value_name = "SECONDS", default_value_t = 5.0)]
    seconds: f64,
    /// Also forward-model calls per second of MCTS
    #[arg(long)]
    mcts: bool,
    /// Write the table to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Play so many ticks and print the digest of the visited states, nothing else: for counting instructions
    #[arg(long, value_name = "TICKS")]
    ticks: Option<u64>,
}

/// Ticks of an episode at most, as in the reference's figures.
const EPISODE: usize = 2001;
/// Episodes that are prepared at once, off the clock.
const BATCH: usize = 16;

struct Subject {
    name: String,
    game: Game,
    start: State,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let subjects = subjects(args)?;
    if let Some(ticks) = args.ticks {
        for subject in &subjects {
            let mut course = Course::new(subject);
            while course.ticks < ticks {
                course.batch(ticks);
            }
            println!("{} {} ticks {:032x}", subject.name, course.ticks, course.digest);
        }
        return Ok(());
    }
    let reference = args.reference.as_deref().map(figures).transpose()?.unwrap_or_default();
    let mut csv = String::from("game,ticks_per_s,ratio,clone_ns,state_bytes,mcts_calls_per_s,digest\n");
    let mut ratios = Vec::new();
    for subject in &subjects {
        let mut course = Course::new(subject);
        let warm = Duration::from_secs_f64(args.seconds / 5.0);
        while course.time < warm {
            course.batch(u64::MAX);
        }
        let mut course = Course::new(subject);
        while course.time.as_secs_f64() < args.seconds {
            course.batch(u64::MAX);
        }
        let speed = course.ticks as f64 / course.time.as_secs_f64();
        let known = reference.iter().find(|(name, _)| *name == subject.name);
        let ratio = known.map(|(_, ticks)| speed / ticks);
        ratios.extend(ratio);
        let mcts = if args.mcts { Some(mcts_calls(subject)) } else { None };
        let row = format!(
            "{},{speed:.0},{},{:.0},{},{},{:032x}",
            subject.name,
            ratio.map_or(String::new(), |ratio| format!("{ratio:.1}")),
            clone_time(&subject.start) * 1e9,
            subject.start.size_in_bytes(),
            mcts.map_or(String::new(), |calls| format!("{calls:.0}")),
            first_digest(subject)?,
        );
        println!("{row}");
        writeln!(csv, "{row}")?;
    }
    if !ratios.is_empty() {
        ratios.sort_by(f64::total_cmp);
        println!(
            "{} games, ratio {:.1} in the median, {:.1} at least",
            ratios.len(),
            ratios[ratios.len() / 2],
            ratios[0]
        );
    }
    if let Some(path) = &args.csv {
        fs::write(path, csv).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

fn subjects(args: &Args) -> anyhow::Result<Vec<Subject>> {
    let mut folders: Vec<PathBuf> = fs::read_dir(&args.games)
        .with_context(|| args.games.display().to_string())?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    folders.sort();
    let mut subjects = Vec::new();
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if args.game.is_empty() || args.game.contains(&name) {
            subjects.push(subject(name, &folder)?);
        }
    }
    if subjects.is_empty() {
        bail!("{}: no such game there", args.games.display());
    }
    Ok(subjects)
}

fn subject(name: String, folder: &Path) -> anyhow::Result<Subject> {
    let file = ["game.txt", "game.vgdl"].iter().map(|file| folder.join(file)).find(|path| path.exists());
    let file = file.with_context(|| format!("{}: no game.txt or game.vgdl", folder.display()))?;
    let game = Game::from_source_as_reference(&fs::read_to_string(&file)?)
        .with_context(|| file.display().to_string())?;
    let level = game.level(&fs::read_to_string(folder.join("lvl0.txt"))?)?;
    let start = game.start_with(&level, Chance::from_java(0));
    Ok(Subject { name, game, start })
}

/// The reference's ticks per second by game.
fn figures(path: &Path) -> anyhow::Result<Vec<(String, f64)>> {
    let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let row = |line: &str| {
        let mut fields = line.split(',');
        Some((fields.next()?.to_owned(), fields.next()?.parse().ok()?))
    };
    Ok(text.lines().skip(1).filter_map(row).collect())
}

/// Random episodes of a game, one after the other.
struct Course<'a> {
    subject: &'a Subject,
    episodes: u64,
    states: Vec<State>,
    draws: Vec<u32>,
    ticks: u64,
    time: Duration,
    /// Of the hash of every visited state, in order.
    digest: u128,
}

impl<'a> Course<'a> {
    fn new(subject: &'a Subject) -> Course<'a> {
        let mut sampler = Seed::from_text(&subject.name).sampler();
        let draws = (0..1 << 16).map(|_| sampler.bits() as u32).collect();
        let (states, digest) = (vec![subject.start.clone(); BATCH], 0);
        Course { subject, episodes: 0, states, draws, ticks: 0, time: Duration::ZERO, digest }
    }

    /// Plays [`BATCH`] episodes, or fewer if `ticks` are reached before.
    fn batch(&mut self, ticks: u64) {
        for state in &mut self.states {
            state.fork_from(&self.subject.start, Chance::from_java(self.episodes as i64));
            self.episodes += 1;
        }
        let clock = ThreadTime::now();
        let mut draw = (self.episodes as usize).wrapping_mul(7919);
        for state in &mut self.states {
            for _ in 0..EPISODE {
                if self.ticks == ticks || state.is_over() {
                    break;
                }
                let actions = self.subject.game.actions(state);
                let drawn = u64::from(self.draws[draw % self.draws.len()]);
                draw += 1;
                let action = actions[(drawn * actions.len() as u64 >> 32) as usize];
                self.subject.game.step(state, action);
                state.settle_hash();
                self.digest = chain(self.digest, state.state_hash().0);
                self.ticks += 1;
            }
        }
        self.time += clock.elapsed();
    }
}

fn chain(digest: u128, hash: u128) -> u128 {
    (digest.rotate_left(5) ^ hash).wrapping_mul(0x2360_ED05_1FC6_5DA4_4385_DF64_9FCC_F645)
}

/// The digest of the states of the first batch. It must be what stepping with hashes from scratch gives.
fn first_digest(subject: &Subject) -> anyhow::Result<u128> {
    const TICKS: u64 = 300;
    let mut course = Course::new(subject);
    course.batch(TICKS);
    let mut digest = 0;
    let (mut ticks, mut draw) = (0, BATCH.wrapping_mul(7919));
    for episode in 0..BATCH {
        let mut state = subject.start.clone();
        state.fork_from(&subject.start, Chance::from_java(episode as i64));
        for _ in 0..EPISODE {
            if ticks == TICKS || state.is_over() {
                break;
            }
            let actions = subject.game.actions(&state);
            let drawn = u64::from(course.draws[draw % course.draws.len()]);
            draw += 1;
            subject.game.step_watched(
                &mut state,
                actions[(drawn * actions.len() as u64 >> 32) as usize],
                &mut (),
            );
            digest = chain(digest, state.state_hash_from_scratch(&subject.game).0);
            ticks += 1;
        }
    }
    if digest != course.digest {
        bail!("{}: the running hash is not the hash from scratch", subject.name);
    }
    Ok(digest)
}

/// Seconds of a warm `clone_from`.
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

/// Forward-model calls per second of MCTS deciding along an episode, its copies included.
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
