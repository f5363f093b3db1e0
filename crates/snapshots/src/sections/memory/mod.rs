//! Coins for tests of memory: of two things that a player without knowledge of what was published cannot tell apart, a coin
//! publishes one and the release commits to the other ([the tests](../../../../../docs/memory.md)).
//!
//! The two things are renamings of a game (siblings), or wins of a level. The coin of a pair is drawn from the release's secret
//! and the smaller of the two digests, so it depends neither on which of the two was made first nor on where it stands. What it
//! withholds lies in [`HELD`] until the release is revealed.

mod check;
mod toss;

pub(crate) use check::{Levels, SecretGame, pair_flaw, shape_problem};
pub(crate) use toss::{differ, toss};

use crate::format::manifest::{Manifest, ReleaseKind};
use crate::recipe::sealed::HELD;
use crate::recipe::{RecipeError, wrong};
use base::canonical::canonical_digest;
use base::{Digest, Seed};
use engine::Episode;
use forge::games::Step;
use serde::{Deserialize, Serialize};

/// The number of actions by which wins are told apart: players that know a published win begin like it.
pub const PREFIX: usize = 10;

base::with_defaults! {
    /// The coins that a recipe asks for.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct MemoryPart {
        /// `true` for a second renaming of each game.
        pub siblings: bool = true,
        /// `true` for a second win of each level.
        pub witnesses: bool = true,
    }
}

impl MemoryPart {
    /// Checks the values.
    ///
    /// # Errors
    /// It asks for nothing, or the release has no commitment.
    pub(crate) fn check(&self, commitment: Option<Digest>) -> Result<(), RecipeError> {
        if !(self.siblings || self.witnesses) {
            return wrong("memory", "asks for neither `siblings` nor `witnesses`: leave it out");
        }
        match commitment {
            Some(_) => Ok(()),
            None => wrong(
                "memory",
                "needs a sealed release, because everybody knows the coins of a public `seed`: commit to a secret with \
                 `arcade release RECIPE --commit`, or leave it out",
            ),
        }
    }

    /// The part of a release's recipe; `None` if it has none, or if it is of another version.
    pub fn of(manifest: &Manifest) -> Option<MemoryPart> {
        let part = manifest.recipe.get("memory").filter(|part| !part.is_null())?;
        serde_json::from_value(part.clone()).ok()
    }
}

/// A sibling of a game: the same rules and levels under other names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sibling {
    /// The title.
    pub title: String,
    /// The rules, headed by the title.
    pub text: String,
    /// The levels, in the order of the game.
    pub levels: Vec<String>,
}

/// A second win of a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondWin {
    /// The episode.
    pub episode: Episode,
    /// The steps from the release's root seed to its seed.
    pub path: Vec<Step>,
}

/// Tests whether the coin of a pair publishes `one` of it. `what` names the kind of the pair.
fn publishes(root: Seed, what: &str, one: Digest, other: Digest) -> bool {
    let first = one.min(other);
    let is_first = root.child(&format!("coin of {what} {first}"), 0).sampler().ratio(1, 2);
    is_first == (one == first)
}

/// Tests whether the coin of two siblings, given by the digests of their rules, publishes the first.
pub(crate) fn publishes_sibling(root: Seed, one: Digest, other: Digest) -> bool {
    publishes(root, "siblings", one, other)
}

/// Tests whether the coin of two wins of a level publishes the first.
pub(crate) fn publishes_win(root: Seed, one: &Episode, other: &Episode) -> bool {
    let digest = |episode| canonical_digest(episode).expect("an episode has no numbers that JSON lacks");
    publishes(root, "wins", digest(one), digest(other))
}

/// The folder of withheld siblings.
pub(crate) const SIBLINGS: &str = "held/siblings/";

/// The path of a file of a game's withheld sibling; `game` is the game's folder in `games`.
pub(crate) fn sibling_path(game: &str, file: &str) -> String {
    format!("{SIBLINGS}{game}/{file}")
}

/// The path of the withheld win of a level.
pub(crate) fn second_path(game: &str, level: usize) -> String {
    format!("{HELD}seconds/{game}/lvl{level}.json")
}

/// Tests whether a withheld file is a win that a coin published: it can be revealed before the rest.
pub(crate) fn is_solution(path: &str) -> bool {
    path.strip_prefix(HELD).is_some_and(|file| file.split('/').count() == 2)
}

/// Tests whether the wins that coins published can be revealed before the rest of a release.
pub(crate) fn has_second_wins(manifest: &Manifest) -> bool {
    manifest.kind == ReleaseKind::Sealed && MemoryPart::of(manifest).is_some_and(|part| part.witnesses)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;
    use crate::recipe::tests::{GOOD, check};

    #[test]
    fn coins_are_needed_and_sealed() {
        check(&format!("{GOOD}[memory]\n"), "needs a sealed release");
        check(&format!("{GOOD}[memory]\nsiblings = false\nwitnesses = false"), "asks for neither");
        check(&format!("{GOOD}[memory]\nsibling = true"), "unknown field `sibling`");
        let part = Recipe::to_commit(&format!("{GOOD}[memory]\nsiblings = false")).unwrap().memory;
        assert_eq!(part, Some(MemoryPart { siblings: false, witnesses: true }));
        // Recipes that ask for none keep their bytes.
        assert!(serde_json::to_value(Recipe::from_toml(GOOD).unwrap()).unwrap().get("memory").is_none());
    }

    /// The coin publishes one of the two, whichever is asked about, and each half of the time.
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
        // Four standard deviations of a fair coin.
        assert!((437..=563).contains(&published), "{published}");
    }

    #[test]
    fn solutions_are_told_from_what_stays_withheld() {
        assert!(is_solution("held/mole-845b9ea3/lvl0.json"));
        for other in ["held/secret.json", "held/MARKS.json", "games/mole-845b9ea3/lvl0.txt"] {
            assert!(!is_solution(other), "{other}");
        }
        assert!(!is_solution(&second_path("mole-845b9ea3", 0)));
        assert!(!is_solution(&sibling_path("mole-845b9ea3", "game.vgdl")));
    }
}
