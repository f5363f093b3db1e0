//! `witness/lvl<n>.json`: an episode that proves that a level can be won.

use base::Seed;
use engine::Episode;
use forge::games::Step;
use itertools::Itertools;
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
    pub path: Vec<Step>,
}

/// The seed that is derived from another one along a path.
pub(crate) fn descendant(seed: Seed, path: &[Step]) -> Seed {
    path.iter().fold(seed, |seed, (purpose, index)| seed.child(purpose, *index))
}

/// Upper bounds for the rounds and players of the search for a win ([`agents::solve`]).
const ROUNDS: u64 = 20;
const PLAYERS: u64 = 64;

/// The steps from the seed of a search for a win to that of the episode that it found; `None` if it is of another origin.
pub(crate) fn way_of_search(search: Seed, episode: Seed) -> Option<Vec<Step>> {
    let to = |steps: &[(&str, u64)]| -> Vec<Step> {
        steps.iter().map(|&(purpose, index)| (purpose.to_owned(), index)).collect()
    };
    let played = (0..ROUNDS).cartesian_product(0..PLAYERS);
    let played = played.map(|(round, player)| to(&[("round", round), ("play", player), ("chance", 0)]));
    std::iter::once(to(&[("systematic", 0)])).chain(played).find(|way| descendant(search, way) == episode)
}
