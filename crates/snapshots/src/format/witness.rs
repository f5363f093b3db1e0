//! `witness/lvl<n>.json`: an episode that proves that a level can be won.

use base::SeedStep;
use engine::Episode;
use serde::{Deserialize, Serialize};

/// The content of a witness file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// The release's canary.
    pub canary: String,
    /// The episode; it replays to a win.
    pub episode: Episode,
    /// The steps from the release's root seed to the episode's seed, one [`Seed::child`](base::Seed::child) each.
    /// Sealed releases have them, to allow checking a revealed secret without minting; in open ones the list is empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<SeedStep>,
}
