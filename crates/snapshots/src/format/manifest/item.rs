//! The files of a release and its kind.

use base::Digest;
use serde::{Deserialize, Serialize};

/// The kind of a release, by the publication of its seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ReleaseKind {
    /// The seed is in the recipe.
    Open,
    /// The recipe holds a commitment to the seed, which is revealed later.
    Sealed,
}

/// A file of a release.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Item {
    /// The relative path, as [`check_path`](crate::check_path) allows.
    pub path: String,
    /// The size in bytes.
    pub size: u64,
    /// The digest of the content.
    pub digest: Digest,
}

impl Item {
    /// The item of a file with this content. Cost: one pass over it.
    pub fn of(path: impl Into<String>, content: &[u8]) -> Item {
        Item { path: path.into(), size: content.len() as u64, digest: Digest::of(content) }
    }
}
