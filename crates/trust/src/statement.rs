//! The statement that a publisher signs about a release: its name and root, the keys in force, and what made it.

use crate::error::TrustError;
use crate::key_set::canonical;
use base::Digest;
use base::canonical::to_canonical_json;
use serde::{Deserialize, Serialize};

/// The version of the format of statements.
const FORMAT: u32 = 1;

/// A signed statement about a release.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    /// The version of this format: 1.
    pub format: u32,
    /// The name of the release.
    pub release: String,
    /// The root of the release.
    pub root: Digest,
    /// The set of keys in force; `None` if a single key signs.
    pub keys: Option<KeysInForce>,
    /// The software that made the release.
    pub provenance: Provenance,
}

/// A reference to a set of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeysInForce {
    /// The number of the set.
    pub version: u32,
    /// The digest of its file.
    pub digest: Digest,
}

/// The software that made a release.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The version, such as `0.13.0`, as the manifest states it.
    pub version: Option<String>,
    /// The generation of the generators.
    pub generation: u32,
    /// The semantics of the engine.
    pub semantics: u32,
    /// The digest of `Cargo.lock`.
    pub lockfile: Digest,
    /// The commit of the sources, as the publisher states it.
    pub commit: Option<String>,
}

impl Statement {
    /// A statement about a release.
    pub fn new(
        release: String,
        root: Digest,
        keys: Option<KeysInForce>,
        provenance: Provenance,
    ) -> Statement {
        Statement { format: FORMAT, release, root, keys, provenance }
    }

    /// Reads the file of a statement.
    ///
    /// # Errors
    /// It is no statement.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Statement, TrustError> {
        let statement: Statement = canonical(bytes, place)?;
        match statement.format {
            FORMAT => Ok(statement),
            other => {
                Err(TrustError::document(place, format!("is of format {other}; this arcade reads {FORMAT}")))
            }
        }
    }

    /// The bytes of the file, which are what is signed.
    ///
    /// # Errors
    /// Never: it is plain data.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TrustError> {
        let text = to_canonical_json(self).map_err(|error| TrustError::Refused(error.to_string()))?;
        Ok(text.into_bytes())
    }

    /// The name of the file, which contains a digest: another statement is another file, so that a signature is
    /// never beside a statement that it does not belong to.
    ///
    /// # Errors
    /// As for [`Statement::to_bytes`].
    pub fn file(&self) -> Result<String, TrustError> {
        Ok(format!("root-{}.json", &Digest::of(&self.to_bytes()?).to_string()[..16]))
    }

    /// The comment that its signatures carry, for people.
    pub fn comment(&self) -> String {
        format!("release {} root {}", self.release, self.root)
    }
}
