//! The `[memory]` section of a recipe.

use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::recipe::error::{RecipeError, wrong};
use base::Digest;
use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// The random choices for memory tests that a recipe requests.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct MemoryPart {
        /// `true` to request a second renaming of each game.
        pub siblings: bool = true,
        /// `true` to request a second win of each level.
        pub witnesses: bool = true,
    }
}

impl MemoryPart {
    /// Checks the section's values.
    ///
    /// # Errors
    /// Returns an error if neither kind of random choice is requested, or if the release has no commitment.
    pub(crate) fn check(&self, commitment: Option<Digest>) -> Result<(), RecipeError> {
        if !(self.siblings || self.witnesses) {
            return wrong("memory", "requests neither `siblings` nor `witnesses`: remove the section");
        }
        match commitment {
            Some(_) => Ok(()),
            None => wrong(
                "memory",
                "needs a sealed release, because a public `seed` determines the coin tosses: commit to a secret \
                 with `arcade release RECIPE --commit`, or remove the section",
            ),
        }
    }

    /// Returns the section in a release's recipe; `None` if it is missing, or has a different version's layout.
    pub fn of(manifest: &Manifest) -> Option<MemoryPart> {
        let part = manifest.recipe.get("memory").filter(|part| !part.is_null())?;
        serde_json::from_value(part.clone()).ok()
    }
}

/// Returns `true` if one win per level, selected at random, can be revealed before a release's other withheld files.
pub(crate) fn has_second_wins(manifest: &Manifest) -> bool {
    manifest.kind == ReleaseKind::Sealed && MemoryPart::of(manifest).is_some_and(|part| part.witnesses)
}
