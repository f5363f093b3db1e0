//! `witness/lvl<n>.json`: the episode that shows a level winnable.

use engine::Episode;
use serde::{Deserialize, Serialize};

/// A witness file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// The release's mark.
    pub canary: String,
    /// The episode; it replays to a win.
    pub episode: Episode,
    /// How the episode's seed comes from the release's root seed, one [`Seed::child`](engine::Seed::child) after another: in
    /// sealed releases, so that a revealed secret can be checked without minting. Empty in open ones.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<Step>,
}

/// A step from a seed to a child: purpose and index.
pub type Step = (String, u64);
