//! A release's on-disk format: paths, the manifest with its digest tree, and the versions that wrote the
//! format.

pub(crate) mod canary;
pub mod folder;
pub(crate) mod layout;
pub(crate) mod manifest;
pub mod merkle;
pub(crate) mod path;
pub(crate) mod plausible;
pub(crate) mod problem;
pub mod version;
pub(crate) mod witness;
