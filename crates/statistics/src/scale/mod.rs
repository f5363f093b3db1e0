//! A scale of ability across the months. Level difficulties and player abilities are estimated from the episodes of
//! examinees, which are reference players that never change.
//!
//! The logit of the probability of winning is a sum of terms. The player's ability is added, and the difficulties of
//! the month, the game and the level are subtracted. Two match effects are added: one states how well the game suits
//! the player's family, and the other how well it suits the player.
//!
//! Difficulty has two dimensions, one for planners and one for readers (players that see only prompts). The difficulty
//! for readers is the difficulty for planners multiplied by a slope, plus an independent remainder.
//!
//! [`Calibration`] estimates the standard deviations ([`Spreads`]) by Laplace's method, and corrects their shrinkage by
//! a parametric bootstrap. It adds months while abilities and spreads stay fixed. [`ability()`] estimates a player's
//! ability by quadrature. [`expected_error`] supports planning, and [`Selection`] chooses levels adaptively.

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
