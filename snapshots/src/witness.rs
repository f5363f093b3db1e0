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
}
