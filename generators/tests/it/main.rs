//! Searches and measures of the generators.

mod evolution;
mod measures;
