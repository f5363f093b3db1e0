//! Games in progress. Single ticks can be undone, and the memory of each game is limited.

use crate::compiled::Compiled;
use crate::frames::{Frame, TileSvg, Tiles, action_name};
use crate::refusal::Refusal;
use agents::{Budget, Planner, PlannerSpec, Player};
use base::Seed;
use engine::{Action, Episode, Level, State};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// The maximum number of sessions. Beyond this limit, the oldest session is dropped.
const MOST: usize = 32;
/// The maximum number of states stored per session.
const KEPT: usize = 64;
/// The maximum total size of the states stored per session, in bytes.
const KEPT_BYTES: usize = 8 << 20;
/// The maximum number of forward-model calls per planner decision.
const MOST_CALLS: u64 = 10_000;
/// The number of forward-model calls per decision for a planner whose name contains no number.
const USUAL_CALLS: u64 = 400;

/// A game in progress.
pub(crate) struct Session {
    compiled: Arc<Compiled>,
    level: Level,
    seed: Seed,
    episode: Episode,
    /// The state after the first `at` actions.
    state: State,
    at: usize,
    /// The number of ticks between two stored states. It doubles when there are too many states.
    stride: usize,
    /// The states after 0, `stride`, 2 × `stride`, … ticks.
    kept: Vec<State>,
    tiles: Tiles,
    planner: Option<(String, Player)>,
}

/// The response to a session request: the new tiles, the board, and the action that led to the board.
pub(crate) struct Shown {
    pub(crate) tiles: Vec<TileSvg>,
    pub(crate) frame: Frame,
    pub(crate) action: Option<String>,
}

impl Session {
    /// Begins a game. The seed text has the same meaning as in `arcade play`.
    pub(crate) fn begin(compiled: Arc<Compiled>, level: Level, seed: &str) -> Session {
        let seed = Seed::from_text(seed).child(&level.digest().to_string(), 0);
        let (episode, state) = Episode::begin(&compiled.game, &level, seed.child("chance", 0));
        let (kept, tiles, planner) = (vec![state.clone()], Tiles::default(), None);
        Session { compiled, level, seed, episode, state, at: 0, stride: 8, kept, tiles, planner }
    }

    /// Returns the current board.
    pub(crate) fn show(&mut self, action: Option<Action>) -> Result<Shown, Refusal> {
        let frame = Frame::of(&self.compiled, &self.state, self.at, &mut self.tiles)?;
        Ok(Shown { tiles: self.tiles.fresh(), frame, action: action.map(action_name) })
    }

    /// Plays a tick. Drops the ticks that were previously played after this point. Has no effect if the game is over.
    pub(crate) fn act(&mut self, action: Action) {
        if self.state.is_over() {
            return;
        }
        self.episode.actions.truncate(self.at);
        self.episode.hashes.truncate(self.at);
        self.kept.truncate(self.at / self.stride + 1);
        self.episode.play(&self.compiled.game, &mut self.state, action);
        self.at += 1;
        if self.at.is_multiple_of(self.stride) {
            self.kept.push(self.state.clone());
            self.thin();
        }
    }

    /// Doubles the stride while the stored states are too many or too large.
    fn thin(&mut self) {
        let bytes = |kept: &[State]| kept.iter().map(State::size_in_bytes).sum::<usize>();
        while self.kept.len() > 2 && (self.kept.len() > KEPT || bytes(&self.kept) > KEPT_BYTES) {
            self.stride *= 2;
            let mut number = 0;
            self.kept.retain(|_| {
                number += 1;
                number % 2 == 1
            });
        }
    }

    /// Returns a planner's choice of action.
    pub(crate) fn choose(&mut self, name: &str) -> Result<Action, Refusal> {
        let spec: PlannerSpec = name.parse().map_err(Refusal::bad)?;
        let Budget(calls) = spec.budget().unwrap_or(Budget(USUAL_CALLS));
        if calls > MOST_CALLS {
            return Err(Refusal::bad(format_args!(
                "the studio allows at most {MOST_CALLS} calls per decision"
            )));
        }
        let known = self.planner.take().filter(|(known, _)| known == spec.name());
        let fresh = || (spec.name().to_owned(), spec.player(self.seed.child("planner", 0)));
        let (_, player) = self.planner.insert(known.unwrap_or_else(fresh));
        Ok(player.plan(&self.compiled.game, &self.state, Budget(calls)).0)
    }

    /// Jumps to a tick that has already been played. Cost: playing up to `stride` ticks.
    pub(crate) fn seek(&mut self, tick: usize) {
        self.at = tick.min(self.episode.actions.len());
        let from = (self.at / self.stride).min(self.kept.len() - 1);
        self.state = self.kept[from].clone();
        for &action in &self.episode.actions[from * self.stride..self.at] {
            self.compiled.game.step(&mut self.state, action);
        }
    }

    /// Returns the episode up to the current tick.
    pub(crate) fn episode(&self) -> Episode {
        let mut episode = self.episode.clone();
        episode.actions.truncate(self.at);
        episode.hashes.truncate(self.at);
        (episode.outcome, episode.score) = (self.state.outcome(), self.state.score());
        assert!(episode.level == self.level.digest());
        episode
    }
}

/// The sessions, by number.
#[derive(Default)]
pub(crate) struct Sessions(Mutex<Numbered>);

#[derive(Default)]
struct Numbered {
    next: u64,
    all: VecDeque<(u64, Arc<Mutex<Session>>)>,
}

impl Sessions {
    /// Adds a session and returns its name.
    pub(crate) fn add(&self, session: Session) -> String {
        let mut numbered = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let number = numbered.next;
        numbered.next += 1;
        if numbered.all.len() == MOST {
            numbered.all.pop_front();
        }
        numbered.all.push_back((number, Arc::new(Mutex::new(session))));
        number.to_string()
    }

    /// Calls `work` with a session.
    pub(crate) fn with<T>(
        &self,
        name: &str,
        work: impl FnOnce(&mut Session) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        let found = {
            let numbered = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            numbered.all.iter().find(|(number, _)| number.to_string() == name).map(|(_, found)| found.clone())
        };
        let Some(session) = found else {
            return Err(Refusal::missing("this game was closed, because newer games took its place")
                .help("start it again"));
        };
        work(&mut session.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
