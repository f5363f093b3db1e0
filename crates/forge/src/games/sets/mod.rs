//! Sets of diverse games.

pub(crate) mod cast;
pub(crate) mod company;
pub(crate) mod rounds;
pub(crate) mod rule_sets;
