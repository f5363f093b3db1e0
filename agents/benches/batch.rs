//! How much faster two threads step a batch than one: `cargo bench -p infinite-arcade-agents --bench batch`.
//!
//! Both play the same episodes of each corpus game, in turns, so that whatever else the machine does falls on both; the
//! best round of each counts. That the states are the same in the end is asserted.

#![allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![allow(clippy::print_stdout, reason = "a benchmark prints what it measured")]

use agents::Batch;
use engine::{Action, Game, Level, Seed};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::fs;
use std::path::Path;
use std::time::Instant;

/// States of a batch.
const LANES: usize = 1024;
/// Ticks of a round.
const TICKS: usize = 96;
/// How often each number of threads has its turn.
const ROUNDS: usize = 9;
/// Ticks of a call: one, as learners play, and some, as planners do.
const CALLS: [usize; 2] = [1, 16];

fn main() {
    let pools = [1, 2].map(|threads| {
        ThreadPoolBuilder::new().num_threads(threads).build().expect("two threads can be started")
    });
    println!(
        "{:<16} {:>13} {:>16} {:>16} {:>7}",
        "game", "ticks a call", "1 thread, tick/s", "2 threads", "ratio"
    );
    let mut ratios = Vec::new();
    for (name, game, levels) in corpus() {
        for ticks in CALLS {
            let mut best = [f64::INFINITY; 2];
            for _ in 0..ROUNDS {
                let rounds = [0, 1].map(|at| round(&pools[at], &game, &levels, ticks));
                assert_eq!(rounds[0].1, rounds[1].1, "{name}: threads make a difference");
                best = [0, 1].map(|at| best[at].min(rounds[at].0));
            }
            let [one, two] = best.map(|seconds| (LANES * TICKS) as f64 / seconds);
            println!("{name:<16} {ticks:>13} {one:>16.0} {two:>16.0} {:>7.2}", two / one);
            ratios.push(two / one);
        }
    }
    ratios.sort_by(f64::total_cmp);
    println!("median ratio {:.2}, least {:.2}", ratios[ratios.len() / 2], ratios[0]);
}

/// Plays so many ticks a call; the seconds of the calls alone, and the sum of the hashes of the states in the end.
fn round(pool: &ThreadPool, game: &Game, levels: &[Level], ticks: usize) -> (f64, u128) {
    let seed = Seed::from_text("bench");
    let mut sampler = seed.child("actions", 0).sampler();
    let mut batch = Batch::start(game, levels, LANES, seed).expect("there are levels");
    let mut seconds = 0.0;
    for _ in 0..TICKS / ticks {
        let plans: Vec<Action> = (0..LANES * ticks).map(|_| *sampler.choose(&Action::ALL)).collect();
        pool.install(|| {
            let before = Instant::now();
            batch.play(&plans).expect("as many for each");
            batch.reset_over();
            seconds += before.elapsed().as_secs_f64();
        });
    }
    let hashes = batch.states().iter().map(|state| state.state_hash().0);
    (seconds, hashes.fold(0, u128::wrapping_add))
}

/// The games of the corpus with their levels.
fn corpus() -> Vec<(String, Game, Vec<Level>)> {
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpora");
    let entries = fs::read_dir(corpora).expect("the corpus is in the repository");
    let mut folders: Vec<_> = entries.map(|entry| entry.expect("a folder").path()).collect();
    folders.sort();
    let load = |folder: &std::path::PathBuf| {
        let name = folder.file_name().expect("it has a name").to_string_lossy().into_owned();
        let source = fs::read_to_string(folder.join("game.vgdl")).expect("a game");
        let game = Game::from_source(&source).expect("a valid game");
        let texts =
            (0..).map_while(|number| fs::read_to_string(folder.join(format!("lvl{number}.txt"))).ok());
        let levels = texts.map(|text| game.level(&text).expect("a valid level")).collect();
        (name, game, levels)
    };
    folders.iter().map(load).collect()
}
