//! Judgements on a game and a level: each criterion of a release is a validator of its own.
//!
//! A verdict has three answers. *Pass* may carry a witness: an episode that replays. *Fail* says why and may carry a
//! counter-example. *Unknown* says how much was spent: running out of budget is never called unsolvable.

mod idle;
mod length;
mod panel;
mod random;
mod verdict;
mod well_formed;
mod winnable;

pub use idle::NotIdle;
pub use length::LengthWithin;
pub use panel::{Criteria, Judgement, Panel, Report};
pub use random::NotRandom;
pub use verdict::{Case, Finding, Rate, Reason, Validator, Verdict};
pub use well_formed::WellFormed;
pub use winnable::Winnable;
