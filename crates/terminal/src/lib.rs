//! Playing a level in a terminal: by hand, by a planner, or as the replay of a recorded episode.
//!
//! A [`Session`] contains the episode and applies commands, and a [`View`] draws the session. `Session` and
//! `View` do not use a terminal, a clock or a file. [`play`] connects them to the terminal.

mod board;
mod history;
mod screen;
mod session;
mod view;

pub use screen::{PlayError, play};
pub use session::{Command, MAX_PACE, Player, Session};
pub use view::View;
