//! Ed25519 keys and signatures in minisign files.

use crate::error::TrustError;
use minisign::{KeyPair, SecretKeyBox, SignatureBox};
use std::fmt;
use std::io::Cursor;

/// The maximum size of a key or signature file, in bytes.
pub const MAX_KEY_FILE: u64 = 4096;

/// A public key, which verifies signatures.
#[derive(Clone, PartialEq, Eq)]
pub struct PublicKey(minisign::PublicKey);

/// A decrypted secret key, which signs messages.
#[derive(Clone)]
pub struct SecretKey(minisign::SecretKey);

/// A new public key, and the content of its secret file.
pub struct NewKey {
    /// The new public key.
    pub public: PublicKey,
    /// The content of the secret key file.
    pub secret_file: String,
}

/// Generates a key. If a password is given, the secret file is encrypted.
///
/// # Errors
/// Returns an error if the system provides no random bytes, or if the password is too long.
pub fn generate(password: Option<&str>) -> Result<NewKey, TrustError> {
    let pair = match password {
        Some(password) => KeyPair::generate_encrypted_keypair(Some(password.to_owned())),
        None => KeyPair::generate_unencrypted_keypair(),
    };
    let failed = |error: minisign::PError| TrustError::Key(format!("the key could not be created: {error}"));
    let KeyPair { pk, sk } = pair.map_err(failed)?;
    let public = PublicKey(pk);
    let kind = if password.is_some() { "encrypted" } else { "unencrypted" };
    let comment = format!("minisign {kind} secret key {}", public.id());
    let secret_file = sk.to_box(Some(&comment)).map_err(failed)?.into_string();
    Ok(NewKey { public, secret_file })
}

impl PublicKey {
    /// Parses the content of a public key file, or just its base64 line.
    ///
    /// # Errors
    /// Returns an error if the text is not a minisign public key.
    pub fn parse(text: &str) -> Result<PublicKey, TrustError> {
        let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
        let line = match (lines.next(), lines.next(), lines.next()) {
            (Some(first), Some(second), None) if first.starts_with("untrusted comment:") => second,
            (Some(only), None, None) => only,
            _ => return Err(TrustError::Key(NOT_PUBLIC.to_owned())),
        };
        let key = minisign::PublicKey::from_base64(line);
        let key = key.map_err(|_| TrustError::Key(NOT_PUBLIC.to_owned()))?;
        let key = PublicKey(key);
        match key.to_base64() == line && ed25519_compact::PublicKey::new(key.point()).validate().is_ok() {
            true => Ok(key),
            false => Err(TrustError::Key(NOT_PUBLIC.to_owned())),
        }
    }

    /// Returns the key's identifier as 16 hexadecimal digits, in minisign's format.
    pub fn id(&self) -> String {
        id(self.0.keynum())
    }

    /// Returns the base64 line of the public key file.
    pub fn to_base64(&self) -> String {
        self.0.to_base64()
    }

    /// Returns the contents of the public key file.
    pub fn to_file(&self) -> String {
        format!("untrusted comment: minisign public key {}\n{}\n", self.id(), self.to_base64())
    }

    /// Verifies a message's minisign signature, and returns the signature's trusted comment.
    ///
    /// # Errors
    /// Returns a sentence that describes the fault.
    pub fn verify(&self, message: &[u8], signature: &str) -> Result<String, String> {
        let found = parse_signature(signature)?;
        minisign::verify(&self.0, &found, Cursor::new(message), true, false, false)
            .map_err(|error| error.to_string().to_lowercase())?;
        found.trusted_comment().map_err(|error| error.to_string())
    }

    /// Returns `true` if a message's bare Ed25519 signature is valid.
    pub fn verify_bare(&self, message: &[u8], signature: &[u8]) -> bool {
        let key = ed25519_compact::PublicKey::new(self.point());
        ed25519_compact::Signature::from_slice(signature).is_ok_and(|s| key.verify(message, &s).is_ok())
    }

    /// Returns the 32 bytes of the key's curve point.
    pub(crate) fn point(&self) -> [u8; 32] {
        let bytes = self.0.to_bytes();
        bytes[bytes.len() - 32..].try_into().expect("a public key ends with 32 bytes")
    }
}

impl fmt::Debug for PublicKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PublicKey({})", self.id())
    }
}

const NOT_PUBLIC: &str = "not a minisign public key: use the file `NAME.pub` that `arcade trust keygen` or \
                          `minisign -G` wrote";

/// Parses a signature. Accepts only one textual form of each signature.
fn parse_signature(text: &str) -> Result<SignatureBox, String> {
    if text.len() as u64 > MAX_KEY_FILE {
        return Err("it is not a minisign signature: the text is too long".to_owned());
    }
    // Different programs write different comments, but the same signature lines.
    let found = SignatureBox::from_string(text).map_err(|error| error.to_string().to_lowercase())?;
    match found.to_string().trim_end() == text.replace("\r\n", "\n").trim_end() {
        true => Ok(found),
        false => Err("it is not a minisign signature: the text is not exactly four lines".to_owned()),
    }
}

/// Returns the identifier of the key that a signature names, without verifying the signature; `None` if the text is not
/// a signature.
pub(crate) fn signer_of(signature: &str) -> Option<String> {
    parse_signature(signature).ok().map(|found| id(found.keynum()))
}

fn id(keynum: &[u8]) -> String {
    keynum.iter().rev().map(|byte| format!("{byte:02X}")).collect()
}

/// Returns `true` if a secret file's content is encrypted.
///
/// # Errors
/// Returns an error if the text is not the content of a secret key file.
pub fn is_encrypted(secret_file: &str) -> Result<bool, TrustError> {
    let bytes = secret_bytes(secret_file)?;
    Ok(bytes[2..4] == *b"Sc")
}

/// Decodes the bytes in a secret file: the algorithm, the key derivation, the checksum algorithm, the salt,
/// the limits, the identifier, the key and the checksum.
fn secret_bytes(secret_file: &str) -> Result<Vec<u8>, TrustError> {
    use base64::Engine;
    let line = secret_file.lines().nth(1).unwrap_or_default().trim();
    let bytes = base64::engine::general_purpose::STANDARD.decode(line).unwrap_or_default();
    match bytes.len() == SECRET_BYTES && bytes.starts_with(b"Ed") {
        true => Ok(bytes),
        false => Err(TrustError::Key(
            "not a minisign secret key: use the file `NAME.key` that `arcade trust keygen` or `minisign -G` \
             wrote"
                .to_owned(),
        )),
    }
}

const SECRET_BYTES: usize = 158;
/// The position of the key's 64 bytes within a secret file's bytes.
const SECRET_KEY_AT: usize = 62;

impl SecretKey {
    /// Decrypts a secret key from its file's content.
    ///
    /// # Errors
    /// Returns an error if the text is not the content of a secret key file, if the key is encrypted and no
    /// password is given, or if the password is wrong.
    pub fn open(secret_file: &str, password: Option<&str>) -> Result<SecretKey, TrustError> {
        let bytes = secret_bytes(secret_file)?;
        let failed = |error: minisign::PError| TrustError::Key(error.to_string().to_lowercase());
        let key = match (is_encrypted(secret_file)?, password) {
            // The file is not parsed as a `SecretKeyBox`, because that type requires a checksum, which the C
            // program omits from such files.
            (false, _) => minisign::SecretKey::from_bytes(&bytes).map_err(failed)?,
            (true, Some(password)) => SecretKeyBox::from_string(secret_file)
                .and_then(|found| found.into_secret_key(Some(password.to_owned())))
                .map_err(failed)?,
            (true, None) => return Err(TrustError::Key("the secret key requires a password".to_owned())),
        };
        let key = SecretKey(key);
        // The second half of the key is derived from the first half.
        let seed = ed25519_compact::Seed::from_slice(&key.bytes()[..32]).expect("32 bytes");
        let point = ed25519_compact::KeyPair::from_seed(seed).pk;
        match *point == key.bytes()[32..] {
            true => Ok(key),
            false => Err(TrustError::Key("the secret key is damaged: restore it from a backup".to_owned())),
        }
    }

    /// Returns the secret key's 64 bytes.
    fn bytes(&self) -> [u8; 64] {
        self.0.to_bytes()[SECRET_KEY_AT..SECRET_KEY_AT + 64].try_into().expect("64 bytes")
    }

    /// Returns the public key.
    pub fn public(&self) -> PublicKey {
        PublicKey(minisign::PublicKey::from_secret_key(&self.0).expect("the key was read"))
    }

    /// Signs a message, and returns the content of a `.minisig` file.
    ///
    /// # Errors
    /// Returns an error if the system provides no random bytes.
    pub fn sign(&self, message: &[u8], trusted_comment: &str) -> Result<String, TrustError> {
        let untrusted = format!("signature from minisign secret key {}", self.public().id());
        let signed =
            minisign::sign(None, &self.0, Cursor::new(message), Some(trusted_comment), Some(&untrusted));
        let failed = |error: minisign::PError| TrustError::Key(format!("nothing was signed: {error}"));
        Ok(signed.map_err(failed)?.into_string())
    }

    /// Signs a message, and returns the 64 bytes of a bare Ed25519 signature. The signature is deterministic.
    pub fn sign_bare(&self, message: &[u8]) -> [u8; 64] {
        let key = ed25519_compact::SecretKey::from_slice(&self.bytes()).expect("64 bytes");
        *key.sign(message, None)
    }
}

impl fmt::Debug for SecretKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SecretKey of {}", self.public().id())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The key and the signature are the example published by minisign's authors.
    #[test]
    fn files_of_minisign_are_read() {
        let public = "untrusted comment: minisign public key E7620F1842B4E81F\n\
                      RWQf6LRCGA9i53mlYecO4IzT51TGPpvWucNSCh1CBM0QTaLn73Y7GFO3\n";
        let key = PublicKey::parse(public).expect("a key");
        assert_eq!(key.id(), "E7620F1842B4E81F");
        assert_eq!(key.to_file(), public);
        let signature = "untrusted comment: signature from minisign secret key\n\
            RUQf6LRCGA9i559r3g7V1qNyJDApGip8MfqcadIgT9CuhV3EMhHoN1mGTkUidF/z7SrlQgXdy8ofjb7bNJJylDOocrCo8KLzZwo=\n\
            trusted comment: timestamp:1556193335\tfile:test\n\
            y/rUw2y8/hOUYjZU71eHp/Wo1KZ40fGy2VJEDl34XMJM+TX48Ss/17u3IvIfbVR1FkZZSNCisQbuQY+bHwhEBg==\n";
        assert_eq!(key.verify(b"test", signature).expect("signed"), "timestamp:1556193335\tfile:test");
        assert!(key.verify(b"Test", signature).is_err());
        assert!(key.verify(b"test", &format!("{signature}more\n")).is_err());
        assert!(key.verify(b"test", &signature.replace("file:test", "file:tesT")).is_err());
    }

    #[test]
    fn what_is_signed_is_verified() {
        let new = generate(None).expect("random bytes");
        assert!(!is_encrypted(&new.secret_file).expect("a secret key"));
        let secret = SecretKey::open(&new.secret_file, None).expect("a secret key");
        assert_eq!(secret.public(), new.public);
        assert_eq!(PublicKey::parse(&new.public.to_base64()).expect("a key"), new.public);
        let signature = secret.sign(b"message", "about it").expect("signed");
        assert_eq!(new.public.verify(b"message", &signature).expect("verified"), "about it");
        assert_eq!(signer_of(&signature), Some(new.public.id()));
        let other = generate(None).expect("random bytes").public;
        assert!(other.verify(b"message", &signature).is_err());
        let bare = secret.sign_bare(b"message");
        assert!(new.public.verify_bare(b"message", &bare) && !other.verify_bare(b"message", &bare));
        assert!(
            !new.public.verify_bare(b"Message", &bare) && !new.public.verify_bare(b"message", &bare[1..])
        );
    }

    #[test]
    fn encrypted_keys_take_their_password() {
        let new = generate(Some("correct horse")).expect("random bytes");
        assert!(is_encrypted(&new.secret_file).expect("a secret key"));
        assert!(SecretKey::open(&new.secret_file, None).is_err());
        let wrong = SecretKey::open(&new.secret_file, Some("battery")).expect_err("wrong").to_string();
        assert!(wrong.contains("wrong password"), "{wrong}");
        let secret = SecretKey::open(&new.secret_file, Some("correct horse")).expect("opened");
        assert!(new.public.verify_bare(b"x", &secret.sign_bare(b"x")));
        let signature = secret.sign(b"x", "").expect("signed");
        assert!(new.public.verify(b"x", &signature).is_ok());
    }

    /// The key was written unencrypted by the C program (`minisign -G -W`, 0.11). Its checksum is zero.
    #[test]
    fn unencrypted_keys_of_minisign_are_read() {
        let file = "untrusted comment: minisign secret key\nRWQAAEIyAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAADegafHvtXWV820KbUwav+ci2ohY43Mz7uULM5bq1z92Q0FRBjBj1v6IaKXeR3OHhv8j550W5XAb65Cyuvv7OQAYMrWLWMww8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA=\n";
        let secret = SecretKey::open(file, None).expect("a secret key");
        assert_eq!(secret.public().id(), "655DED7B7C1AE80D");
        let damaged = file.replacen("3Mz7uULM5b", "AMz7uULM5b", 1);
        let error = SecretKey::open(&damaged, None).expect_err("damaged").to_string();
        assert!(error.contains("is damaged"), "{error}");
    }

    #[test]
    fn other_files_are_no_keys() {
        for text in
            ["", "x", "untrusted comment: x\n", "RWQf6LRCGA9i53mlYecO4IzT51TGPpvWucNSCh1CBM0QTaLn73Y7GFO"]
        {
            assert!(PublicKey::parse(text).is_err(), "{text}");
            assert!(SecretKey::open(text, None).is_err(), "{text}");
        }
        let new = generate(None).expect("random bytes");
        assert!(PublicKey::parse(&new.secret_file).is_err());
        assert!(SecretKey::open(&new.public.to_file(), None).is_err());
    }
}
