//! Measures the speedup of two threads over one thread when stepping a batch. Run it with `cargo bench -p
//! infinite-arcade-agents --bench batch`.
//!
//! One thread and two threads take turns at playing the same episodes of each corpus game, so that other load
//! on the machine affects both equally. The best round of each counts. The bench asserts that the resulting
//! states are equal.
//!
//! The first round is not timed. While the buffers of the states still grow, threads contend for memory, and
//! a second thread gains only half as much.

#![allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use base::{Sampler, Seed};
use engine::{Action, Game, Level, State, StateHash};
use infinite_arcade_agents::Batch;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::fs;
use std::path::Path;
use std::time::Instant;

/// The number of states in a batch.
const LANES: usize = 1024;
/// The number of ticks in a round.
const TICKS: usize = 64;
/// The number of timed rounds for each number of threads.
const ROUNDS: usize = 5;
/// The numbers of ticks per call to measure: one as in training, and several as in planning.
const CALLS: [usize; 2] = [1, 16];

fn main() {
    println!(
        "{:<16} {:>13} {:>16} {:>16} {:>7}",
        "game", "ticks a call", "1 thread, tick/s", "2 threads", "ratio"
    );
    let mut ratios = Vec::new();
    for (name, game, levels) in corpus() {
        for ticks in CALLS {
            let mut racers = [1, 2].map(|threads| Racer::new(threads, &game, &levels));
            for _ in 0..=ROUNDS {
                racers.iter_mut().for_each(|racer| racer.round(ticks));
                assert_eq!(racers[0].hashes(), racers[1].hashes(), "{name}: threads make a difference");
            }
            let [one, two] = racers.map(|racer| (LANES * TICKS) as f64 / racer.best);
            println!("{name:<16} {ticks:>13} {one:>16.0} {two:>16.0} {:>7.2}", two / one);
            ratios.push(two / one);
        }
    }
    ratios.sort_by(f64::total_cmp);
    println!("median ratio {:.2}, least {:.2}", ratios[ratios.len() / 2], ratios[0]);
}

/// A contestant of the benchmark: a number of threads with its batch and its actions. All contestants have
/// the same actions.
struct Racer {
    pool: ThreadPool,
    batch: Batch,
    actions: Sampler,
    /// `true` after the first round, in which the buffers of the states grow.
    warm: bool,
    /// The duration of the best round in seconds.
    best: f64,
}

impl Racer {
    fn new(threads: usize, game: &Game, levels: &[Level]) -> Racer {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
        let seed = Seed::from_text("bench");
        let batch = Batch::start(game, levels, LANES, seed.child("batch", 0)).expect("there are levels");
        Racer { pool, batch, actions: seed.child("actions", 0).sampler(), warm: false, best: f64::INFINITY }
    }

    /// Plays a round with `ticks` ticks per call. Only the calls are timed.
    fn round(&mut self, ticks: usize) {
        let Racer { pool, batch, actions, .. } = self;
        let mut seconds = 0.0;
        for _ in 0..TICKS / ticks {
            let plans: Vec<Action> = (0..LANES * ticks).map(|_| *actions.choose(&Action::ALL)).collect();
            pool.install(|| {
                let before = Instant::now();
                batch.play(&plans).expect("every lane has the same number of actions");
                batch.reset_over();
                seconds += before.elapsed().as_secs_f64();
            });
        }
        if std::mem::replace(&mut self.warm, true) {
            self.best = self.best.min(seconds);
        }
    }

    fn hashes(&self) -> Vec<StateHash> {
        self.batch.states().iter().map(State::state_hash).collect()
    }
}

/// Returns the corpus games with their levels.
fn corpus() -> Vec<(String, Game, Vec<Level>)> {
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora");
    let entries = fs::read_dir(corpora).expect("the corpus is in the repository");
    let mut folders: Vec<_> = entries.map(|entry| entry.expect("a folder").path()).collect();
    folders.sort();
    let load = |folder: &std::path::PathBuf| {
        let name = folder.file_name().expect("the game folder has a name").to_string_lossy().into_owned();
        let source = fs::read_to_string(folder.join("game.vgdl")).expect("a game");
        let game = Game::from_source(&source).expect("a valid game");
        let texts =
            (0..).map_while(|number| fs::read_to_string(folder.join(format!("lvl{number}.txt"))).ok());
        let levels = texts.map(|text| game.level(&text).expect("a valid level")).collect();
        (name, game, levels)
    };
    folders.iter().map(load).collect()
}
