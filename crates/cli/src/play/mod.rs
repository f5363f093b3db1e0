//! The interactive player of `arcade play`, with and without its terminal.
//!
//! [`session`] holds the episode and the effect of commands; [`view`] draws it; neither uses a terminal, a clock or a
//! file. [`screen`] is the terminal.

pub(crate) mod board;
pub(crate) mod history;
pub(crate) mod screen;
pub(crate) mod session;
pub(crate) mod view;
