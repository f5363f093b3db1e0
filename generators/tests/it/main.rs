//! Searches and measures of the generators.

extern crate infinite_arcade_generators as generators;

mod evolution;
mod measures;
