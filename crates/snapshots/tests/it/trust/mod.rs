//! Tests of releases under attack: tampered with, packed and unpacked, chained, proved item by item, and minted by
//! old versions.

mod archives;
mod chains;
mod lineage;
mod old;
mod proofs;
mod small;
mod statements;
#[cfg(unix)]
mod tamper;
mod withheld;
