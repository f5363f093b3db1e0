//! BLS signatures on the curve BLS12-381.

use blst::{BLST_ERROR, min_pk, min_sig};

/// The domain separation tag for hashing to the group G1.
pub(super) const ON_G1: &[u8] = b"BLS_SIG_BLS12381G1_XMD:SHA-256_SSWU_RO_NUL_";
/// The domain separation tag for hashing to the group G2.
pub(super) const ON_G2: &[u8] = b"BLS_SIG_BLS12381G2_XMD:SHA-256_SSWU_RO_NUL_";

/// The size of a compressed point in the group G1, in bytes. Only the compressed form is accepted, because it
/// is unique. If other forms were accepted, one point could have several hashes, and thus several values.
const G1_BYTES: usize = 48;
/// The size of a compressed point in the group G2, in bytes.
const G2_BYTES: usize = 96;

/// Returns `true` if `signature` is a valid signature for the message under the key.
///
/// # Errors
/// Returns an error if the key is invalid for the scheme.
pub(super) fn signed(scheme: &str, key: &[u8], message: &[u8], signature: &[u8]) -> Result<bool, String> {
    let no_key = || format!("has a `public_key` that is not valid in the scheme {scheme}");
    let verdict = if scheme == "bls-unchained-g1-rfc9380" {
        if key.len() != G2_BYTES {
            return Err(no_key());
        }
        let key = min_sig::PublicKey::key_validate(key).map_err(|_| no_key())?;
        if signature.len() != G1_BYTES {
            return Ok(false);
        }
        let signature = min_sig::Signature::sig_validate(signature, true);
        signature.map(|signature| signature.verify(false, message, ON_G1, &[], &key, false))
    } else {
        if key.len() != G1_BYTES {
            return Err(no_key());
        }
        let key = min_pk::PublicKey::key_validate(key).map_err(|_| no_key())?;
        if signature.len() != G2_BYTES {
            return Ok(false);
        }
        let signature = min_pk::Signature::sig_validate(signature, true);
        signature.map(|signature| signature.verify(false, message, ON_G2, &[], &key, false))
    };
    Ok(verdict == Ok(BLST_ERROR::BLST_SUCCESS))
}
