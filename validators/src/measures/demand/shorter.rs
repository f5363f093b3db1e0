//! Shorter wins in stochastic games.

use agents::{Budget, Limits, PlannerSpec, play};
use base::SeedPath;
use engine::{Analysis, Episode, Level, Outcome};

/// The planners that play.
const PLANNERS: [&str; 3] = ["width", "guided-mcts", "olets"];
/// The number of episodes, which the planners play in turn.
const PLAYS: u64 = 6;
/// The number of forward-model calls per decision.
const DECISION: Budget = Budget(2000);
/// The minimum length, in ticks, of a known win at which a shorter win might put the level in a different tier
/// (difficulty class).
const LEAST: usize = 20;

/// Searches for a win with fewer ticks than a known win in a stochastic game. In such a game, no search can prove
/// which win is the shortest, and the first win found may be much longer. Returns `None` if no shorter win is found,
/// if the game is deterministic, or if the known win has fewer than 20 ticks.
///
/// Cost: at most 12,000 forward-model calls per tick of the known win.
pub fn shorter_win(
    analysis: &Analysis,
    level: &Level,
    win: &Episode,
    seed: impl Into<SeedPath>,
) -> Option<Episode> {
    let (game, seed) = (analysis.game(), seed.into());
    if win.actions.len() < LEAST || analysis.is_deterministic_from(&game.start(level, seed.seed())) {
        return None;
    }
    let mut shortest = None;
    let mut ticks = win.actions.len();
    for (number, name) in (0..PLAYS).zip(PLANNERS.iter().cycle()) {
        let seed = seed.child("play", number);
        let spec: PlannerSpec = name.parse().expect("a planner of the registry");
        let limits = Limits { ticks: ticks - 1, ..Limits::default() };
        let mut player = spec.player(seed.seed().child(name, 0));
        let episode = play(game, level, &mut player, DECISION, seed, limits).episode;
        if episode.outcome == Outcome::Won {
            ticks = episode.actions.len();
            shortest = Some(episode);
        }
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use engine::{Action, Game};

    /// Searches for a shorter win on a level with a path of three steps. Wasps, if there are any, turn at random.
    fn shorter(level: &str) -> Option<Episode> {
        let game = Game::from_source(
            "BasicGame
    SpriteSet
        floor > Immovable
        door > Immovable
        wasp > RandomNPC
        avatar > MovingAvatar
    LevelMapping
        . > floor
        o > door
        s > wasp
    InteractionSet
        avatar wall > stepBack
        wasp wall > stepBack
        door avatar > killSprite
    TerminationSet
        SpriteCounter stype=door win=True
",
        )
        .unwrap();
        let level = game.level(level).unwrap();
        let (mut win, mut state) = Episode::begin(&game, &level, Seed::from_text("detour"));
        for _ in 0..30 {
            win.play(&game, &mut state, Action::Nil);
        }
        for _ in 0..3 {
            win.play(&game, &mut state, Action::Right);
        }
        assert_eq!(win.outcome, Outcome::Won);
        let found = shorter_win(&Analysis::of(&game), &level, &win, Seed::from_text("shorter"));
        if let Some(episode) = &found {
            let path = SeedPath::new(Seed::from_text("shorter"), episode.path.clone());
            assert_eq!((episode.seed, path.steps().len()), (path.seed(), 1));
        }
        found
    }

    #[test]
    fn waiting_is_left_out() {
        let episode = shorter("wwwwww\nwA..ow\nwwwwww\nw....s\nwwwwww\n").unwrap();
        assert_eq!((episode.outcome, episode.actions.len()), (Outcome::Won, 3));
    }

    /// Checks that no episodes are played on deterministic levels, on which a systematic search performs better.
    #[test]
    fn without_chance_nothing_is_played() {
        assert!(shorter("wwwwww\nwA..ow\nwwwwww\n").is_none());
    }
}
