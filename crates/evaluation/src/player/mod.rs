//! Players: planners that see the state, and agents that see turns.

mod builtin;
pub mod mailbox;
mod model;
pub mod process;
mod touching;

pub use builtin::{Contestant, Replay};
pub use model::ModelPlayer;
pub use touching::Touching;

use crate::client::{ChatError, ChatErrorKind};
use crate::log::{Event, Journal};
use crate::predictions::Predicted;
use crate::run::Task;
use crate::turn::Turn;
use engine::Action;

/// A player that sees nothing of the game but the turns passed to it.
pub trait Agent: Send {
    /// Chooses the next action, or the next actions if the player commits to several ([`Turn::due`]).
    ///
    /// Every message and every payment must be added to the journal as it happens, both before and after each
    /// request. This way, nothing is lost or paid for twice if the program is killed. Events recorded for
    /// this turn by an interrupted run are already in the journal ([`Journal::pending`]), and must be used
    /// before making any request.
    ///
    /// # Errors
    /// Returns an error if no choice can be made and the player is not at fault. The episode is then aborted.
    fn act(&mut self, turn: &Turn<'_>, journal: &mut Journal) -> Result<Choice, Halt>;

    /// Shows the agent a turn from an interrupted episode, together with the recorded choice. This happens
    /// while the episode is replayed from its log.
    ///
    /// # Errors
    /// Returns an error if the agent cannot resume the episode.
    fn recall(&mut self, turn: &Turn<'_>, journal: &Journal, choice: &Choice) -> Result<(), Halt>;

    /// Begins an episode, which may be the next level in a series. The agent remembers the earlier levels of
    /// the series.
    fn begin(&mut self, _task: &Task<'_>) {}

    /// Answers the question after the last level in a series. The question asks which of the given sprite
    /// types kill, stop, disappear or score when they are touched. Returns `None` for players that cannot
    /// answer questions. Answers already in the journal are used as in [`act`](Agent::act).
    ///
    /// # Errors
    /// Returns an error if there is no answer and the player is not at fault. The episode is then aborted.
    fn predict(
        &mut self,
        _last: &Turn<'_>,
        _kinds: &[String],
        _journal: &mut Journal,
    ) -> Result<Option<Said>, Halt> {
        Ok(None)
    }

    /// Shows the agent the final observation after the end of the episode. No answer is expected, and the
    /// method cannot fail.
    fn end(&mut self, _last: &Turn<'_>) {}
}

/// An agent's answer to the last question in a series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// The predictions, or `None` if no answer could be read.
    pub predicted: Option<Predicted>,
    /// The validity of the answer.
    pub validity: Validity,
}

/// An agent's decision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The actions to play, one per tick. Missing actions are filled with [`Action::Nil`], and surplus actions are
    /// ignored. An action that is unavailable when it is due is replaced by [`Action::Nil`].
    pub actions: Vec<Action>,
    /// The validity of the choice.
    pub validity: Validity,
}

impl Choice {
    /// Creates a choice with a single action.
    pub fn of(action: Action) -> Choice {
        Choice::plan(vec![action])
    }

    /// Creates a choice with several actions, in the order in which they will be played.
    pub fn plan(actions: Vec<Action>) -> Choice {
        Choice { actions, validity: Validity::Valid }
    }

    /// Creates the choice of doing nothing, for a player without a usable answer.
    pub fn nothing(validity: Validity) -> Choice {
        Choice { actions: Vec::new(), validity }
    }

    /// Returns the action for a tick. Ticks are counted from the decision.
    pub fn action(&self, tick: usize) -> Action {
        self.actions.get(tick).copied().unwrap_or(Action::Nil)
    }
}

base::named_enum! {
    /// The validity of a choice: [`Valid`](Validity::Valid), or the reason why there is no usable answer. All tables
    /// list the reasons separately.
    pub enum Validity {
        /// The player stated the action.
        Valid = "valid",
        /// No answer could be read as an action, even after repeated questions. The player is at fault, and
        /// does nothing.
        Invalid = "invalid",
        /// The player declined to answer.
        Refused = "refused",
        /// The answer was cut off before it stated an action.
        Truncated = "truncated",
    }
}

/// The reason why there is no choice, if the player is not at fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Halt {
    /// Every try failed because of the network, the server or the player's process.
    #[error("{0}")]
    Infrastructure(String),
    /// No server accepts connections, so the evaluation cannot begin.
    #[error("{0}")]
    Unreachable(String),
    /// The next request would exceed the given spending limit.
    #[error("{0}")]
    Budget(String),
    /// The server rejects all requests of this kind, for example because of a wrong key or an unknown model,
    /// so the evaluation cannot continue.
    #[error("{0}")]
    Rejected(String),
    /// The server rejects this game's prompts because of their content, so the player cannot play this game.
    /// Other games may work.
    #[error("{0}")]
    Unfit(String),
    /// None of the evaluation's first decisions has a usable answer.
    #[error("{0}")]
    Unusable(String),
    /// The user requested a stop.
    #[error("interrupted")]
    Interrupted,
    /// The episode's log cannot be written.
    #[error("{0}")]
    Log(String),
}

impl From<ChatError> for Halt {
    fn from(error: ChatError) -> Halt {
        match error.kind {
            ChatErrorKind::Infrastructure => Halt::Infrastructure(error.message),
            ChatErrorKind::Unreachable => Halt::Unreachable(error.message),
            ChatErrorKind::Budget => Halt::Budget(error.message),
            ChatErrorKind::Rejected => match error.failures.last().and_then(|failure| failure.status) {
                // These codes mean that only this request is at fault, whereas a wrong key or model affects
                // all requests.
                Some(400 | 413 | 422) => Halt::Unfit(error.message),
                _ => Halt::Rejected(error.message),
            },
        }
    }
}

impl Halt {
    /// Returns the event to record in the log, or `None` if the log itself has failed or there is nothing to
    /// record.
    pub fn event(&self) -> Option<Event> {
        let reason = match self {
            Halt::Infrastructure(_) | Halt::Unreachable(_) => "infrastructure",
            Halt::Budget(_) => "budget",
            Halt::Rejected(_) | Halt::Unfit(_) => "rejected",
            Halt::Unusable(_) => "unusable",
            Halt::Interrupted | Halt::Log(_) => return None,
        };
        Some(Event::Halt { reason: reason.to_owned(), message: self.to_string() })
    }
}
