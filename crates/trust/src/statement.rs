//! Publishers' signed statements about releases. A statement contains the release's name and root, the keys
//! in force, and the software that minted the release.

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
    /// The format version, currently 1.
    pub format: u32,
    /// The release's name.
    pub release: String,
    /// The release's root.
    pub root: Digest,
    /// The key set in force, or `None` if the publisher signs with a single key.
    pub keys: Option<KeysInForce>,
    /// The software that minted the release.
    pub provenance: Provenance,
}

/// A reference to the key set in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeysInForce {
    /// The set's number.
    pub version: u32,
    /// The digest of the set's file.
    pub digest: Digest,
}

/// The software that minted a release.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The version of arcade recorded in the release's manifest, such as `0.13.0`; `None` if the manifest records none.
    pub version: Option<String>,
    /// The version of the generators (their generation).
    pub generation: u32,
    /// The version of the engine's semantics.
    pub semantics: u32,
    /// The digest of `Cargo.lock`.
    pub lockfile: Digest,
    /// The source code commit, as stated by the publisher; `None` if the publisher states none.
    pub commit: Option<String>,
}

impl Statement {
    /// Creates a statement about a release.
    pub fn new(
        release: String,
        root: Digest,
        keys: Option<KeysInForce>,
        provenance: Provenance,
    ) -> Statement {
        Statement { format: FORMAT, release, root, keys, provenance }
    }

    /// Parses a statement's file.
    ///
    /// # Errors
    /// Returns an error if the bytes are not a valid statement.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Statement, TrustError> {
        let statement: Statement = canonical(bytes, place)?;
        match statement.format {
            FORMAT => Ok(statement),
            other => Err(TrustError::document(
                place,
                format!("has format {other}; this version of arcade reads format {FORMAT}"),
            )),
        }
    }

    /// Returns the bytes of the statement's file. Signatures cover these bytes.
    ///
    /// # Errors
    /// Never returns an error, because a statement is plain data.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TrustError> {
        let text = to_canonical_json(self).map_err(|error| TrustError::Refused(error.to_string()))?;
        Ok(text.into_bytes())
    }

    /// Returns the name of the statement's file, which includes the statement's digest. Distinct statements
    /// therefore have distinct files, and a signature cannot be mistaken for another statement's.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`Statement::to_bytes`].
    pub fn file(&self) -> Result<String, TrustError> {
        Ok(format!("root-{}.json", &Digest::of(&self.to_bytes()?).to_string()[..16]))
    }

    /// Returns the human-readable comment in the statement's signatures.
    pub fn comment(&self) -> String {
        format!("release {} root {}", self.release, self.root)
    }
}
