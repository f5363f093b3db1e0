//! BLS signatures on the curve BLS12-381.

use blst::{BLST_ERROR, min_pk, min_sig};

/// The domains of the hashes to the curve.
pub(super) const ON_G1: &[u8] = b"BLS_SIG_BLS12381G1_XMD:SHA-256_SSWU_RO_NUL_";
pub(super) const ON_G2: &[u8] = b"BLS_SIG_BLS12381G2_XMD:SHA-256_SSWU_RO_NUL_";

/// The sizes of points in the compressed form, the only one in which a point has one encoding: another would have another
/// hash, and so another value.
const G1_BYTES: usize = 48;
const G2_BYTES: usize = 96;

/// Returns `true` if the signature is the key's on a message.
///
/// # Errors
/// The key is none of the scheme.
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
