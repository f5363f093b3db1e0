//! Tests the test vectors of the specification.

mod cycle;
mod effects;
mod motion;
mod positions;
mod sprites;
mod time_and_edges;
mod vector;
