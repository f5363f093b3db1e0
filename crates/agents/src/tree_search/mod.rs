//! Planners that grow a tree of actions.

pub(crate) mod branches;
pub(crate) mod mcts;
pub(crate) mod mcts_guided;
pub(crate) mod olets;
