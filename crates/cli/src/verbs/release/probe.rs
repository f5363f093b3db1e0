//! The speed of this machine: a few fixed plays, timed.

use agents::{Budget, Limits, Mcts, MctsConfig, Olets, OletsConfig, Planner, play};
use base::Seed;
use cpu_time::ThreadTime;
use engine::{Game, Level};
use snapshots::{Corpus, CorpusGame};

/// The games of the probe: of pushing, of chasing, and of shooting.
const GAMES: [&str; 3] = ["dormouse-millrace", "bellwether-down", "hailglass"];
/// Ticks of a play, and forward-model calls of a decision.
const TICKS: usize = 200;
const CALLS: u64 = 400;
/// The number of times that all is played: the fastest counts, since other work only slows plays down.
const TIMES: u64 = 3;
/// The seconds of one core that the plays take on the machine that docs/reference/recipes.md describes, both cores playing.
const USUAL: f64 = 0.109;

/// Returns how many times longer this machine takes than the one that costs were measured on, with all threads of the current pool at
/// work; `None` if the corpus lacks a game of the probe. Cost: about a third of a second of each thread.
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

/// Plays all games once, and returns the seconds of this thread.
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
