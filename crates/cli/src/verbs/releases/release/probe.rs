//! The machine's speed, measured by timing a few fixed episodes.

use agents::{Budget, Limits, Mcts, MctsConfig, Olets, OletsConfig, Planner, play};
use base::Seed;
use cpu_time::ThreadTime;
use engine::{Game, Level};
use snapshots::{Corpus, CorpusGame};

/// The probe's games, which are about pushing, chasing and shooting.
const GAMES: [&str; 3] = ["dormouse-millrace", "bellwether-down", "hailglass"];
/// The number of ticks per episode.
const TICKS: usize = 200;
/// The number of forward-model calls per decision.
const CALLS: u64 = 400;
/// The number of repetitions. Only the fastest repetition counts, because other load can only slow episodes
/// down.
const TIMES: u64 = 3;
/// The duration of the episodes, in seconds, on the machine described in docs/reference/recipes.md: on one
/// core, while both cores play.
const USUAL: f64 = 0.109;

/// Returns this machine's slowdown relative to the machine on which the costs were measured, with all threads
/// in the current pool busy. Returns `None` if the corpus lacks any of the probe's games. Cost: about a third
/// of a second per thread.
pub(super) fn slowness(corpus: &Corpus) -> Option<f64> {
    let games = GAMES.iter().map(|name| compiled(corpus.games.iter().find(|game| game.name == *name)?));
    let games = games.collect::<Option<Vec<(Game, Level)>>>()?;
    let seconds = rayon::broadcast(|_| (0..TIMES).map(|_| timed(&games)).fold(f64::INFINITY, f64::min));
    Some(seconds.iter().sum::<f64>() / seconds.len().max(1) as f64 / USUAL)
}

fn compiled(known: &CorpusGame) -> Option<(Game, Level)> {
    let game = Game::from_source(&known.source).ok()?;
    let level = game.level(known.levels.first()?).ok()?;
    Some((game, level))
}

/// Plays all games once, and returns the thread's CPU time in seconds.
fn timed(games: &[(Game, Level)]) -> f64 {
    let clock = ThreadTime::now();
    let seed = Seed::from_text("probe");
    let limits = Limits { ticks: TICKS, ..Limits::default() };
    for (game, level) in games {
        let planners: [Box<dyn Planner>; 2] = [
            Box::new(Olets::new(OletsConfig::default(), seed)),
            Box::new(Mcts::new(MctsConfig::default(), seed)),
        ];
        for mut planner in planners {
            play(game, level, planner.as_mut(), Budget(CALLS), seed, limits);
        }
    }
    clock.elapsed().as_secs_f64()
}
