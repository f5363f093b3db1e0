//! Single-turn questions about levels, with exact answers.
//!
//! [`draw`] draws questions from the levels of games, and [`is_right`] checks an answer. Every answer follows from
//! replays or from exhaustive searches, and [`Evidence`] contains the data for deriving the answer again. Only levels
//! that are deterministic and fully visible are used.
//!
//! An answerer who ignores the game scores at chance. Options are drawn so that each is equally likely to be right, the
//! letters of right options are balanced, and yes/no questions come in pairs with opposite answers, from the same
//! level.

mod boards;
mod check;
mod dataset;
mod draft;
mod draw;
mod place;
mod question;
mod rules;
mod variants;
mod view;
mod wins;

pub use check::{is_right, read};
pub use dataset::{QuestionOrigin, dataset};
pub use draw::{QuestionOrder, draw};
pub use question::{Evidence, OptionSource, Question, QuestionKind};
