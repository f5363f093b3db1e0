//! Releases: minted from a recipe, frozen into a folder, read without trusting them, and reproduced from their seed.
//!
//! A release folder contains files and one `MANIFEST.json`. The [`Manifest`] lists every file with its size
//! and [`Digest`], and states the root of a [`merkle`] tree over the files. A single file can therefore be
//! proved without the rest, and each release can state the root of its predecessor. A [`Draft`] writes a
//! folder that is either complete or absent. [`check_integrity`] reads a folder and reports all [`Problem`]s
//! together. [`archive`] packs a release into one file, [`proof`] proves one of its files or games, and
//! [`chain`] follows the roots from release to release.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let home = tempfile::tempdir()?;
//! # let out = home.path().join("example");
//! # use base as infinite_arcade_base;
//! use infinite_arcade_base::Digest;
//! use infinite_arcade_snapshots::{Draft, Item, ReleaseKind, MANIFEST_FILE, Manifest, canary, check_integrity};
//!
//! let text: &[u8] = b"BasicGame\n";
//! let recipe = serde_json::json!({ "name": "example", "seed": 7 });
//! let mut manifest = Manifest {
//!     format: infinite_arcade_snapshots::FORMAT,
//!     name: "example".into(),
//!     kind: ReleaseKind::Open,
//!     semantics: 1,
//!     generation: 1,
//!     version: Some("0.1.0".into()),
//!     parent: None,
//!     canary: canary(&Digest::of(recipe.to_string().as_bytes())),
//!     commitment: None,
//!     lockfile: Digest::of(b"the bytes of Cargo.lock"),
//!     recipe,
//!     items: vec![Item::of("games/maze/game.vgdl", text)],
//!     withheld: None,
//!     root: Digest::of(b""), // this and the next are replaced by `seal_root`
//!     checksum: Digest::of(b""),
//! };
//! manifest.seal_root()?;
//!
//! let draft = Draft::create(&out)?;
//! draft.write("games/maze/game.vgdl", text)?;
//! draft.write(MANIFEST_FILE, &manifest.to_bytes()?)?;
//! draft.commit()?;
//!
//! assert!(check_integrity(&out)?.is_sound());
//! # Ok(())
//! # }
//! ```

mod card;
mod check;
mod contents;
pub mod diff;
mod draft;
mod error;
pub mod export;
mod format;
pub mod lineage;
pub mod mint;
mod publish;
mod recipe;
pub mod released;
mod sections;
pub mod twin;

pub use card::{Bin, Novelty, ReleaseCard, Rung, rungs};
pub use check::{Bounds, Verification, Witnesses, verify, verify_within};
pub use contents::disclose::withhold;
pub use contents::integrity::{Integrity, check_integrity};
pub use contents::untracked::{PAPERS, PAPERS_LIMITS, Untracked};
pub use contents::{archive, integrity_of, proof};
pub use draft::{Abandoned, Draft, check_vacant};
pub use error::SnapshotError;
pub use format::canary::canary;
pub use format::layout::{HELD, RELEASE_CARD_FILE, SECRET_FILE};
pub use format::manifest::item::{Item, ReleaseKind};
pub use format::manifest::withheld::{Reveal, Withheld};
pub use format::manifest::{FORMAT, HEADER_LEAF, MANIFEST_FILE, MANIFEST_LIMIT, Manifest, SEALED_FORMAT};
pub use format::path::{MAX_COMPONENTS, MAX_PATH, PathProblem, check_path};
pub use format::problem::{Flaw, Problem};
pub use format::witness::Witness;
pub use format::{folder, merkle, version};
pub use lineage::ancestry::{AncestryError, follow};
pub use lineage::chain;
pub use mint::plan::corpus::{Corpus, CorpusCard, CorpusGame, Intent};
pub use publish::order::{Order, Outcome, Prepared, Tools, commit};
pub use publish::regenerate::{Compared, RegenerateError, Regenerated, Regeneration};
pub use publish::reveal::{RevealError, reveal};
pub use recipe::Recipe;
pub use recipe::beacon::BeaconPart;
pub use recipe::error::{MAX_RECIPE, RecipeError};
pub use recipe::known::Known;
pub use recipe::parts::{CorpusPart, GeneratedPart, InventedPart, Mix, Taxonomy};
pub use recipe::secret::{COMMITS_TO_RECIPE_SINCE, Secret, read_secret};
pub use sections::designs::{Design, DesignPool, DesignsPart, PoolError, Provenance};
pub use sections::frozen::{FrozenGame, JobResult};
pub use sections::puzzles::{PuzzleKind, PuzzlePart};
pub use sections::tiers::Tiers;
pub use sections::{ceilings, marks, memory};

use base::Digest;
