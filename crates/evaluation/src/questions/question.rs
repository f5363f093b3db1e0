//! A question with its exact answer, and the evidence for the answer.

use engine::Action;
use serde::{Deserialize, Serialize};

base::named_enum! {
    /// The kind of a question.
    pub enum QuestionKind {
        /// The board after given actions, to be written out.
        NextBoard = "next-board",
        /// The board after given actions, to be chosen from four boards.
        BoardChoice = "board-choice",
        /// A yes/no question: can a position be won?
        Winnable = "winnable",
        /// A yes/no question: can a position be won within a number of actions?
        WinWithin = "win-within",
        /// The one rule out of four that is switched off in the second of two recordings.
        ChangedRule = "changed-rule",
        /// The one sentence out of four that describes a sprite in a recording.
        SpriteBehaviour = "sprite-behaviour",
    }
}

/// A single-turn question about a level, with exactly one right answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Question {
    /// The question's ID, which is unique among the questions of one draw.
    pub id: String,
    /// The kind of the question.
    pub kind: QuestionKind,
    /// The ID of the game.
    pub game: String,
    /// The level number.
    pub level: usize,
    /// The complete prompt, including the options and the answer format.
    pub prompt: String,
    /// The texts of the options A, B, C and D. Empty unless the question is multiple choice.
    pub options: Vec<String>,
    /// The right answer: a letter, `yes`, `no`, or a board with one line per row.
    pub answer: String,
    /// The evidence for the answer.
    pub check: Evidence,
}

/// The evidence from which the answer to a question can be derived again. A list that does not apply to the
/// question's kind is empty.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// The instructions for checking the answer.
    pub how: String,
    /// The actions from the start of the level to the position in question.
    pub before: Vec<Action>,
    /// The actions that the question is about. They follow `before`.
    pub actions: Vec<Action>,
    /// A win from the position, if the position can be won. It is the shortest win if the question states a number
    /// of actions.
    pub win: Vec<Action>,
    /// The number of actions that the question states.
    pub within: Option<u64>,
    /// The number of distinct states that the search for a win covered.
    pub states: Option<u64>,
    /// The source of each option, in the order of the options.
    pub options: Vec<OptionSource>,
}

/// The actions and rules that produce an option.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OptionSource {
    /// The actions to play. They follow [`Evidence::before`].
    pub actions: Vec<Action>,
    /// The index of the switched-off interaction in the game's InteractionSet, if any.
    pub without: Option<usize>,
    /// The VGDL text of a game with one changed rule. Empty for the rules of the game itself.
    pub vgdl: String,
}
