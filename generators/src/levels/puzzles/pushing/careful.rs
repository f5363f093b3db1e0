//! The careful player of a finished level among wandering deadly sprites.

use super::lookout::Lookout;
use super::strays::{StrayConfig, StrayLevels};
use crate::games::PushRules;
use base::Seed;
use engine::{Action, Episode, Game, Level, Outcome, SpriteType};

/// The simulated player by which [`StrayLevels`] judges its levels, for a finished level in any theme. It makes the
/// pushes of a known win, and rests or walks about in between to avoid the wandering sprites.
pub struct CarefulPlayer {
    /// The game under plain names. It plays exactly like the game in its theme.
    game: Game,
    level: Level,
    stray: SpriteType,
    lookout: Lookout,
}

impl CarefulPlayer {
    /// Creates the player of a level. `themed` is the game with `rules` in any theme. Returns `None` if the game does
    /// not have these rules, or if the pushes of `win` do not win without wandering sprites.
    pub fn of(rules: PushRules, themed: &Game, level: &Level, win: &Episode) -> Option<CarefulPlayer> {
        let game = rules.game();
        let (theme, plain) = (&themed.description().mapping, &game.description().mapping);
        if theme.len() != plain.len() {
            return None;
        }
        let symbol = |themed: char| {
            theme.iter().position(|line| line.symbol == themed).map_or(themed, |at| plain[at].symbol)
        };
        let text: String = level.to_string().chars().map(symbol).collect();
        let level = game.level(&text).ok()?;
        let mut state = game.start(&level, win.seed);
        for (&action, hash) in win.actions.iter().zip(&win.hashes) {
            game.step(&mut state, action);
            if state.state_hash() != *hash {
                return None;
            }
        }
        if state.outcome() != Outcome::Won {
            return None;
        }
        let (fuse, board) = text.split_once('\n')?;
        let fuse = fuse.chars().position(|symbol| symbol == PushRules::FUSE_SYMBOLS.keg)?;
        let is_stray = |(cell, symbol)| (symbol == PushRules::STRAY).then_some(cell);
        let cells = board.chars().filter(|symbol| *symbol != '\n').enumerate().filter_map(is_stray).collect();
        let board = board.replace(PushRules::STRAY, &PushRules::FLOOR.to_string());
        let levels = StrayLevels::new(rules, StrayConfig::default());
        let lookout = levels.finished(&board, &win.actions, cells, fuse)?;
        let stray = game.sprite_types().find(|stype| game.name(*stype) == "stray")?;
        Some(CarefulPlayer { game, level, stray, lookout })
    }

    /// Plays one episode, looking at the board every `commit` ticks. Returns `true` if the episode is won.
    pub fn wins(&self, commit: usize, seed: Seed) -> bool {
        self.lookout.play_game(&self.game, &self.level, self.stray, commit, seed).is_some()
    }

    /// Returns the player's plan for the whole episode, made without looking again; `None` if no plan wins in time.
    pub fn plan(&self) -> Option<Vec<Action>> {
        self.lookout.blind_plan()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::Rethemed;

    /// In another theme, the player recovered from a level wins more often if it looks before every action.
    #[test]
    fn the_player_of_a_finished_level_looks_and_plans() {
        const PLAYS: u64 = 20;
        let seed = Seed::from_text("strays");
        let rules = PushRules::AMONG_STRAYS[3];
        let levels = StrayLevels::new(rules, StrayConfig { decisions: (30, 60), ..StrayConfig::default() });
        let made = levels.level(seed.child(&rules.name(), 0)).unwrap();
        let retold = Rethemed::of_compounds(&rules.game(), seed).unwrap();
        let game = Game::compile(&retold.description).unwrap();
        let level = game.level(&retold.level(&made.text)).unwrap();
        let symbol = |plain: &str| retold.level(plain).as_bytes()[0];
        let (floor, stray) = (game.places(symbol(".")), game.places(symbol("y")));
        let stray = *stray.iter().find(|stype| !floor.contains(stype)).unwrap();
        let won = |of_win| Some((of_win, levels.win(&made, (&game, &level), stray, of_win)?));
        let (of_win, actions) = (0..3).find_map(|number| won(seed.child("win", number))).unwrap();
        let (mut win, mut state) = Episode::begin(&game, &level, of_win);
        for action in actions {
            win.play(&game, &mut state, action);
        }
        let player = CarefulPlayer::of(rules, &game, &level, &win).unwrap();
        let wins = |commit| (0..PLAYS).filter(|play| player.wins(commit, seed.child("dice", *play))).count();
        assert!(wins(1) > wins(10), "{} {}", wins(1), wins(10));
        assert!(player.plan().unwrap().len() >= 30);
        assert!(CarefulPlayer::of(PushRules::AMONG_STRAYS[0], &game, &level, &win).is_none());
    }
}
