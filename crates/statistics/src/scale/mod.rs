//! One scale of ability over the months: difficulties of levels and abilities of players, estimated from episodes of
//! examinees that never change.
//!
//! The logit of the probability to win is the ability of the player, minus the difficulty of the month, game and
//! level, plus the match of the player's family and the game, plus the match of the player and the game. Difficulty
//! has two dimensions: one for planners, and one for readers. A difficulty for readers is a slope times the
//! difficulty for planners, plus an independent rest. [`Calibration`] estimates spreads by Laplace's method, whose
//! shrinkage a parametric bootstrap corrects, and adds months with fixed abilities and spreads. [`ability()`]
//! estimates the ability of a player by quadrature. [`expected_error`] supports planning, and [`Selection`] chooses
//! levels adaptively.

mod ability;
mod calibration;
mod logistic;
mod maximise;
mod plays;
mod posterior;
mod replicate;
mod selection;
pub mod simulated;
mod spreads;

pub use ability::{Ability, MismatchPrior, PlayedGame, PlayedLevel, ability};
pub use calibration::{Calibration, Difficulties, Estimated, GameDifficulties, Month};
pub use plays::{Dimension, Examinee, GamePlays, Plays};
pub use replicate::Correlated;
pub use selection::{Chosen, Selection, expected_error};
pub use spreads::Spreads;
