//! Public randomness: a value that a source publishes in a round, as a file.

use crate::error::TrustError;
use crate::log::Round;
use engine::Digest;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// The greatest size of such a file, in bytes.
pub const MAX_BEACON: u64 = 1 << 14;

/// A value of a source of randomness, as its file states it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drawn {
    /// The source, such as `drand quicknet`.
    pub source: String,
    /// The number of the round.
    pub round: u64,
    /// The 32 bytes, as 64 hexadecimal digits; drand calls them `randomness`.
    #[serde(alias = "randomness")]
    pub value: Digest,
    /// The signature of the round, in hexadecimal digits, whose SHA-256 is the value of a drand round.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signature: Option<String>,
}

impl Drawn {
    /// Reads a file. If there is a signature, its SHA-256 has to be the value; that the signature is the one of the
    /// source is not checked.
    ///
    /// # Errors
    /// It is none, or value and signature contradict each other.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Drawn, TrustError> {
        let drawn: Drawn =
            serde_json::from_slice(bytes).map_err(|error| TrustError::document(place, error.to_string()))?;
        if let Some(signature) = &drawn.signature {
            let bytes = hex(signature).ok_or_else(|| {
                TrustError::document(place, "its `signature` is not hexadecimal digits in lower case")
            })?;
            let value: [u8; 32] = Sha256::digest(bytes).into();
            if Digest::from_bytes(value) != drawn.value {
                return Err(TrustError::document(
                    place,
                    "its `value` is not the SHA-256 of its `signature`: take both from the source again",
                ));
            }
        }
        Ok(drawn)
    }

    /// The source and the round.
    pub fn of(&self) -> Round {
        Round { source: self.source.clone(), round: self.round }
    }
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
mod tests {
    use super::*;

    #[test]
    fn the_value_of_drand_is_the_hash_of_the_signature() {
        let value = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        let check = |text: &str, expect: Option<&str>| match (Drawn::parse(text.as_bytes(), "x"), expect) {
            (Ok(drawn), None) => assert_eq!(drawn.of(), Round { source: "s".to_owned(), round: 7 }),
            (Err(error), Some(words)) => assert!(error.to_string().contains(words), "{error}"),
            (found, expect) => panic!("{found:?}, and not {expect:?}"),
        };
        let file = |rest: &str| format!("{{ \"source\": \"s\", \"round\": 7, {rest} }}");
        check(&file(&format!("\"value\": \"{value}\"")), None);
        check(&file(&format!("\"randomness\": \"{value}\", \"signature\": \"\"")), None);
        check(&file(&format!("\"value\": \"{value}\", \"signature\": \"00\"")), Some("is not the SHA-256"));
        check(&file(&format!("\"value\": \"{value}\", \"signature\": \"0g\"")), Some("not hexadecimal"));
        check(&file("\"value\": \"7\""), Some("64 hexadecimal"));
    }
}
