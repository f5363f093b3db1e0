//! `witness/lvl<n>.json`, which contains an episode that proves a level winnable.

use base::SeedStep;
use engine::Episode;
use serde::{Deserialize, Serialize};

/// A witness file's content.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// The release's canary: an identifier that shows whether a text corpus contains the release.
    pub canary: String,
    /// The episode, which replays to a win.
    pub episode: Episode,
    /// The steps from the release's root seed to the episode's seed, with one
    /// [`Seed::child`](base::Seed::child) per step. In sealed releases, the steps make it possible to check a
    /// revealed secret without minting. In open releases, the list is empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<SeedStep>,
}
