//! `arcade play` without its terminal, and then with it.
//!
//! [`session`] is what has been played and what a command does to it; [`view`] is what that looks like; neither knows a
//! terminal, a clock or a file. [`screen`] is the terminal.

pub(crate) mod board;
pub(crate) mod history;
pub(crate) mod screen;
pub(crate) mod session;
pub(crate) mod view;
