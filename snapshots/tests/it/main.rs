//! Releases: in hostile hands, as twins.

mod trust;
mod twins;
