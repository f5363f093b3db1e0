//! One scale of ability over the months: difficulties of levels, and abilities of players, from plays of examinees that never
//! change.
//!
//! The logit of a chance to win is the ability of the player, minus the difficulty of the month, game and level, plus the match of
//! the player's family and the game, plus that of the player and the game. Difficulty has two dimensions: for planners, and for
//! readers, whose difficulty is a slope times that for planners plus a rest of its own. [`Calibration`] estimates spreads by
//! Laplace's method, with the parametric bootstrap for what it shrinks, and adds months with abilities and spreads kept; [`ability()`]
//! places a player by quadrature. [`expected_error`] plans, and [`Selection`] chooses levels adaptively.

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
