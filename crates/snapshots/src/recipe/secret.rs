//! The secrets of sealed releases. A sealed release commits to its seed before minting, and reveals the seed later.

use crate::error::SnapshotError;
use crate::format::folder;
use crate::format::manifest::Manifest;
use crate::format::manifest::withheld::HeldPart;
use crate::format::witness::Witness;
use crate::recipe::beacon::{BEACON, BeaconPart};

use base::canonical::{CanonicalError, canonical_digest};
use base::{Digest, Seed, SeedPath};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeSet;
use std::io;
use std::path::Path;

/// A sealed release's secret: the source of its seed, to which the recipe commits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Secret {
    /// The name of the release for which the secret was drawn.
    pub name: String,
    /// The text from which the seed is derived: 64 hexadecimal digits.
    pub seed: String,
    /// The nonce, which prevents guessing the seed: 64 hexadecimal digits.
    pub nonce: Digest,
    /// The digest of the recipe for which the secret was drawn ([`Recipe::committed`](crate::Recipe::committed));
    /// `None` in secrets from generations before [`COMMITS_TO_RECIPE_SINCE`], whose commitments cover only the seed
    /// and the nonce.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recipe: Option<Digest>,
}

/// The first generation whose commitments cover the recipe, and whose seeds also depend on the nonce.
pub const COMMITS_TO_RECIPE_SINCE: u32 = 12;

/// The key derivation contexts. Changing a context changes every secret or every commitment.
const SEED_CONTEXT: &str = "infinite-arcade 2 seed of a secret";
const NONCE_CONTEXT: &str = "infinite-arcade 2 nonce of a secret";
const COMMITMENT_CONTEXT: &str = "infinite-arcade 2 commitment";
const SALT_CONTEXT: &str = "infinite-arcade 3 salt of withheld files";

/// The minimum number of distinct bytes in 32 random bytes, and the minimum number of distinct differences between
/// successive bytes. All but one in a billion drawn secrets reach both minimums. A sequence with a period of at most 16
/// bytes does not.
const DISTINCT: usize = 17;

impl Secret {
    /// Creates a recipe's secret from 64 random bytes. One half forms the seed, and the other half forms the nonce.
    pub fn draw(name: &str, recipe: Digest, chance: [u8; 64]) -> Secret {
        let (seed, nonce) = chance.split_at(32);
        // The bytes are hashed, so that the output has its full length even if the randomness is poor.
        let hashed = |context, half| Digest::from_bytes(blake3::derive_key(context, half));
        Secret {
            name: name.to_owned(),
            seed: hashed(SEED_CONTEXT, seed).to_string(),
            nonce: hashed(NONCE_CONTEXT, nonce),
            recipe: Some(recipe),
        }
    }

    /// Computes the domain-separated digest of the seed, the nonce and the recipe's digest. If the secret has no
    /// recipe, the digest is BLAKE3(seed ‖ nonce), as in releases before [`COMMITS_TO_RECIPE_SINCE`].
    pub fn commitment(&self) -> Digest {
        let Some(recipe) = self.recipe else {
            return Digest::of(&[self.seed.as_bytes(), self.nonce.as_bytes()].concat());
        };
        let mut hasher = blake3::Hasher::new_derive_key(COMMITMENT_CONTEXT);
        hasher.update(&(self.seed.len() as u64).to_le_bytes());
        hasher.update(self.seed.as_bytes());
        hasher.update(self.nonce.as_bytes());
        hasher.update(recipe.as_bytes());
        Digest::from_bytes(*hasher.finalize().as_bytes())
    }

    /// Derives the salt for the list of a withheld part. The salt reveals nothing about the secret or the other
    /// part's salt.
    pub(crate) fn salt(&self, part: HeldPart) -> Digest {
        let mut hasher = blake3::Hasher::new_derive_key(SALT_CONTEXT);
        for part in [self.seed.as_bytes(), self.nonce.as_bytes(), part.list().as_bytes()] {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part);
        }
        Digest::from_bytes(*hasher.finalize().as_bytes())
    }

    /// Returns the seed from which everything in the release is derived. The seed is a child of the secret's
    /// seed text and also depends on the nonce, so that guessing only one of the two is useless.
    pub fn root_seed(&self) -> Seed {
        Seed::from_text(&self.seed).child(&format!("nonce {}", self.nonce), 0)
    }

    /// Returns the seed of a release with the given recipe. If the recipe names a beacon, the beacon's value
    /// is mixed in. Returns `None` if the beacon has no value yet.
    pub(crate) fn seed_for(&self, recipe: &Value) -> Option<Seed> {
        match recipe.get(BEACON) {
            None => Some(self.root_seed()),
            Some(_) => BeaconPart::of(recipe)?.mix(self.root_seed()),
        }
    }

    /// Checks that the seed and the nonce look random rather than made up.
    ///
    /// # Errors
    /// Returns the first problem as a sentence.
    pub fn check(&self) -> Result<(), String> {
        let Ok(seed) = self.seed.parse::<Digest>() else {
            return Err("the `seed` is not 64 lower-case hexadecimal digits".to_owned());
        };
        if self.recipe.is_none() {
            return Err("the secret has no `recipe`, the digest of the recipe that the secret was drawn for"
                .to_owned());
        }
        if seed == self.nonce {
            return Err("the `seed` and the `nonce` are the same".to_owned());
        }
        for (key, bytes) in [("seed", seed.as_bytes()), ("nonce", self.nonce.as_bytes())] {
            let steps = bytes.windows(2).map(|pair| pair[1].wrapping_sub(pair[0]));
            let (values, steps): (BTreeSet<u8>, BTreeSet<u8>) =
                (bytes.iter().copied().collect(), steps.collect());
            if values.len() < DISTINCT || steps.len() < DISTINCT || bytes.is_ascii() {
                return Err(format!("the `{key}` has a pattern, so it was not drawn at random"));
            }
        }
        Ok(())
    }

    /// Returns a sentence about the problem with the secret, given the manifest of its release; `None` if the secret
    /// matches the commitment.
    ///
    /// # Errors
    /// Returns an error if the manifest's recipe cannot be written as canonical JSON.
    pub(crate) fn flaw(&self, manifest: &Manifest) -> Result<Option<String>, SnapshotError> {
        if Some(self.commitment()) != manifest.commitment {
            return Ok(Some("the seed and the nonce do not match the commitment".to_owned()));
        }
        let Some(recipe) = self.recipe else {
            let flaw = format!(
                "the secret does not specify a recipe, as required since generation {COMMITS_TO_RECIPE_SINCE}"
            );
            return Ok((manifest.generation >= COMMITS_TO_RECIPE_SINCE).then_some(flaw));
        };
        if recipe != committed(&manifest.recipe)? {
            return Ok(Some("the manifest's recipe does not match the commitment".to_owned()));
        }
        Ok(self.check().err())
    }

    /// Returns `true` if the witness's seed is derived from this secret and the recipe's beacon along the
    /// path stated in the witness. Secrets from an earlier generation always pass.
    pub(crate) fn leads_to(&self, witness: &Witness, recipe: &Value) -> bool {
        let seed = self.seed_for(recipe).map(|seed| SeedPath::new(seed, witness.path.clone()).seed());
        self.recipe.is_none() || seed == Some(witness.episode.seed)
    }
}

/// Returns the digest of the recipe without the parts that a commitment does not cover: `seed` (which the
/// commitment replaces), the commitment itself, `known` (which follows from the parent), and the beacon's
/// value.
///
/// # Errors
/// Returns an error if the recipe cannot be written as canonical JSON.
pub(crate) fn committed(recipe: &Value) -> Result<Digest, CanonicalError> {
    let mut recipe = recipe.clone();
    if let Some(keys) = recipe.as_object_mut() {
        keys.retain(|key, _| !["seed", "commitment", "known"].contains(&key.as_str()));
        keys.get_mut(BEACON).and_then(Value::as_object_mut).map(|beacon| beacon.remove("value"));
    }
    canonical_digest(&recipe)
}

/// The maximum size of a secret file, in bytes.
const SECRET_LIMIT: u64 = 4096;

/// Reads a secret written by `--commit`.
///
/// # Errors
/// Returns an error if the file cannot be read, does not contain a secret, or contains a secret that was made up
/// rather than drawn.
pub fn read_secret(file: &Path) -> Result<Secret, SnapshotError> {
    let bytes = match disk::read_start(file, SECRET_LIMIT + 1) {
        Err(source) if source.kind() == io::ErrorKind::InvalidInput => {
            let source = serde::de::Error::custom("it is not a file");
            return Err(SnapshotError::NotASecret { path: file.to_path_buf(), source });
        }
        read => read.map_err(SnapshotError::io("read", file))?,
    };
    let secret = parse(&bytes, file)?;
    match secret.check() {
        Ok(()) => Ok(secret),
        Err(what) => Err(SnapshotError::WeakSecret { path: file.to_path_buf(), what }),
    }
}

/// Reads the secret from the file `file` of the revealed release in the folder `root`.
///
/// # Errors
/// Returns an error if the file cannot be read or does not contain a secret.
pub(crate) fn read_revealed(root: &Path, file: &str) -> Result<Secret, SnapshotError> {
    parse(&folder::read(root, file, SECRET_LIMIT)?, &folder::join(root, file))
}

fn parse(bytes: &[u8], file: &Path) -> Result<Secret, SnapshotError> {
    let path = file.to_path_buf();
    if bytes.len() as u64 > SECRET_LIMIT {
        let source = serde::de::Error::custom(format_args!("the secret has more than {SECRET_LIMIT} bytes"));
        return Err(SnapshotError::NotASecret { path, source });
    }
    serde_json::from_slice(bytes).map_err(|source| SnapshotError::NotASecret { path, source })
}

/// The problem with a witness that was not played under the release's secret.
pub(crate) const UNRELATED_WITNESS: &str = "the seed is not derived from the release's secret";

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn drawn() -> Secret {
        Secret::draw("2027-01", Digest::of(b"recipe"), [7; 64])
    }

    #[test]
    fn only_random_secrets_are_accepted() {
        drawn().check().unwrap();
        let check = |change: &dyn Fn(&mut Secret), expect: &str| {
            let mut secret = drawn();
            change(&mut secret);
            let error = secret.check().unwrap_err();
            assert!(error.contains(expect), "{error}");
        };
        let hex = |bytes: [u8; 32]| Digest::from_bytes(bytes);
        let counted = hex(std::array::from_fn(|at| 131 + at as u8));
        let twice = hex(std::array::from_fn(|at| ((at % 16) as u8).wrapping_mul(97) ^ 201));
        let text = hex(*b"the quick brown fox jumps over a");
        check(&|secret| secret.seed = "hunter2".to_owned(), "not 64 lower-case");
        check(&|secret| secret.seed = secret.seed.to_uppercase(), "not 64 lower-case");
        check(&|secret| secret.seed = "0".repeat(64), "`seed` has a pattern");
        check(&|secret| secret.seed = "0123456789abcdef".repeat(4), "`seed` has a pattern");
        for made_up in [counted, twice, text] {
            check(&|secret| secret.seed = made_up.to_string(), "`seed` has a pattern");
            check(&|secret| secret.nonce = made_up, "`nonce` has a pattern");
        }
        check(&|secret| secret.nonce = secret.seed.parse().unwrap(), "are the same");
        check(&|secret| secret.recipe = None, "no `recipe`");
    }

    /// Every drawn secret is accepted.
    #[test]
    fn secrets_that_are_drawn_pass() {
        for number in 0..20_000_u32 {
            let mut chance = [0; 64];
            chance[..4].copy_from_slice(&number.to_le_bytes());
            chance[32..36].copy_from_slice(&number.to_le_bytes());
            Secret::draw("x", Digest::of(b""), chance).check().unwrap();
        }
    }

    #[test]
    fn the_commitment_covers_seed_nonce_and_recipe() {
        let secret = drawn();
        let other = Digest::of(b"other");
        for changed in [
            Secret { seed: other.to_string(), ..secret.clone() },
            Secret { nonce: other, ..secret.clone() },
            Secret { recipe: Some(other), ..secret.clone() },
            Secret { recipe: None, ..secret.clone() },
        ] {
            assert_ne!(changed.commitment(), secret.commitment(), "{changed:?}");
        }
        // The name is only a label.
        assert_eq!(Secret { name: "x".to_owned(), ..secret.clone() }.commitment(), secret.commitment());
    }

    /// Guessing the seed's text is useless without the nonce.
    #[test]
    fn games_come_from_the_nonce_too() {
        let secret = drawn();
        let other = Secret { nonce: Digest::of(b"other"), ..secret.clone() };
        assert_ne!(secret.root_seed(), other.root_seed());
        assert_ne!(secret.root_seed(), Seed::from_text(&secret.seed));
    }

    #[test]
    fn the_commitment_covers_the_recipe_without_derived_values() {
        let recipe = json!({ "name": "a", "parent": null, "corpus": { "games": 1 } });
        let digest = |change: &dyn Fn(&mut Value)| {
            let mut changed = recipe.clone();
            change(&mut changed);
            committed(&changed).unwrap()
        };
        let same = digest(&|_| {});
        for key in ["seed", "commitment", "known"] {
            assert_eq!(digest(&|recipe| recipe[key] = json!("x")), same, "{key}");
        }
        assert_ne!(digest(&|recipe| recipe["parent"] = json!("x")), same);
        assert_ne!(digest(&|recipe| recipe["corpus"]["games"] = json!(2)), same);
        assert_ne!(digest(&|recipe| recipe["corpus"]["known"] = json!(2)), same);
    }

    /// A witness's seed follows from its path under only one secret.
    #[test]
    fn witnesses_belong_to_one_secret() {
        let secret = drawn();
        let seed = secret.root_seed().child("search", 0).child("game", 3);
        let text = json!({
            "canary": "", "path": [["search", 0], ["game", 3]],
            "episode": {
                "game": Digest::of(b""), "level": Digest::of(b""), "seed": seed, "actions": [], "hashes": [],
                "outcome": "won", "score": 0.0,
            },
        });
        let witness: Witness = serde_json::from_value(text).unwrap();
        assert!(secret.leads_to(&witness, &json!({})));
        assert!(!Secret::draw("2027-01", Digest::of(b"recipe"), [8; 64]).leads_to(&witness, &json!({})));
        assert!(!secret.leads_to(&Witness { path: Vec::new(), ..witness.clone() }, &json!({})));
        // A beacon without a value yields no seed. A beacon with a value changes the seed.
        for part in [
            json!({ "source": "s", "round": 1 }),
            json!({ "source": "s", "round": 1, "value": Digest::of(b"") }),
        ] {
            assert!(!secret.leads_to(&witness, &json!({ "beacon": part })));
        }
    }
}
