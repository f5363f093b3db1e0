//! Log proofs, which are stored in files. A proof shows that an entry is in the log, or that a log extends
//! its earlier state.

use super::note::Checkpoint;
use super::tree::{self, Hash};
use crate::error::TrustError;
use crate::key::PublicKey;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// The first line of an inclusion proof, as specified in C2SP `tlog-proof`.
const INCLUSION: &str = "c2sp.org/tlog-proof@v1";
/// The first line of a consistency proof.
const CONSISTENCY: &str = "infinite-arcade/log-growth@v1";
/// The maximum number of hashes in a proof.
const MAX_HASHES: usize = 64;

/// A proof that an entry is in a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inclusion {
    /// The number of the entry.
    pub index: u64,
    /// The proof's hashes, from the entry's sibling upwards.
    pub hashes: Vec<Hash>,
    /// The checkpoint with the root to which the hashes lead.
    pub checkpoint: Checkpoint,
}

/// A proof that a log has grown from an earlier size without changing its earlier entries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Consistency {
    /// The log's earlier size.
    pub old: u64,
    /// The proof's hashes.
    pub hashes: Vec<Hash>,
    /// The log's later checkpoint.
    pub checkpoint: Checkpoint,
}

impl Inclusion {
    /// Returns the content of the proof file.
    pub fn to_text(&self) -> String {
        write(INCLUSION, "index", self.index, &self.hashes, &self.checkpoint)
    }

    /// Parses an inclusion proof.
    ///
    /// # Errors
    /// Returns an error if the text is not an inclusion proof.
    pub fn parse(text: &str, place: &str) -> Result<Inclusion, TrustError> {
        let (index, hashes, checkpoint) = read(INCLUSION, "index", text, place)?;
        let proof = Inclusion { index, hashes, checkpoint };
        same(proof.to_text() == text, proof, place)
    }

    /// Checks that the proof is valid for an entry, and that the log has signed the checkpoint.
    ///
    /// # Errors
    /// Returns the reasons why the proof is invalid.
    pub fn check(&self, entry: &[u8], key: &PublicKey) -> Result<(), Vec<String>> {
        let mut problems: Vec<String> = self.checkpoint.check(key).err().into_iter().collect();
        let leaf = tree::leaf(entry);
        if !tree::includes(&leaf, self.index, self.checkpoint.size, &self.hashes, &self.checkpoint.root) {
            problems.push(format!("the entry is not entry {} of the log at this checkpoint", self.index));
        }
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }
}

impl Consistency {
    /// Returns the content of the proof file.
    pub fn to_text(&self) -> String {
        write(CONSISTENCY, "old", self.old, &self.hashes, &self.checkpoint)
    }

    /// Parses a consistency proof.
    ///
    /// # Errors
    /// Returns an error if the text is not a consistency proof.
    pub fn parse(text: &str, place: &str) -> Result<Consistency, TrustError> {
        let (old, hashes, checkpoint) = read(CONSISTENCY, "old", text, place)?;
        let proof = Consistency { old, hashes, checkpoint };
        same(proof.to_text() == text, proof, place)
    }

    /// Checks that the proof is valid for an earlier checkpoint, and that the log has signed both
    /// checkpoints.
    ///
    /// # Errors
    /// Returns the reasons why the proof is invalid.
    pub fn check(&self, seen: &Checkpoint, key: &PublicKey) -> Result<(), Vec<String>> {
        let mut problems: Vec<String> =
            [seen, &self.checkpoint].iter().filter_map(|c| c.check(key).err()).collect();
        let new = &self.checkpoint;
        if seen.origin != new.origin || seen.size != self.old {
            problems.push(format!(
                "the proof covers the first {} entries of `{}`, not the {} entries of `{}`",
                self.old, new.origin, seen.size, seen.origin
            ));
        } else if !tree::extends(seen.size, new.size, &seen.root, &new.root, &self.hashes) {
            problems.push(format!(
                "the log has forked: the log of {} entries does not extend the log of {} entries",
                new.size, seen.size
            ));
        }
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }
}

fn same<T>(is_same: bool, proof: T, place: &str) -> Result<T, TrustError> {
    if is_same { Ok(proof) } else { Err(not_a_proof(place)) }
}

fn not_a_proof(place: &str) -> TrustError {
    TrustError::document(place, "is not a proof: pass the file that `arcade trust log prove --out` wrote")
}

fn write(kind: &str, key: &str, number: u64, hashes: &[Hash], checkpoint: &Checkpoint) -> String {
    let lines: String = hashes.iter().map(|hash| format!("{}\n", STANDARD.encode(hash))).collect();
    format!("{kind}\n{key} {number}\n{lines}\n{}", checkpoint.to_text())
}

fn read(kind: &str, key: &str, text: &str, place: &str) -> Result<(u64, Vec<Hash>, Checkpoint), TrustError> {
    let parse = || {
        let (head, checkpoint) = text.split_once("\n\n")?;
        let mut lines = head.lines();
        let is_kind = lines.next()? == kind;
        let number = lines.next()?.strip_prefix(key)?.strip_prefix(' ')?.parse().ok()?;
        let hash = |line: &str| STANDARD.decode(line).ok()?.try_into().ok();
        let hashes = lines.take(MAX_HASHES + 1).map(hash).collect::<Option<Vec<Hash>>>()?;
        (is_kind && hashes.len() <= MAX_HASHES).then_some((number, hashes, checkpoint))
    };
    let (number, hashes, checkpoint) = parse().ok_or_else(|| not_a_proof(place))?;
    Ok((number, hashes, Checkpoint::parse(checkpoint, place)?))
}
