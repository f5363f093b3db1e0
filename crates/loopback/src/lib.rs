//! An HTTP server on a local port, with bounds on connections, time and memory.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod bounds;
mod seats;
mod server;

pub use bounds::Bounds;
pub use seats::{Asker, Kept, Seat};
pub use server::{Bodies, Unread, answer, bind};
