//! A scale of ability over the months. The difficulties of levels and the abilities of players are estimated
//! from episodes of examinees that never change.
//!
//! The logit of the probability of winning is a sum of terms. The ability of the player is added, and the
//! difficulties of the month, the game and the level are subtracted. Two matches are added: between the
//! player's family and the game, and between the player and the game.
//!
//! Difficulty has two dimensions, one for planners and one for readers. The difficulty for readers is a slope
//! times the difficulty for planners, plus an independent rest.
//!
//! [`Calibration`] estimates spreads by Laplace's method, corrects their shrinkage by a parametric bootstrap,
//! and adds months with fixed abilities and spreads. [`ability()`] estimates the ability of a player by
//! quadrature. [`expected_error`] supports planning, and [`Selection`] chooses levels adaptively.

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
