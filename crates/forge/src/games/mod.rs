//! Whole games on request: for `arcade generate games`, and for the releases that are minted from them.
//!
//! Rules come from a generator, or from a search that is guided by the results of weak players on a few quick levels.
//! Then levels are found, a time limit is derived from their wins if the game needs one, and the panel makes the final
//! decision, with its own seeds and with players that no search has used. No byte depends on the number of threads.

mod apart;
mod attempt;
mod candidate;
mod inventing;
mod kept;
mod levels;
mod likeness;
mod look;
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
pub use make::{
    GameSet, GamesError, NO_RULES, Shortfall, attempt_kernel, make_archive, make_games, make_one,
};
pub use order::{Board, GameEffort, GameOrder};
pub use puzzles::{PuzzleLevels, PuzzleRules};
pub use sets::cast::Cast;
pub use sets::rule_sets::{RuleSets, Supply};
