//! Sets of games that differ from each other.

pub(crate) mod cast;
pub(crate) mod company;
pub(crate) mod rounds;
pub(crate) mod rule_sets;
