//! Coin tosses for memory tests. Minting creates pairs of equivalent items. Only a player who knows the published
//! member of a pair can tell the two apart. A coin toss selects the member to publish, and the release commits to the
//! other member ([the tests](../../../../../docs/how-to/memory.md)).
//!
//! A pair consists of two renamings of a game (siblings) or two wins of a level. The result of its coin toss is
//! derived from the release's secret and the smaller of the members' digests, so it does not depend on the members'
//! order of creation or their positions. The withheld member is stored in [`HELD`] until the release is revealed.

mod pairs;
pub(crate) mod part;
mod section;
mod toss;
mod verify;

pub(crate) use pairs::SecretGame;
pub use part::MemoryPart;
pub(crate) use section::MemorySection;

use base::canonical::canonical_digest;
use base::{Digest, Seed, SeedStep};
use engine::Episode;
use serde::{Deserialize, Serialize};

/// The number of initial actions by which two wins are distinguished. A player that knows a published win begins with
/// the same actions.
pub const PREFIX: usize = 10;

/// A game's sibling: a copy with the same rules and levels under different names, which is withheld.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sibling {
    /// The sibling's title.
    pub title: String,
    /// The rules, preceded by the title.
    pub text: String,
    /// The levels, in the game's order.
    pub levels: Vec<String>,
}

/// A level's second win.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondWin {
    /// The winning episode.
    pub episode: Episode,
    /// The steps from the release's root seed to the episode's seed.
    pub path: Vec<SeedStep>,
}

/// Returns `true` if the coin toss for a pair selects `one` for publication. `what` names the kind of pair.
fn publishes(root: Seed, what: &str, one: Digest, other: Digest) -> bool {
    let first = one.min(other);
    let is_first = root.child(&format!("coin of {what} {first}"), 0).sampler().ratio(1, 2);
    is_first == (one == first)
}

/// Returns `true` if the coin toss between two siblings selects the first sibling for publication. The siblings are
/// identified by the digests of their rules.
pub(crate) fn publishes_sibling(root: Seed, one: Digest, other: Digest) -> bool {
    publishes(root, "siblings", one, other)
}

/// Returns `true` if the coin toss between a level's two wins selects the first win for publication.
pub(crate) fn publishes_win(root: Seed, one: &Episode, other: &Episode) -> bool {
    let digest = |episode| canonical_digest(episode).expect("an episode contains only finite numbers");
    publishes(root, "wins", digest(one), digest(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;
    use crate::recipe::tests::{GOOD, check};

    #[test]
    fn coins_are_needed_and_sealed() {
        check(&format!("{GOOD}[memory]\n"), "needs a sealed release");
        check(&format!("{GOOD}[memory]\nsiblings = false\nwitnesses = false"), "requests neither");
        check(&format!("{GOOD}[memory]\nsibling = true"), "unknown field `sibling`");
        let part = Recipe::to_commit(&format!("{GOOD}[memory]\nsiblings = false")).unwrap().memory;
        assert_eq!(part, Some(MemoryPart { siblings: false, witnesses: true }));
        // Recipes that request no pairs are serialised as before.
        assert!(serde_json::to_value(Recipe::from_toml(GOOD).unwrap()).unwrap().get("memory").is_none());
    }

    /// A coin toss selects the same member of a pair in either order. Over many pairs, each member is selected half
    /// of the time.
    #[test]
    fn coins_are_fair_and_do_not_depend_on_the_order() {
        let of = |text: &str| Digest::of(text.as_bytes());
        let mut published = 0;
        for number in 0..1000 {
            let (one, other) = (of(&format!("a{number}")), of(&format!("b{number}")));
            let seed = Seed::from_text("coins");
            let is_one = publishes_sibling(seed, one, other);
            assert_ne!(is_one, publishes_sibling(seed, other, one));
            published += u32::from(is_one);
        }
        // The bounds allow a fair coin four standard deviations.
        assert!((437..=563).contains(&published), "{published}");
    }
}
