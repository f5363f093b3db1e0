//! Whole games on request: for `arcade generate games`, and for the releases that are minted from them.
//!
//! Rules are either drawn from kernels or invented. Inventions are drawn, or found by a search that is guided by quick
//! looks at a few boards. Levels are then found. If the game needs a time limit, the limit is set by the wins of these
//! levels. The panel makes the final decision, with its own seeds and with players that no search has used. No byte
//! depends on the number of threads.

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
pub use make::{GameSet, GamesError, NO_RULES, Shortfall, attempt_kernel, make_games, make_one};
pub use order::{Board, GameEffort, GameOrder};
pub use puzzles::{PuzzleLevels, PuzzleRules};
pub use sets::cast::Cast;
pub use sets::rule_sets::RuleSets;
