//! A play session: the player, the episode, and the effects of commands, without a terminal or a clock.

use super::history::History;
use agents::{Budget, Planner};
use base::Seed;
use engine::{Action, Episode, Game, Level, State};

/// The maximum number of ticks per second.
pub const MAX_PACE: u16 = 60;
/// The number of lines by which Page Up and Page Down scroll the rules.
const PAGE: u16 = 8;

/// The source of the actions.
pub enum Player {
    /// The user at the keyboard.
    Person,
    /// A planner whose play the user watches.
    Planner {
        /// The planner's name on the screen.
        name: String,
        /// The planner, which keeps its plans from tick to tick.
        planner: Box<dyn Planner + Send>,
        /// The budget for each decision.
        budget: Budget,
    },
    /// A recording, whose actions are already known.
    Recording(Vec<Action>),
}

/// A command from the person who plays or watches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Chooses the action for the next tick.
    Act(Action),
    /// Pauses or resumes the clock.
    Pause,
    /// Plays one tick, and then pauses the clock.
    Step,
    /// Restarts the level.
    Restart,
    /// Undoes one tick.
    Undo,
    /// Increases the number of ticks per second.
    Faster,
    /// Decreases the number of ticks per second.
    Slower,
    /// Switches between turn-based play and a running clock.
    TurnBased,
    /// Scrolls the rules down.
    Down,
    /// Scrolls the rules up.
    Up,
    /// Ends the session.
    Quit,
}

/// A session in which a player plays an episode.
pub struct Session {
    game: Game,
    level: Level,
    seed: Seed,
    pub(crate) player: Player,
    history: History,
    /// `true` if ticks are played only when a key chooses an action.
    pub(crate) turn_based: bool,
    pub(crate) paused: bool,
    /// The number of ticks per second while the clock is running.
    pub(crate) pace: u16,
    /// The action for the next tick, chosen by the last key pressed since the previous tick; `None` if no key was
    /// pressed.
    chosen: Option<Action>,
    /// The number of lines by which the rules are scrolled.
    pub(crate) scroll: u16,
    /// `true` once the user has quit.
    pub(crate) over: bool,
}

impl Session {
    /// Starts a session at the beginning of an episode. Only a person can play turn by turn.
    #[must_use]
    pub fn begin(
        (game, level): (Game, Level),
        seed: Seed,
        player: Player,
        turn_based: bool,
        pace: u16,
    ) -> Session {
        let history = History::begin(&game, &level, seed);
        let turn_based = turn_based && matches!(player, Player::Person);
        let (paused, chosen, scroll, over) = (false, None, 0, false);
        let pace = pace.clamp(1, MAX_PACE);
        Session { game, level, seed, player, history, turn_based, paused, pace, chosen, scroll, over }
    }

    /// Returns the state after the last tick.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.history.state
    }

    /// Returns the episode so far.
    #[must_use]
    pub fn episode(&self) -> &Episode {
        &self.history.episode
    }

    /// Returns `true` if the next tick is triggered by the clock rather than by a key.
    #[must_use]
    pub fn runs(&self) -> bool {
        !self.paused && !self.turn_based && !self.is_at_end()
    }

    /// Returns `true` if no further tick is possible.
    #[must_use]
    pub fn is_at_end(&self) -> bool {
        let recorded = match &self.player {
            Player::Recording(actions) => self.history.ticks() >= actions.len(),
            _ => false,
        };
        recorded || self.state().is_over()
    }

    /// Executes a command.
    pub fn handle(&mut self, command: Command) {
        match command {
            Command::Act(action) if matches!(self.player, Player::Person) => {
                self.chosen = Some(action);
                if self.turn_based {
                    self.tick();
                }
            }
            Command::Act(_) => {}
            Command::Pause => self.paused = !self.paused,
            Command::Step => {
                self.paused = !self.turn_based;
                self.tick();
            }
            Command::Restart => {
                self.history = History::begin(&self.game, &self.level, self.seed);
                self.chosen = None;
            }
            Command::Undo => {
                self.history.take_back(&self.game);
                self.chosen = None;
                // Without a pause, the clock would continue immediately.
                self.paused = !self.turn_based;
            }
            Command::Faster => self.pace = (self.pace + self.pace.div_ceil(4)).min(MAX_PACE),
            Command::Slower => self.pace = (self.pace - self.pace.div_ceil(5)).max(1),
            Command::TurnBased if matches!(self.player, Player::Person) => {
                (self.turn_based, self.paused) = (!self.turn_based, false);
            }
            Command::TurnBased => {}
            Command::Down => self.scroll = self.scroll.saturating_add(PAGE),
            Command::Up => self.scroll = self.scroll.saturating_sub(PAGE),
            Command::Quit => self.over = true,
        }
    }

    /// Plays a tick if one is possible. If the player is a person who has not chosen an action, the action is
    /// [`Action::Nil`].
    pub fn tick(&mut self) {
        if self.is_at_end() {
            return;
        }
        let chosen = self.chosen.take();
        let action = match &mut self.player {
            Player::Person => chosen.unwrap_or(Action::Nil),
            Player::Planner { planner, budget, .. } => {
                planner.plan(&self.game, &self.history.state, *budget).0
            }
            Player::Recording(actions) => actions[self.history.ticks()],
        };
        self.history.play(&self.game, action);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Outcome;

    const GAME: &str = "
BasicGame
    SpriteSet
        stone > Immovable
        berry > Immovable
        moth > RandomNPC
        hen > MovingAvatar
    LevelMapping
        s > stone
        b > berry
        m > moth
        h > hen
    InteractionSet
        hen moth stone > stepBack
        moth stone > stepBack
        berry hen > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=berry win=True
";

    fn session(player: Player, turn_based: bool) -> Session {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("ssssss\nsh  bs\ns   ms\nssssss\n").unwrap();
        Session::begin((game, level), Seed::from_text("session"), player, turn_based, 8)
    }

    #[test]
    fn keys_advance_turn_based_games() {
        let mut session = session(Player::Person, true);
        assert!(!session.runs());
        for ticks in 1..=3 {
            session.handle(Command::Act(Action::Right));
            assert_eq!(session.state().tick() + 1, ticks);
        }
        assert_eq!((session.state().outcome(), session.episode().score), (Outcome::Won, 1.0));
        session.handle(Command::Act(Action::Right));
        assert_eq!(session.episode().actions, [Action::Right; 3]);
    }

    #[test]
    fn the_clock_plays_the_last_key_or_nothing() {
        let mut session = session(Player::Person, false);
        assert!(session.runs());
        session.handle(Command::Act(Action::Left));
        session.handle(Command::Act(Action::Right));
        session.tick();
        session.tick();
        assert_eq!(session.episode().actions, [Action::Right, Action::Nil]);
        session.handle(Command::Pause);
        assert!(!session.runs());
        session.handle(Command::TurnBased);
        assert!(session.turn_based && !session.paused);
    }

    #[test]
    fn undone_moves_leave_no_trace() {
        let mut whole = session(Player::Person, true);
        let actions = [Action::Down, Action::Nil, Action::Up, Action::Nil];
        let action = |tick: usize| actions[tick % actions.len()];
        let mut states = Vec::new();
        for tick in 0..100 {
            states.push(whole.state().state_hash());
            whole.handle(Command::Act(action(tick)));
        }
        for tick in (0..100).rev() {
            whole.handle(Command::Undo);
            assert_eq!(whole.state().state_hash(), states[tick], "tick {tick}");
        }
        whole.handle(Command::Undo);
        assert!(whole.episode().actions.is_empty() && whole.episode().hashes.is_empty());
        // After an undo, playing forward again gives the same states and an episode that replays.
        (0..100).for_each(|tick| whole.handle(Command::Act(action(tick))));
        assert!(whole.episode().replay(&whole.game, &whole.level).is_ok());
    }

    #[test]
    fn recordings_end_and_can_be_stepped() {
        let mut session = session(Player::Recording(vec![Action::Down, Action::Up]), true);
        assert!(session.runs() && !session.turn_based);
        session.handle(Command::Step);
        assert!(!session.runs() && session.paused);
        session.handle(Command::Act(Action::Left));
        session.handle(Command::Step);
        session.handle(Command::Step);
        assert_eq!(session.episode().actions, [Action::Down, Action::Up]);
        assert!(session.is_at_end());
        session.handle(Command::Restart);
        assert!(!session.is_at_end());
    }

    #[test]
    fn the_pace_stays_in_bounds() {
        let mut session = session(Player::Person, false);
        (0..40).for_each(|_| session.handle(Command::Faster));
        assert_eq!(session.pace, MAX_PACE);
        (0..80).for_each(|_| session.handle(Command::Slower));
        assert_eq!(session.pace, 1);
        session.handle(Command::Faster);
        assert_eq!(session.pace, 2);
    }
}
