//! A game's goals: its winning and losing conditions, whether they can be met, and what they require of
//! levels.

pub(crate) mod attain;
pub(crate) mod goal;
mod points;
pub(crate) mod requirement;
pub(crate) mod win_methods;
