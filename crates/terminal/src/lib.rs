//! Playing a level in a terminal: by hand, by a planner that is watched, or as a replay of a recorded episode.
//!
//! A [`Session`] holds the episode and the effect of commands, and a [`View`] draws it; neither uses a terminal, a clock or a file.
//! [`play`] is the terminal.

mod board;
mod history;
mod screen;
mod session;
mod view;

pub use screen::{PlayError, play};
pub use session::{Command, MAX_PACE, Player, Session};
pub use view::View;
