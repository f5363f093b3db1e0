//! Whole games on request: for `arcade generate games`, and for the releases that are minted from them.
//!
//! Rules are drawn from kernels, or invented: drawn, or found by a search that is told how a few quick boards fare. Then levels are
//! found, a time limit is set by their wins where the game needs one, and the panel has the last word, with dice of its own and with players that no
//! search has seen. No byte depends on the number of threads.

mod apart;
mod attempt;
mod candidate;
mod inventing;
mod kept;
mod levels;
mod likeness;
mod make;
mod order;
pub(crate) mod puzzles;
mod searched;
mod sets;

pub mod report;

pub(crate) use apart::FarInventions;
pub use candidate::{Candidate, MadeGame, marked, slug};
pub use inventing::{invent_games, invent_one};
pub use kept::{Kept, KeptGame};
pub(crate) use levels::{Drawn, judges_seed};
pub use levels::{FoundLevel, FoundLevels, Levels};
pub(crate) use likeness::are_one_board;
pub use make::{GameSet, GamesError, NO_RULES, attempt_kernel, make_games, make_one};
pub use order::{Board, GameEffort, GameOrder};
pub use puzzles::{PuzzleLevels, PuzzleRules};
pub use sets::cast::Cast;
pub use sets::rule_sets::RuleSets;
