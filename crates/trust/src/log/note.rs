//! Signed notes and checkpoints, in the formats of C2SP `signed-note`, `tlog-checkpoint` and `tlog-cosignature`.

use super::tree::Hash;
use crate::error::TrustError;
use crate::key::{PublicKey, SecretKey};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest as _, Sha256};

/// The signature type for bare Ed25519 note signatures.
const ED25519: u8 = 1;
/// The signature type for timestamped cosignatures.
const COSIGNATURE: u8 = 4;
/// The maximum size of a checkpoint, in bytes.
pub const MAX_CHECKPOINT: u64 = 1 << 16;

/// A log's signed statement about its size and its root.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checkpoint {
    /// The log's name.
    pub origin: String,
    /// The number of entries in the log at this checkpoint.
    pub size: u64,
    /// The root of the Merkle tree over the entries.
    pub root: Hash,
    /// The signatures, in file order.
    signatures: Vec<Signature>,
}

/// A signature line in a signed note.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Signature {
    name: String,
    /// The four bytes that identify the signer ([`key_hash`]), followed by the signature.
    bytes: Vec<u8>,
}

/// Checks the name of a log or a witness, which must not contain whitespace or `+`.
///
/// # Errors
/// Returns an error that states the requirements for names.
pub fn check_name(name: &str) -> Result<(), TrustError> {
    let is_bad = |c: char| c.is_whitespace() || c == '+' || c.is_control();
    match name.is_empty() || name.len() > 200 || name.chars().any(is_bad) {
        true => Err(TrustError::Refused(format!(
            "`{}` isn't a valid name for a log or a witness: use a name such as example.org/arcade, without \
             spaces or `+`",
            name.escape_debug()
        ))),
        false => Ok(()),
    }
}

/// Returns the four bytes with which a signature line starts. They are the start of a hash of the signer's name, the
/// signature type and the key.
fn key_hash(name: &str, kind: u8, key: &PublicKey) -> [u8; 4] {
    let hash =
        Sha256::new().chain_update(name).chain_update([b'\n', kind]).chain_update(key.point()).finalize();
    [hash[0], hash[1], hash[2], hash[3]]
}

/// Returns the key of a log or a witness in the format accepted by other tools: `NAME+HASH+KEY`.
pub fn verifier_key(name: &str, key: &PublicKey, is_witness: bool) -> String {
    let kind = if is_witness { COSIGNATURE } else { ED25519 };
    let hash: String = key_hash(name, kind, key).iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{name}+{hash}+{}", STANDARD.encode([&[kind][..], &key.point()].concat()))
}

impl Checkpoint {
    /// Creates a checkpoint signed by the log.
    pub fn sign(origin: &str, size: u64, root: Hash, secret: &SecretKey) -> Checkpoint {
        let mut checkpoint = Checkpoint { origin: origin.to_owned(), size, root, signatures: Vec::new() };
        let signature = secret.sign_bare(checkpoint.body().as_bytes());
        let hash = key_hash(origin, ED25519, &secret.public());
        let bytes = [&hash[..], &signature].concat();
        checkpoint.signatures.push(Signature { name: origin.to_owned(), bytes });
        checkpoint
    }

    /// Adds a witness's signature, which also covers a time, in seconds since 1970.
    pub fn cosign(&mut self, witness: &str, seconds: u64, secret: &SecretKey) {
        let signature = secret.sign_bare(self.cosigned(seconds).as_bytes());
        let hash = key_hash(witness, COSIGNATURE, &secret.public());
        let bytes = [&hash[..], &seconds.to_be_bytes(), &signature].concat();
        self.signatures.retain(|found| !(found.name == witness && found.bytes.starts_with(&hash)));
        self.signatures.push(Signature { name: witness.to_owned(), bytes });
    }

    /// Returns the text covered by the log's signature.
    fn body(&self) -> String {
        format!("{}\n{}\n{}\n", self.origin, self.size, STANDARD.encode(self.root))
    }

    fn cosigned(&self, seconds: u64) -> String {
        format!("cosignature/v1\ntime {seconds}\n{}", self.body())
    }

    /// Returns the content of the checkpoint file.
    pub fn to_text(&self) -> String {
        let line = |s: &Signature| format!("\u{2014} {} {}\n", s.name, STANDARD.encode(&s.bytes));
        format!("{}\n{}", self.body(), self.signatures.iter().map(line).collect::<String>())
    }

    /// Parses a checkpoint without checking its signatures.
    ///
    /// # Errors
    /// Returns an error if the text is not a checkpoint.
    pub fn parse(text: &str, place: &str) -> Result<Checkpoint, TrustError> {
        Checkpoint::read(text).filter(|found| found.to_text() == text).ok_or_else(|| {
            TrustError::document(
                place,
                "is not the checkpoint of a log: pass a log's `checkpoint` file, or a copy",
            )
        })
    }

    fn read(text: &str) -> Option<Checkpoint> {
        let (body, signatures) = text.split_once("\n\n")?;
        let mut lines = body.lines();
        let (origin, size, root) = (lines.next()?, lines.next()?, lines.next()?);
        let signature = |line: &str| {
            let (name, bytes) = line.strip_prefix("\u{2014} ")?.split_once(' ')?;
            check_name(name).ok()?;
            Some(Signature { name: name.to_owned(), bytes: STANDARD.decode(bytes).ok()? })
        };
        let found = Checkpoint {
            origin: origin.to_owned(),
            size: size.parse().ok()?,
            root: STANDARD.decode(root).ok()?.try_into().ok()?,
            signatures: signatures.lines().map(signature).collect::<Option<_>>()?,
        };
        (lines.next().is_none() && check_name(origin).is_ok()).then_some(found)
    }

    /// Checks that the checkpoint is signed by the log.
    ///
    /// # Errors
    /// Returns a sentence that describes the fault.
    pub fn check(&self, key: &PublicKey) -> Result<(), String> {
        let hash = key_hash(&self.origin, ED25519, key);
        let body = self.body();
        let holds = |s: &Signature| {
            s.name == self.origin
                && s.bytes.starts_with(&hash)
                && key.verify_bare(body.as_bytes(), &s.bytes[4..])
        };
        match self.signatures.iter().any(holds) {
            true => Ok(()),
            false => {
                Err(format!("the checkpoint of {} entries is not signed by the key {}", self.size, key.id()))
            }
        }
    }

    /// Returns the time at which a witness signed the checkpoint, in seconds since 1970. Returns `None` if
    /// the witness has not signed.
    pub fn witnessed(&self, witness: &str, key: &PublicKey) -> Option<u64> {
        let hash = key_hash(witness, COSIGNATURE, key);
        let time = |s: &Signature| {
            let rest =
                s.bytes.strip_prefix(&hash[..]).filter(|rest| s.name == witness && rest.len() == 72)?;
            let (seconds, signature) = rest.split_at(8);
            let seconds = u64::from_be_bytes(seconds.try_into().ok()?);
            key.verify_bare(self.cosigned(seconds).as_bytes(), signature).then_some(seconds)
        };
        self.signatures.iter().find_map(time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::key::generate;

    #[test]
    fn checkpoints_are_signed_and_witnessed() {
        let [log, witness] = [(), ()].map(|()| generate(None).expect("random bytes"));
        let secret =
            |key: &crate::key::NewKey| SecretKey::open(&key.secret_file, None).expect("a secret key");
        let mut checkpoint = Checkpoint::sign("example.org/arcade", 3, [7; 32], &secret(&log));
        assert_eq!(checkpoint.check(&log.public), Ok(()));
        assert!(checkpoint.check(&witness.public).is_err());
        assert_eq!(checkpoint.witnessed("w.example", &witness.public), None);
        checkpoint.cosign("w.example", 1_800_000_000, &secret(&witness));
        checkpoint.cosign("w.example", 1_800_000_001, &secret(&witness));
        assert_eq!(checkpoint.witnessed("w.example", &witness.public), Some(1_800_000_001));
        assert_eq!(checkpoint.witnessed("v.example", &witness.public), None);
        let text = checkpoint.to_text();
        assert_eq!(text.lines().count(), 6);
        assert!(text.starts_with("example.org/arcade\n3\nBwcH"), "{text}");
        let read = Checkpoint::parse(&text, "x").expect("what was written");
        assert_eq!(read, checkpoint);
        for (old, new) in
            [("\n3\n", "\n4\n"), ("\n3\n", "\n03\n"), ("arcade\n3", "arcada\n3"), ("BwcH", "BwcI")]
        {
            let altered = Checkpoint::parse(&text.replacen(old, new, 1), "x");
            assert!(
                altered.is_err() || altered.is_ok_and(|found| found.check(&log.public).is_err()),
                "{new}"
            );
        }
        assert!(check_name("a b").is_err() && check_name("a+b").is_err() && check_name("").is_err());
        assert!(verifier_key("w.example", &witness.public, true).starts_with("w.example+"));
    }
}
