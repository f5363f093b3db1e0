//! A release's items and kind.

use base::Digest;
use serde::{Deserialize, Serialize};

/// The kind of a release, which determines when its seed is published.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ReleaseKind {
    /// The recipe contains the seed.
    Open,
    /// The recipe contains a commitment to the seed, which is revealed later.
    Sealed,
}

/// A file in a release.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Item {
    /// The relative path, as accepted by [`check_path`](crate::check_path).
    pub path: String,
    /// The size, in bytes.
    pub size: u64,
    /// The digest of the content.
    pub digest: Digest,
}

impl Item {
    /// Returns the item for a file with the given content. Cost: one pass over the content.
    pub fn of(path: impl Into<String>, content: &[u8]) -> Item {
        Item { path: path.into(), size: content.len() as u64, digest: Digest::of(content) }
    }
}
