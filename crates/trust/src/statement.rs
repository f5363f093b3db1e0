//! The statement that a publisher signs about a release: its name and root, the keys in force, and the software that
//! made it.

use crate::error::TrustError;
use crate::key_set::canonical;
use base::Digest;
use base::canonical::to_canonical_json;
use serde::{Deserialize, Serialize};

/// The version of the statement format.
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
    /// The digest of the set's file.
    pub digest: Digest,
}

/// The software that made a release.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The version of arcade that the manifest states, such as `0.13.0`.
    pub version: Option<String>,
    /// The generation of the generators.
    pub generation: u32,
    /// The semantics of the engine.
    pub semantics: u32,
    /// The digest of `Cargo.lock`.
    pub lockfile: Digest,
    /// The commit of the sources, according to the publisher.
    pub commit: Option<String>,
}

impl Statement {
    /// Makes a statement about a release.
    pub fn new(
        release: String,
        root: Digest,
        keys: Option<KeysInForce>,
        provenance: Provenance,
    ) -> Statement {
        Statement { format: FORMAT, release, root, keys, provenance }
    }

    /// Parses the file of a statement.
    ///
    /// # Errors
    /// Returns an error if the bytes are not a statement.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Statement, TrustError> {
        let statement: Statement = canonical(bytes, place)?;
        match statement.format {
            FORMAT => Ok(statement),
            other => {
                Err(TrustError::document(place, format!("has format {other}; this arcade reads {FORMAT}")))
            }
        }
    }

    /// Returns the bytes of the file, which are the signed bytes.
    ///
    /// # Errors
    /// Never fails, because a statement is plain data.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TrustError> {
        let text = to_canonical_json(self).map_err(|error| TrustError::Refused(error.to_string()))?;
        Ok(text.into_bytes())
    }

    /// Returns the name of the file, which contains a digest. Different statements therefore have different files,
    /// and a signature is never beside a statement that it does not belong to.
    ///
    /// # Errors
    /// See [`Statement::to_bytes`].
    pub fn file(&self) -> Result<String, TrustError> {
        Ok(format!("root-{}.json", &Digest::of(&self.to_bytes()?).to_string()[..16]))
    }

    /// Returns the comment in the statement's signatures, for human readers.
    pub fn comment(&self) -> String {
        format!("release {} root {}", self.release, self.root)
    }
}
