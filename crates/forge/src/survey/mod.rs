//! Surveys of levels and games from any source, hand-written or generated. All are judged by the same criteria with the
//! same budget, so that sets can be compared.
//!
//! The reports of [`levels`](crate::levels::report) and [`games`](crate::games::report) summarise a set. [`Comparison`]
//! compares two groups of games, as `docs/lab/side-by-side.md` explains. [`GateSurvey`] puts games through the gates of
//! `docs/reference/gates.md`.

mod compare;
mod edge;
mod game;
mod gates;
mod level;
mod row;
mod surveyed;

pub use compare::{Comparison, Line};
pub use edge::{Edge, SEARCH};
pub use game::GameSurvey;
pub use gates::{GateAnswer, GateRow, GateSurvey};
pub(crate) use level::FOR_NOTHING;
pub use level::{LevelSurvey, SurveyedLevel};
pub use row::GameRow;
pub use surveyed::SurveyedGame;

#[cfg(test)]
mod tests;
