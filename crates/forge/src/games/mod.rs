//! Whole games on request, for `arcade generate games` and for minting releases.
//!
//! Rules are either drawn from hand-written designs (kernels) or invented. Inventions are drawn at random, or found by
//! a search that evaluates them quickly on a few boards. Levels are then found. If the game needs a time limit, the
//! limit is derived from the levels' wins. The panel makes the final decision, with its own seeds and with players that
//! no search has used. The number of threads does not change any byte of the output.

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
pub use levels::{FinishedLevels, FoundLevels, Levels};
pub use make::{GameSet, GamesError, NO_RULES, attempt_kernel, make_games, make_one};
pub use order::{Board, GameEffort, GameOrder};
pub use puzzles::{PuzzleLevels, PuzzleRules};
pub use sets::cast::Cast;
pub use sets::rule_sets::RuleSets;
