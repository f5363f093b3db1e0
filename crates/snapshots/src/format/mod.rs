//! The form of a release on disk: paths, the manifest and its tree of digests, and the versions that wrote it.

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
