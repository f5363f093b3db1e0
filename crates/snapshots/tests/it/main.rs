//! Tests of releases under attack and of twins.

extern crate infinite_arcade_snapshots as snapshots;

mod trust;
mod twins;
