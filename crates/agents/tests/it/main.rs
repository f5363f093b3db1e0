//! Tests of the planners.

extern crate infinite_arcade_agents as agents;

mod heuristics;
mod mcts;
mod mcts_guided;
mod nearest_goal;
mod olets;
mod open_loop;
mod registry;
mod systematic;
mod touch_everything;
