//! Reads actions from players' answers.
//!
//! Prompts request a strict format. `read.rs` reads the format for a single action, and `plan.rs` reads
//! the format for several actions. The rules in `decisions.rs` read an answer in any other format, and the
//! log records which rule applied. No rule guesses. The last decision in an answer counts. It is invalid if
//! it negates or judges its action, or states a second action. A number counts as an action only immediately
//! after the word "action". The test vectors come from `spec/06` §1.5.

mod choice;
mod decisions;
mod phrase;
mod plan;
mod read;
mod text;

pub use choice::{read_board, read_choice};
pub use plan::read_plan;
pub use read::read;
pub(crate) use text::boundary;
pub use text::without_reasoning;

use engine::Action;

/// The answer format that a prompt requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The last line has the form `ACTION: left`.
    Word,
    /// At least one line has the form `Action:2`, where 2 is the action's number in the list. The last such
    /// line counts.
    Number,
}

base::named_enum! {
    /// The rule that read an answer in a format other than the requested one.
    pub enum Stage {
        /// A JSON key with its value, such as `"action": "left"`.
        Json = "json",
        /// A tag around an action: `<answer>left</answer>`.
        Tag = "tag",
        /// A word such as "action" or "final answer", immediately followed by an action, such as `**Action:**
        /// left` or `action 2`.
        Marker = "marker",
        /// A word such as "action", followed by more words and then an action, such as `Action: I move left`.
        Line = "line",
        /// The reference engine's spelling of an action, such as `ACTION_LEFT`.
        Reference = "reference",
        /// An action alone on a line or in quotes, or a statement of a move, such as `I go up`.
        Words = "words",
    }
}

/// The result of reading an answer: an action, or the actions of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reading<T = Action> {
    /// A choice in the requested format.
    Strict(T),
    /// A choice in a different format.
    Tolerant {
        /// The choice that the answer states.
        choice: T,
        /// The rule that found the choice.
        stage: Stage,
    },
    /// The answer states no choice, or an unavailable one.
    Invalid {
        /// The reason, as a clause whose subject is the answer, such as `it names no action`.
        why: String,
    },
}

impl<T> Reading<T> {
    /// Returns the choice that the answer states, if any.
    pub fn choice(self) -> Option<T> {
        match self {
            Reading::Strict(choice) | Reading::Tolerant { choice, .. } => Some(choice),
            Reading::Invalid { .. } => None,
        }
    }

    /// Converts the choice with a function, without changing the variant or the stage.
    pub fn map<U>(self, convert: impl FnOnce(T) -> U) -> Reading<U> {
        match self {
            Reading::Strict(choice) => Reading::Strict(convert(choice)),
            Reading::Tolerant { choice, stage } => Reading::Tolerant { choice: convert(choice), stage },
            Reading::Invalid { why } => Reading::Invalid { why },
        }
    }
}
