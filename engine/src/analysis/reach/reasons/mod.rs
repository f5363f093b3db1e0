//! Reasons why a level cannot be won.

pub(crate) mod cause;
pub(crate) mod chain;
pub(crate) mod payment;
pub(crate) mod tally;
