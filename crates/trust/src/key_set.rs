//! Key sets. A set determines who may sign for a publisher, how many keys must sign, and which keys are
//! revoked.
//!
//! A set is stored in a file `keys-N.json` of canonical JSON. Each set contains the digest of the previous set, and
//! must be signed by enough keys from both sets. A reader who trusts one set can therefore verify all later sets.

use crate::error::TrustError;
use crate::key::PublicKey;
use base::Digest;
use base::canonical::to_canonical_json;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The maximum number of keys in a set, and the maximum number of revoked keys.
pub const MAX_KEYS: usize = 64;
/// The version of the key set format.
const FORMAT: u32 = 1;

/// A set of keys that may sign.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeySet {
    /// The format version, currently 1.
    pub format: u32,
    /// The set's number, starting at 1.
    pub version: u32,
    /// The minimum number of keys that must sign.
    pub threshold: u32,
    /// The keys that may sign.
    pub keys: Vec<NamedKey>,
    /// The revoked keys. Their signatures do not count.
    pub revoked: Vec<RevokedKey>,
    /// The digest of the previous set's file, or `None` for the first set.
    pub previous: Option<Digest>,
}

/// A key in a set, with the name of its holder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedKey {
    /// The name of the key's holder: lower-case letters, digits and `-`.
    pub name: String,
    /// The public key, in minisign's base64 format.
    pub key: String,
}

/// A revoked key.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RevokedKey {
    /// The name of the key's former holder.
    pub name: String,
    /// The public key, in minisign's base64 format.
    pub key: String,
    /// The reason for the revocation, such as `lost`.
    pub reason: String,
}

impl KeySet {
    /// Creates the set that follows `previous`, or the first set.
    ///
    /// # Errors
    /// Returns an error if the resulting set is invalid.
    pub fn next(
        previous: Option<&KeySet>,
        threshold: Option<u32>,
        add: Vec<NamedKey>,
        revoke: &[(String, String)],
    ) -> Result<KeySet, TrustError> {
        let (mut keys, mut revoked) =
            previous.map_or_else(Default::default, |set| (set.keys.clone(), set.revoked.clone()));
        for (name, reason) in revoke {
            let Some(at) = keys.iter().position(|key| key.name == *name) else {
                let names: Vec<&str> = keys.iter().map(|key| key.name.as_str()).collect();
                let names = names.join(", ");
                return Err(TrustError::Refused(format!(
                    "the set has no key `{name}`, so it cannot be revoked: the keys are {names}"
                )));
            };
            let NamedKey { name, key } = keys.remove(at);
            revoked.push(RevokedKey { name, key, reason: reason.clone() });
        }
        keys.extend(add);
        let threshold = threshold.or(previous.map(|set| set.threshold)).unwrap_or(1);
        let version = previous.map_or(1, |set| set.version.saturating_add(1));
        let previous = previous.map(KeySet::digest).transpose()?;
        let set = KeySet { format: FORMAT, version, threshold, keys, revoked, previous };
        set.check().map_err(TrustError::Refused)?;
        Ok(set)
    }

    /// Parses and checks a set's file.
    ///
    /// # Errors
    /// Returns an error if the file does not contain a key set, or if the set is invalid.
    pub fn parse(bytes: &[u8], place: &str) -> Result<KeySet, TrustError> {
        let set: KeySet = canonical(bytes, place)?;
        set.check().map_err(|fault| TrustError::document(place, fault))?;
        Ok(set)
    }

    /// Checks the set's values. Returns an error that describes the first fault.
    fn check(&self) -> Result<(), String> {
        if self.format != FORMAT {
            return Err(format!("has format {}; this version of arcade reads format {FORMAT}", self.format));
        }
        if self.version == 0 || (self.version == 1) != self.previous.is_none() {
            return Err("its `version` and `previous` contradict each other".to_owned());
        }
        if self.keys.len() > MAX_KEYS || self.revoked.len() > MAX_KEYS {
            return Err(format!("has more than {MAX_KEYS} keys"));
        }
        if self.threshold == 0 || self.threshold as usize > self.keys.len() {
            let count = self.keys.len();
            return Err(format!(
                "its threshold is {}, but it has {}: choose a threshold from 1 to {count}",
                self.threshold,
                base::count(count, "key")
            ));
        }
        let mut points = BTreeSet::new();
        let mut names = BTreeSet::new();
        for NamedKey { name, key } in &self.keys {
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            if name.is_empty() || name.len() > 40 || !name.chars().all(plain) {
                return Err(format!(
                    "the key name `{}` must consist of 1 to 40 lower-case letters, digits and `-`",
                    name.escape_debug()
                ));
            }
            if !names.insert(name) {
                return Err(format!("two keys have the name `{name}`"));
            }
            let point =
                PublicKey::parse(key).map_err(|error| format!("the key of `{name}` is {error}"))?.point();
            if !points.insert(point) {
                return Err(format!("the key of `{name}` occurs twice"));
            }
        }
        for RevokedKey { name, key, .. } in &self.revoked {
            let key =
                PublicKey::parse(key).map_err(|error| format!("the revoked key of `{name}` is {error}"))?;
            if !points.insert(key.point()) {
                return Err(format!("the revoked key of `{name}` occurs twice, or is still in force"));
            }
        }
        Ok(())
    }

    /// Returns the bytes of the set's file. Signatures cover these bytes.
    ///
    /// # Errors
    /// Never returns an error for a set parsed or created by this module.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TrustError> {
        let text = to_canonical_json(self).map_err(|error| TrustError::Refused(error.to_string()))?;
        Ok(text.into_bytes())
    }

    /// Returns the digest of the set's file.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`KeySet::to_bytes`].
    pub fn digest(&self) -> Result<Digest, TrustError> {
        Ok(Digest::of(&self.to_bytes()?))
    }

    /// Returns the name of the set's file.
    pub fn file(&self) -> String {
        format!("keys-{}.json", self.version)
    }

    /// Returns the names of this set's keys that have signed a message. Each key counts once. Also returns
    /// the faults in invalid signatures by keys from this set.
    pub fn signers(&self, message: &[u8], signatures: &[String]) -> Signers {
        let mut signers = Signers::default();
        for NamedKey { name, key } in &self.keys {
            let Ok(key) = PublicKey::parse(key) else { continue };
            let claimed = signatures.iter().filter(|text| crate::key::signer_of(text) == Some(key.id()));
            let results: Vec<Result<String, String>> =
                claimed.map(|signature| key.verify(message, signature)).collect();
            if results.iter().any(Result::is_ok) {
                signers.names.push(name.clone());
            } else if let Some(Err(fault)) = results.first() {
                signers.faults.push(format!("the signature of `{name}` is not valid: {fault}"));
            }
        }
        signers
    }

    /// Returns the revoked key that equals the given key, if any.
    fn revokes(&self, key: &NamedKey) -> Option<&RevokedKey> {
        self.revoked.iter().find(|revoked| revoked.key == key.key)
    }

    /// Returns this set without the keys revoked by a later set. Also returns the reason for each revocation.
    pub(crate) fn unrevoked(&self, later: &KeySet) -> (KeySet, Vec<String>) {
        let mut gone = Vec::new();
        let mut set = self.clone();
        set.keys.retain(|key| {
            let revoked = later.revokes(key);
            gone.extend(revoked.map(|r| format!("the key of `{}` is revoked: {}", r.name, r.reason)));
            revoked.is_none()
        });
        (set, gone)
    }

    /// Checks that the set `next` may follow this set. `signatures` contains the signatures for the file of
    /// `next`.
    ///
    /// # Errors
    /// Returns the reasons why `next` may not follow.
    pub fn admits(&self, next: &KeySet, signatures: &[String]) -> Result<(), Vec<String>> {
        let mut problems = Vec::new();
        let place = next.file();
        let (Ok(bytes), Ok(digest)) = (next.to_bytes(), self.digest()) else {
            return Err(vec![format!("{place}: not a set of keys")]);
        };
        if next.version != self.version.saturating_add(1) || next.previous != Some(digest) {
            problems
                .push(format!("{place}: the set does not follow {}, whose digest is {digest}", self.file()));
        }
        for RevokedKey { name, key, .. } in &self.revoked {
            if !next.revoked.iter().any(|revoked| revoked.key == *key) {
                problems.push(format!("{place}: the revoked key of `{name}` is no longer revoked"));
            }
        }
        for (set, of) in [(self, "the previous set"), (next, "its own set")] {
            let signers = set.signers(&bytes, signatures);
            if (signers.names.len() as u32) < set.threshold {
                problems.push(format!(
                    "{place}: signed by {} of {of}, but {} must sign{}",
                    signers.listed(),
                    set.threshold,
                    signers.excuse()
                ));
            }
        }
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }
}

/// The result of checking all signatures for a message.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Signers {
    /// The names of the keys with valid signatures.
    pub names: Vec<String>,
    /// The faults in the invalid signatures.
    pub faults: Vec<String>,
}

impl Signers {
    /// Joins the names of the signers for a message.
    pub(crate) fn listed(&self) -> String {
        if self.names.is_empty() { "none".to_owned() } else { self.names.join(", ") }
    }

    /// Formats the faults as the end of a message.
    pub(crate) fn excuse(&self) -> String {
        self.faults.iter().map(|fault| format!("; {fault}")).collect()
    }
}

/// Parses a document of canonical JSON.
pub(crate) fn canonical<T: Serialize + for<'a> Deserialize<'a>>(
    bytes: &[u8],
    place: &str,
) -> Result<T, TrustError> {
    let wrong = |fault: String| TrustError::document(place, fault);
    let value: T =
        serde_json::from_slice(bytes).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    let text = to_canonical_json(&value).map_err(|error| wrong(error.to_string()))?;
    match text.as_bytes() == bytes {
        true => Ok(value),
        false => Err(wrong("is not canonical JSON: it was changed after it was written".to_owned())),
    }
}
