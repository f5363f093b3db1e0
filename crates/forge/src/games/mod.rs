//! Whole games on request: for `arcade generate games`, and for the releases that are minted from them.
//!
//! Rules are drawn from kernels, or invented: drawn, or found by a search that is told how a few quick boards fare. Then levels are
//! found, a time limit is set by their wins where the game needs one, and the panel has the last word, with dice of its own and with players that no
//! search has seen. No byte depends on the number of threads.

mod apart;
mod attempt;
mod candidate;
mod found_level;
mod inventing;
mod kept;
mod levels;
mod make;
mod order;
pub(crate) mod puzzles;
mod searched;
mod sets;

pub mod report;

pub(crate) use apart::FarInventions;
pub use candidate::{Candidate, MadeGame, marked, slug};
pub use found_level::FoundLevel;
pub(crate) use found_level::judges_seed;
pub use inventing::{invent_games, invent_one};
pub use kept::{Kept, KeptGame};
pub(crate) use levels::Drawn;
pub use levels::{FoundLevels, Levels};
pub use make::{GameSet, GamesError, NO_RULES, attempt_kernel, make_games, make_one};
pub use order::{Board, GameEffort, GameOrder};
pub use puzzles::{PuzzleLevels, PuzzleRules};
pub use sets::cast::Cast;
pub use sets::rule_sets::RuleSets;
