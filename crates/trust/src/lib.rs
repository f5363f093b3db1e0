//! Establishes trust between parties that do not know each other, through signed roots, key sets, and append-only logs.
//!
//! A publisher signs a [`Statement`] about a release's root with keys in minisign files. A [`KeySet`] determines how
//! many keys must sign, and which keys are revoked. [`Signatures`] checks the documents in a folder, based on an
//! [`Anchor`]: a trusted key or key set that the reader obtained from elsewhere. A public [`log`] records commitments
//! and releases, in an order that nobody can change undetected.
//!
//! Nothing in this crate reads a clock. Every written file is either complete or absent (see [`disk::Disk`]).

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
