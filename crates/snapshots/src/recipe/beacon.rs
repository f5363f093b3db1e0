//! Public randomness in the seed of a sealed release, which prevents the publisher from choosing among secrets.

use crate::recipe::error::{RecipeError, wrong};
use base::{Digest, Seed};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The key of the beacon table in a recipe.
pub(crate) const BEACON: &str = "beacon";

/// A round of a public source of randomness. The recipe states the round before anybody knows its value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeaconPart {
    /// The source, such as `drand quicknet`.
    pub source: String,
    /// The number of the round.
    pub round: u64,
    /// The value of the round, which is filled in when the release is minted. The commitment does not cover the
    /// value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Digest>,
}

impl BeaconPart {
    /// Mixes the beacon's value into a secret's seed; `None` if the value is not yet known.
    pub(crate) fn mix(&self, seed: Seed) -> Option<Seed> {
        let value = self.value?;
        Some(seed.child(&format!("beacon {} {value}", self.source), self.round))
    }

    /// Reads the beacon in a manifest's recipe; `None` if the recipe states no beacon, or one with an unknown
    /// layout.
    pub(crate) fn of(recipe: &Value) -> Option<BeaconPart> {
        recipe.get(BEACON).and_then(|part| serde_json::from_value(part.clone()).ok())
    }

    /// Checks the beacon in a hand-written recipe. The release must be sealed, and the recipe must not state the
    /// value.
    pub(crate) fn check(&self, is_sealed: bool) -> Result<(), RecipeError> {
        if !is_sealed {
            return wrong(BEACON, "applies only to sealed releases: the seed of this release is public");
        }
        if self.source.trim().is_empty()
            || self.source.len() > 80
            || self.source.chars().any(char::is_control)
        {
            return wrong("beacon.source", "takes a string of 1 to 80 bytes, such as \"drand quicknet\"");
        }
        match self.value {
            Some(_) => wrong(
                "beacon.value",
                "is filled in by `arcade release --beacon FILE`: remove the value from the recipe",
            ),
            None => Ok(()),
        }
    }

    /// Sets the round's value.
    ///
    /// # Errors
    /// Returns an error if the value belongs to a different source or round.
    pub fn take(&mut self, source: &str, round: u64, value: Digest) -> Result<(), RecipeError> {
        if (self.source.as_str(), self.round) != (source, round) {
            let message = format!(
                "specifies round {} of {}, but the given value is from round {round} of {source}",
                self.round, self.source
            );
            return wrong(BEACON, message);
        }
        self.value = Some(value);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;
    use crate::recipe::secret::Secret;
    use crate::recipe::tests::{GOOD, check};

    const BEACON_TABLE: &str = "[beacon]\nsource = 'drand quicknet'\nround = 7\n";

    #[test]
    fn recipes_name_a_round_whose_value_is_not_known() {
        let sealed = GOOD.replace("seed = 'x'", &format!("commitment = '{}'", Digest::of(b"")));
        assert!(Recipe::from_toml(&format!("{sealed}{BEACON_TABLE}")).is_ok());
        assert!(Recipe::to_commit(&format!("{GOOD}{BEACON_TABLE}")).is_ok());
        check(&format!("{GOOD}{BEACON_TABLE}"), "`beacon` applies only to sealed releases");
        check(
            &format!("{sealed}{}", BEACON_TABLE.replace("drand quicknet", " ")),
            "`beacon.source` takes a string",
        );
        check(&format!("{sealed}{BEACON_TABLE}value = '{}'", Digest::of(b"")), "remove the value");
    }

    /// The commitment covers the round but not its value. The seed depends on both the round and its value.
    #[test]
    fn the_seed_depends_on_the_value_and_the_commitment_does_not() {
        let recipe = Recipe::to_commit(&format!("{GOOD}{BEACON_TABLE}")).unwrap();
        let secret = Secret::draw("small", recipe.committed(), [7; 64]);
        let minting = Recipe { commitment: Some(secret.commitment()), ..recipe };
        assert!(matches!(minting.root_seed(Some(&secret)), Err(RecipeError::NoBeacon { round: 7, .. })));
        let with = |value: &[u8]| {
            let mut recipe = minting.clone();
            recipe.beacon.as_mut().unwrap().take("drand quicknet", 7, Digest::of(value)).unwrap();
            recipe
        };
        let [one, two] = [b"1", b"2"].map(|value| with(value));
        assert_eq!(one.committed(), minting.committed());
        let seeds = [&one, &two].map(|recipe| recipe.root_seed(Some(&secret)).unwrap());
        assert_ne!(seeds[0], seeds[1]);
        assert_ne!(seeds[0], secret.root_seed());
        assert_eq!(secret.seed_for(&serde_json::to_value(&one).unwrap()), Some(seeds[0]));
        // A different round makes a different recipe.
        let mut later = one.clone();
        later.beacon.as_mut().unwrap().round = 8;
        assert!(matches!(later.root_seed(Some(&secret)), Err(RecipeError::OtherRecipe(_))));
        let taken = later.beacon.as_mut().unwrap().take("drand quicknet", 7, Digest::of(b"1"));
        assert!(taken.unwrap_err().to_string().contains("specifies round 8"));
    }
}
