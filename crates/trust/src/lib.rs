//! Trust between strangers: signed roots, sets of keys, and logs that nothing can be removed from.
//!
//! A publisher signs a [`Statement`] about the root of a release with keys whose files are those of minisign. A
//! [`KeySet`] says how many keys have to sign, and which no longer count. [`Signatures`] judges what a folder holds, from
//! an [`Anchor`] that its reader has from elsewhere. A [`log`] states in public what was committed to and released, in an
//! order that nobody can change unnoticed.
//!
//! Nothing here reads a clock. What is written is complete or absent: see [`disk::Disk`].

mod beacon;
mod error;
mod key;
mod key_set;
pub mod log;
mod signatures;
mod statement;

pub use beacon::{Chain, Drawn, MAX_BEACON, Metadata, Proof, check_source};
pub use error::TrustError;
pub use key::{MAX_KEY_FILE, NewKey, PublicKey, SecretKey, generate, is_encrypted};
pub use key_set::{KeySet, MAX_KEYS, NamedKey, RevokedKey, Signers};
pub use signatures::{Anchor, Signatures, Signed, read_bounded, sign_into};
pub use statement::{KeysInForce, Provenance, Statement};
