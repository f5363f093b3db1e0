//! A game with one interaction disabled, to measure the difference that the interaction makes.
//!
//! The interaction still takes place and draws the same random numbers as before, but has no consequences. An episode of
//! the two games is therefore the same up to the first consequence: the random stream does not shift.

use crate::Digest;
use crate::game::Game;
use crate::rules::{EffectInfo, Rules};
use std::sync::OnceLock;

impl Game {
    /// The game in which interaction `line` (index into [`Description::interactions`](crate::Description)) has no
    /// consequences but still draws its random numbers. Levels of one game fit the other. The digest does not belong to
    /// any text. Cost: a copy of the rules.
    ///
    /// # Panics
    /// If there is no such line.
    pub fn without(&self, line: usize) -> Game {
        assert!(line < self.description().interactions.len(), "interaction {line} is one of the game's");
        let mut rules = Rules { all_warnings: OnceLock::new(), ..self.0.rules.clone() };
        for info in rules.effects.iter_mut().filter(|info| info.line == line) {
            *info = EffectInfo {
                apply_score: false,
                score_faults: info.score_faults,
                in_batch: info.in_batch,
                steady: info.steady,
                line,
                ..EffectInfo::of(info.effect.disabled())
            };
        }
        for timed in rules.timed.iter_mut().filter(|timed| timed.line == line) {
            timed.score_change = 0;
            timed.apply_score = false;
        }
        rules.digest = Digest::of(format!("{} without interaction {line}", rules.digest).as_bytes());
        Game::of(rules)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Action, Game, Level, Outcome, Seed};

    const GAME: &str = "BasicGame\n  SpriteSet\n    nut > Immovable\n    moth > RandomNPC\n    squirrel > MovingAvatar\n  LevelMapping\n    n > nut\n    m > moth\n    S > squirrel\n  InteractionSet\n    nut squirrel > killSprite scoreChange=1\n    moth nut > flipDirection\n    moth nut > spawn stype=moth prob=0.5\n    moth EOS > stepBack\n  TerminationSet\n    SpriteCounter stype=nut win=True\n    Timeout limit=50\n";

    fn episode(game: &Game, level: &Level, actions: &[Action]) -> (Outcome, f64, u64, usize) {
        let mut state = game.start(level, Seed::from_text("ablation"));
        for &action in actions {
            game.step(&mut state, action);
        }
        (state.outcome(), state.score(), state.chance().state(), game.records(&state).len())
    }

    #[test]
    fn nothing_follows_and_the_draws_stay() {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("Snnnn\nnnmnn").unwrap();
        let (right, wait) = ([Action::Right; 4], [Action::Nil; 6]);
        assert!(episode(&game, &level, &right).1 >= 4.0);
        let (outcome, score, ..) = episode(&game.without(0), &level, &right);
        assert_eq!((outcome, score), (Outcome::Ongoing, 0.0));
        // A rule that draws and then does nothing, because its probability is 0, is a disabled one.
        let never = Game::from_source(&GAME.replace("prob=0.5", "prob=0.0")).unwrap();
        let without = game.without(2);
        assert_eq!(episode(&without, &level, &wait), episode(&never, &level, &wait));
        assert!(episode(&without, &level, &wait).3 < episode(&game, &level, &wait).3);
        assert_eq!(without.digest(), game.without(2).digest());
        assert_ne!(without.digest(), game.digest());
    }
}
