//! drand networks. In each round, at least a threshold number of a network's members sign jointly, with a BLS
//! signature on the curve BLS12-381.
//!
//! A network's chain hash covers its public key. This module names two networks. Any other network is
//! identified by its chain hash, so that a commitment to the source fixes the key.

#[cfg(feature = "drand")]
mod bls;

use super::{Proof, hex, not_hex};
use crate::log::Round;
use base::Digest;
#[cfg(feature = "drand")]
use bls::signed;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// The facts about a network that its chain hash covers, and its signature scheme. The fields have the format
/// in which the network serves them under `/info`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// The public key as hexadecimal digits.
    pub public_key: String,
    /// The number of seconds between rounds.
    pub period: u32,
    /// The time of round 1, in seconds since 1970.
    pub genesis_time: i64,
    /// The network's chain hash.
    pub hash: Digest,
    /// The digest of the network's initial member group.
    #[serde(rename = "groupHash")]
    pub group_hash: Digest,
    /// The network's signature scheme.
    #[serde(rename = "schemeID")]
    pub scheme: String,
    /// The metadata with the network's name, which distinguishes it from other networks with the same
    /// members.
    pub metadata: Metadata,
}

/// The metadata in a [`Chain`], which contains the network's name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Metadata {
    /// The network's name, such as `quicknet`.
    #[serde(rename = "beaconID")]
    pub beacon_id: String,
}

impl Chain {
    /// Computes the chain hash from the other fields. Returns `None` if the key does not consist of
    /// hexadecimal digits.
    pub fn computed_hash(&self) -> Option<Digest> {
        let mut hasher = Sha256::new()
            .chain_update(self.period.to_be_bytes())
            .chain_update(self.genesis_time.to_be_bytes())
            .chain_update(hex(&self.public_key)?)
            .chain_update(self.group_hash.as_bytes());
        // The first networks had no names.
        if self.metadata.beacon_id != "default" {
            hasher.update(self.metadata.beacon_id.as_bytes());
        }
        let hash: [u8; 32] = hasher.finalize().into();
        Some(Digest::from_bytes(hash))
    }
}

/// A network whose key is included in the source code.
pub(super) struct Known {
    name: &'static str,
    hash: &'static str,
    public_key: &'static str,
    scheme: &'static str,
}

/// The networks that this module names: all networks that the League of Entropy currently runs.
const KNOWN: [Known; 2] = [
    Known {
        name: "drand quicknet",
        hash: "52db9ba70e0cc0f6eaf7803dd07447a1f5477735fd3f661792ba94600c84e971",
        public_key: "83cf0f2896adee7eb8b5f01fcad3912212c437e0073e911fb90022d3e760183c8c4b450b6a0a6c3ac6a5776a2d106451\
                     0d1fec758c921cc22b0e17e63aaf4bcb5ed66304de9cf809bd274ca73bab4af5a6e9c76a4bc09e76eae8991ef5ece45a",
        scheme: "bls-unchained-g1-rfc9380",
    },
    Known {
        name: "drand default",
        hash: "8990e7a9aaed2ffed73dbd7092123d6f289930540d7651336225dc172e51b2ce",
        public_key: "868f005eb8e6e4ca0a47c8a77ceaa5309a47978a7c71bc5cce96366b5d7a569937c529eeda66c7293784a9402801af31",
        scheme: "pedersen-bls-chained",
    },
];

/// The network that a source refers to.
pub(super) enum Network {
    /// A network in [`KNOWN`].
    Known(&'static Known),
    /// A network given by its chain hash. The beacon file must contain the network's key.
    Hash(Digest),
}

/// Returns the network that a source refers to, or `None` if the source is not a drand network.
///
/// # Errors
/// Returns an error with the accepted names if the source mentions drand but is not the name of a network.
pub(super) fn named(source: &str) -> Result<Option<Network>, String> {
    if !source.to_lowercase().contains("drand") {
        return Ok(None);
    }
    if let Some(known) = KNOWN.iter().find(|known| known.name == source) {
        return Ok(Some(Network::Known(known)));
    }
    let hash = source.strip_prefix("drand ").and_then(|hash| hash.parse().ok());
    if let Some(known) = KNOWN.iter().find(|known| source.strip_prefix("drand ") == Some(known.hash)) {
        // Each network has only one accepted name, so that the same round cannot be awaited under two names.
        return Err(format!("`{source}` is the network `{}`: write that name instead", known.name));
    }
    hash.map(|hash| Some(Network::Hash(hash))).ok_or_else(|| {
        format!(
            "`{source}` isn't a drand network: write `drand quicknet`, `drand default`, or `drand` and \
             the chain hash of a different network (64 hexadecimal digits)"
        )
    })
}

/// Checks a source name in a recipe. Returns `true` if the source is a drand network. A name that mentions
/// drand must refer to a drand network, as required by [`Drawn::check`](super::Drawn::check).
///
/// # Errors
/// Returns an error with the names to use instead.
pub fn check_source(source: &str) -> Result<bool, String> {
    named(source).map(|network| network.is_some())
}

impl Network {
    /// Checks a round's signature.
    pub(super) fn check(&self, round: &Round, signature: &[u8], proof: &Proof) -> Result<(), String> {
        let (key, scheme) = match (self, &proof.chain) {
            (Network::Known(_), Some(_)) => {
                return Err(format!(
                    "has a `chain`, but the key of {} is already known: remove `chain`",
                    round.source
                ));
            }
            (Network::Known(known), None) => (known.public_key, known.scheme),
            (Network::Hash(_), None) => {
                return Err(format!(
                    "has no `chain`, but the key of {} is unknown: add the network's answer to /info",
                    round.source
                ));
            }
            (Network::Hash(hash), Some(chain)) => {
                if chain.computed_hash() != Some(*hash) || chain.hash != *hash {
                    return Err(format!(
                        "its `chain` does not belong to {}, because the hash differs: fetch it from the \
                         network's /info again",
                        round.source
                    ));
                }
                if let Some(known) = KNOWN.iter().find(|known| known.public_key == chain.public_key) {
                    // A different genesis time gives a different hash, but the signed rounds depend only on
                    // the key.
                    return Err(format!(
                        "its `chain` has the key of `{}`: specify that network as the source",
                        known.name
                    ));
                }
                (chain.public_key.as_str(), chain.scheme.as_str())
            }
        };
        let key = hex(key).ok_or_else(|| not_hex("public_key"))?;
        let previous = match &proof.previous_signature {
            Some(text) => Some(hex(text).ok_or_else(|| not_hex("previous_signature"))?),
            None => None,
        };
        match verifies(scheme, &key, round.round, previous.as_deref(), signature)? {
            true => Ok(()),
            false => Err(format!(
                "its `signature` does not belong to round {} of {}: fetch the round from the network again",
                round.round, round.source
            )),
        }
    }
}

/// Returns `true` if a round's signature is valid.
///
/// # Errors
/// Returns an error if the signature cannot be checked, because the scheme is unknown, the previous signature
/// is missing or superfluous, or the key is invalid.
fn verifies(
    scheme: &str,
    key: &[u8],
    round: u64,
    previous: Option<&[u8]>,
    signature: &[u8],
) -> Result<bool, String> {
    let number = round.to_be_bytes();
    let message = match (scheme, previous) {
        ("pedersen-bls-chained", Some(previous)) => Sha256::new().chain_update(previous).chain_update(number),
        ("pedersen-bls-chained", None) => {
            return Err("has no `previous_signature`, which a chained network signs in each round".to_owned());
        }
        ("pedersen-bls-unchained" | "bls-unchained-g1-rfc9380", None) => Sha256::new().chain_update(number),
        ("pedersen-bls-unchained" | "bls-unchained-g1-rfc9380", Some(_)) => {
            return Err(
                "has a `previous_signature`, but its network is not chained: remove `previous_signature`"
                    .to_owned(),
            );
        }
        _ => {
            return Err(format!(
                "has the scheme {scheme}, which is not supported: use a network with the scheme \
                 pedersen-bls-chained, pedersen-bls-unchained or bls-unchained-g1-rfc9380"
            ));
        }
    };
    signed(scheme, key, &message.finalize(), signature)
}

#[cfg(not(feature = "drand"))]
fn signed(_: &str, _: &[u8], _: &[u8], _: &[u8]) -> Result<bool, String> {
    Err("has a BLS signature, and this program was built without the `drand` feature".to_owned())
}

#[cfg(all(test, feature = "drand"))]
mod tests;
