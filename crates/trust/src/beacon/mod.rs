//! Public randomness. In each round, a source publishes a random value, which is stored as a file or as a log
//! entry.

mod drand;

pub use drand::{Chain, Metadata, check_source};

use crate::error::TrustError;
use crate::log::{Entry, Round};
use base::Digest;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// The maximum size of a beacon file, in bytes.
pub const MAX_BEACON: u64 = 1 << 14;

/// The expected file content, for messages.
const SHAPE: &str = "write the source's answer together with its name: \
                     { \"source\": \"drand quicknet\", \"round\": 7, \"randomness\": \"…\", \"signature\": \"…\" }";

/// A value from a randomness source, with the evidence for the value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// The source and the round number.
    pub round: Round,
    /// The 32-byte random value.
    pub value: Digest,
    /// The signature whose hash is the value. `None` for sources other than drand, whose rounds have no such signature.
    pub proof: Option<Proof>,
}

/// A round's signature, in the format published by the source.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Proof {
    /// The signature as hexadecimal digits.
    pub signature: String,
    /// The previous round's signature, which the signed message includes in chained networks; `None` in other networks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub previous_signature: Option<String>,
    /// The facts about the network, if this crate does not name the network.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<Chain>,
}

/// The content of a beacon file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object")]
struct DrawnFile {
    source: String,
    round: u64,
    /// The random value, called `randomness` by drand.
    #[serde(alias = "randomness")]
    value: Digest,
    signature: Option<String>,
    previous_signature: Option<String>,
    chain: Option<Chain>,
}

impl Drawn {
    /// Parses a beacon file and checks its value with [`Drawn::check`].
    ///
    /// # Errors
    /// Returns an error if the file is not a beacon file, or if its value does not belong to the round.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Drawn, TrustError> {
        let wrong = |fault: String| TrustError::document(place, fault);
        let file: DrawnFile = serde_json::from_slice(bytes)
            .map_err(|error| wrong(format!("isn't a beacon value: {error}; {SHAPE}")))?;
        let DrawnFile { source, round, value, signature, previous_signature, chain } = file;
        if signature.is_none() && (previous_signature.is_some() || chain.is_some()) {
            return Err(wrong(format!("has no `signature`, but has fields that accompany one; {SHAPE}")));
        }
        let proof = signature.map(|signature| Proof { signature, previous_signature, chain });
        let drawn = Drawn { round: Round { source, round }, value, proof };
        drawn.check().map_err(wrong)?;
        Ok(drawn)
    }

    /// Checks the value. A drand round must have its network's signature, and the value must be the SHA-256
    /// hash of the signature. For other sources, a signature is optional and not verified, but if present,
    /// its SHA-256 hash must be the value.
    ///
    /// # Errors
    /// Returns a message that describes the fault and the recommended next step.
    pub fn check(&self) -> Result<(), String> {
        let round = &self.round;
        let network = drand::named(&round.source)?;
        let Some(proof) = &self.proof else {
            return match network {
                None => Ok(()),
                Some(_) => Err(format!(
                    "has no `signature` of round {} of {}, which proves that the value comes from the \
                     network: use the network's complete answer, such as that of /public/{}",
                    round.round, round.source, round.round
                )),
            };
        };
        let signature = hex(&proof.signature).ok_or_else(|| not_hex("signature"))?;
        let value: [u8; 32] = Sha256::digest(&signature).into();
        if Digest::from_bytes(value) != self.value {
            return Err(
                "its `value` is not the SHA-256 of its `signature`: fetch both from the source again"
                    .to_owned(),
            );
        }
        match network {
            Some(network) => network.check(round, &signature, proof),
            None if proof.chain.is_some() || proof.previous_signature.is_some() => Err(format!(
                "has `chain` or `previous_signature`, which only drand networks have, but its source is `{}`",
                round.source
            )),
            None => Ok(()),
        }
    }

    /// Converts the value to a log entry.
    pub fn entry(self) -> Entry {
        let Drawn { round, value, proof } = self;
        Entry::Beacon { round, value, proof }
    }
}

fn not_hex(field: &str) -> String {
    format!("its `{field}` does not consist of lower-case hexadecimal digits: fetch it from the source again")
}

fn hex(text: &str) -> Option<Vec<u8>> {
    let digits = text.bytes().map(|byte| match byte {
        b'0'..=b'9' => Some(byte - b'0'),
        b'a'..=b'f' => Some(byte - b'a' + 10),
        _ => None,
    });
    let digits: Vec<u8> = digits.collect::<Option<_>>()?;
    digits.len().is_multiple_of(2).then(|| digits.chunks(2).map(|pair| 16 * pair[0] + pair[1]).collect())
}

#[cfg(test)]
mod tests;
