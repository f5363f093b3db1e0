//! Who plays: planners that see the state, and agents that are shown turns.

mod builtin;
mod model;
pub mod process;

pub use builtin::{Contestant, Replay};
pub use model::ModelPlayer;

use crate::log::{Event, Journal};
use crate::turn::Turn;
use engine::Action;
use serde::{Deserialize, Serialize};

/// Chooses actions from what it is shown.
pub trait Agent: Send {
    /// The next action. Whatever is said, heard and paid on the way goes into the journal as it happens, before and after
    /// each request, so that nothing is lost or paid for twice if the program is killed. Events that an interrupted run
    /// has recorded for this turn are in the journal already ([`Journal::pending`]) and are used before anything is asked.
    ///
    /// # Errors
    /// There is no choice, and it is not the player's fault: the episode is broken off.
    fn act(&mut self, turn: &Turn<'_>, journal: &mut Journal) -> Result<Choice, Halt>;

    /// A turn of an interrupted episode that is played again from its log, and what was chosen then.
    ///
    /// # Errors
    /// The agent cannot take it up again.
    fn recall(&mut self, turn: &Turn<'_>, journal: &Journal, choice: &Choice) -> Result<(), Halt>;

    /// The episode has ended: what is seen after the last action. Nothing is asked, and nothing can go wrong any more.
    fn end(&mut self, _last: &Turn<'_>) {}
}

/// What an agent has decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The action to play.
    pub action: Action,
    /// How it came about.
    pub validity: Validity,
}

/// How a choice came about. All but [`Valid`](Validity::Valid) are counted apart in every table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Validity {
    /// The player said so.
    Valid,
    /// No answer could be read as an action, nor when asked again: nothing is done, and it is the player's doing.
    Invalid,
    /// The player would not answer.
    Refused,
    /// The answer was cut off before it came to an action.
    Truncated,
}

/// Why there is no choice, though the player is not to blame.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Halt {
    /// The network, the server or the process of the player failed, however often it was tried.
    #[error("{0}")]
    Infrastructure(String),
    /// The next request would go beyond what may be spent, in these words.
    #[error("{0}")]
    Budget(String),
    /// The server will not have any request of this kind (wrong key, unknown model): no use in going on at all.
    #[error("{0}")]
    Rejected(String),
    /// The user has asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The log cannot be written.
    #[error("{0}")]
    Log(String),
}

impl Halt {
    /// The line of the log; none where the log itself failed, or nothing happened that is worth telling.
    pub(crate) fn event(&self) -> Option<Event> {
        let reason = match self {
            Halt::Infrastructure(_) => "infrastructure",
            Halt::Budget(_) => "budget",
            Halt::Rejected(_) => "rejected",
            Halt::Interrupted | Halt::Log(_) => return None,
        };
        Some(Event::Halt { reason: reason.to_owned(), message: self.to_string() })
    }
}
