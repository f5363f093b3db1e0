//! Worlds and their shortcuts: copies, scenery, fixtures, flights.

mod fixtures;
mod flight;
mod moved;
mod overrides;
mod paths;
mod scenery;
