//! The speed of this machine, measured by timing a few fixed episodes.

use agents::{Budget, Limits, Mcts, MctsConfig, Olets, OletsConfig, Planner, play};
use base::Seed;
use cpu_time::ThreadTime;
use engine::{Game, Level};
use snapshots::{Corpus, CorpusGame};

/// The games of the probe, which are about pushing, chasing and shooting.
const GAMES: [&str; 3] = ["dormouse-millrace", "bellwether-down", "hailglass"];
/// The number of ticks per episode.
const TICKS: usize = 200;
/// The number of forward-model calls per decision.
const CALLS: u64 = 400;
/// The number of repetitions. Only the fastest repetition counts, because other work can only slow episodes down.
const TIMES: u64 = 3;
/// The time that the episodes take on the machine that docs/reference/recipes.md describes, in seconds of one core.
/// Both cores of that machine were playing.
const USUAL: f64 = 0.109;

/// Returns how many times longer this machine takes than the machine on which costs were measured, with all threads of
/// the current pool at work. Returns `None` if the corpus lacks a game of the probe. Cost: about a third of a second of
/// each thread.
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

/// Plays all games once, and returns the CPU time of this thread in seconds.
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
