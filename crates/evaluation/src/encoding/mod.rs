//! Encodings of observations for players. Each encoding is a pure function of an observation and a legend.
//!
//! A cell is written as `(x,y)`. Columns (`x`) are counted from 0 at the left, and rows (`y`) from 0 at the
//! top.

mod coordinates;
mod events;
mod grid;
mod grounding;
mod json;
mod picture;
mod scene;

pub use coordinates::coordinates;
pub use events::{events, ruled};
pub use grid::{grid, rotated, stacks};
pub use grounding::{directions, grounding, soon};
pub use json::json;
pub use picture::{Picture, picture};
