//! Tests of releases: under attack, and as twins.

extern crate infinite_arcade_snapshots as snapshots;

mod trust;
mod twins;
