//! Tests of releases under attack, and of twins (copies of games with a different surface).

extern crate infinite_arcade_snapshots as snapshots;

mod trust;
mod twins;
