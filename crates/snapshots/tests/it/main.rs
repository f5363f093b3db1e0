//! Releases: in hostile hands, as twins.

extern crate infinite_arcade_snapshots as snapshots;

mod trust;
mod twins;
