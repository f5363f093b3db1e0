//! Tests worlds and their shortcuts: copies, scenery, fixtures and flights.

mod fixtures;
mod flight;
mod moved;
mod overrides;
mod paths;
mod scenery;
