//! `MANIFEST.json`: a release's description, its list of files, and the root that commits to both.
//!
//! # What the root covers
//! The root is the root of the [`merkle`] tree over
//!
//! - one leaf per item, at its path; the items are all files in the release except `MANIFEST.json` itself;
//! - from format 3 on, one leaf for each list of withheld files instead of leaves for these files;
//! - one leaf at the reserved path `MANIFEST` ([`HEADER_LEAF`]), which no file may have. Its digest is the BLAKE3 of
//!   the [canonical JSON](crate::canonical) of the *header*. The header is an object of the manifest's fields
//!   `canary`, `commitment`, `format`, `generation`, `kind`, `name`, `parent`, `recipe`, `semantics` and, from format
//!   2 on, `version`, with `null` for a missing parent or commitment.
//!
//! The root does not cover four fields. `items` and their sizes need not be covered, because the tree is
//! built from the items, and a digest fixes the size. `root` itself cannot be covered. `lockfile` is
//! provenance only, because two builds with the same semantics mint the same release. `checksum` protects the
//! sizes and the lock file against accidents, but not against attackers.

mod bounded;
mod check;
pub(crate) mod item;
pub(crate) mod withheld;

use crate::error::SnapshotError;
use crate::format::layout::HELD;
use crate::format::manifest::item::{Item, ReleaseKind};
use crate::format::manifest::withheld::{HeldPart, Withheld};
use crate::format::merkle::{self, Leaf};
use crate::format::version::MintedBy;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use base::Digest;
use base::canonical::{canonical_digest, is_canonical_json, to_canonical_json};
use std::collections::BTreeSet;

/// The snapshot format of open releases.
pub const FORMAT: u32 = 2;
/// The snapshot format of sealed releases: the newest format that this crate reads. It [hides](crate::withhold) the
/// withheld files, which were listed in earlier formats.
pub const SEALED_FORMAT: u32 = 3;
/// The oldest snapshot format that this crate reads. Manifests in this format do not state a version.
pub(crate) const OLDEST_FORMAT: u32 = 1;
/// The file with the manifest, at the top of the release.
pub const MANIFEST_FILE: &str = "MANIFEST.json";
/// The path of the Merkle leaf for the manifest's header. The root covers the header by covering this leaf.
pub const HEADER_LEAF: &str = "MANIFEST";
/// The maximum size of a manifest, in bytes: 64 MiB.
pub const MANIFEST_LIMIT: u64 = 64 << 20;

/// The description and content of a release. The module documentation states which fields the root covers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// The version of the folder's layout: [`FORMAT`] or [`SEALED_FORMAT`].
    pub format: u32,
    /// The release's name, such as `2026-12`: a single path component.
    pub name: String,
    /// The kind of release, which determines whether its seed is public from the start.
    pub kind: ReleaseKind,
    /// The engine's `SEMANTICS` at the time of minting. Witnesses replay under the same semantics.
    pub semantics: u32,
    /// The generators' `GENERATION` at the time of minting. Under the same generation, the recipe produces
    /// the same bytes.
    pub generation: u32,
    /// The [version](crate::format::version) that minted the release, such as `0.12.0`. This is the generation's
    /// first version, even if a later version was used. `None` in format 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// The root of the previous release; `None` for the first release.
    pub parent: Option<Digest>,
    /// The GUID in every file that can contain one: see [`canary`](crate::canary()).
    pub canary: String,
    /// BLAKE3(seed ‖ nonce), the commitment to the secret of a sealed release; `None` for an open release.
    pub commitment: Option<Digest>,
    /// The digest of the minting binary's `Cargo.lock`. Records provenance only, and is not covered by the root.
    pub lockfile: Digest,
    /// The release's complete recipe.
    #[serde(deserialize_with = "bounded::bounded")]
    pub recipe: Value,
    /// Every file except `MANIFEST.json`, sorted by the bytes of the paths. From format 3 on, withheld files
    /// are not listed.
    pub items: Vec<Item>,
    /// The commitments to withheld files; `None` before format 3, or if no files are withheld.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub withheld: Option<Withheld>,
    /// The root of the tree over the items and the header.
    pub root: Digest,
    /// A checksum that detects a change to any byte in the manifest. It is the BLAKE3 of the digits of
    /// `root`, of `lockfile` and of each item's size, each followed by a line feed.
    pub checksum: Digest,
}

/// The fields of the manifest that the header's leaf covers. Adding a field here changes every root.
#[derive(Serialize)]
struct Header<'a> {
    format: u32,
    name: &'a str,
    kind: ReleaseKind,
    semantics: u32,
    generation: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    version: Option<&'a str>,
    parent: Option<Digest>,
    canary: &'a str,
    commitment: Option<Digest>,
    recipe: &'a Value,
}

impl Manifest {
    /// Returns the version that minted the release.
    pub fn minted_by(&self) -> MintedBy {
        MintedBy { version: self.version.clone(), generation: self.generation, semantics: self.semantics }
    }

    /// Returns the known paths of the files that a sealed release withholds until the reveal. The list files are not
    /// included.
    pub(crate) fn held(&self) -> BTreeSet<&str> {
        let held = self.files().map(|item| item.path.as_str());
        held.filter(|path| path.starts_with(HELD) && HeldPart::of_list(path).is_none()).collect()
    }

    /// Returns the items and the known withheld files.
    pub fn files(&self) -> impl Iterator<Item = &Item> {
        self.items.iter().chain(self.disclosed())
    }

    /// Returns the known withheld files: the lists, and the files listed in them. Empty before format 3.
    pub(crate) fn disclosed(&self) -> &[Item] {
        self.withheld.as_ref().map_or(&[], |withheld| &withheld.disclosed)
    }

    /// Returns the known withheld files, excluding the lists.
    pub(crate) fn withheld_files(&self) -> impl Iterator<Item = &Item> {
        self.disclosed().iter().filter(|item| HeldPart::of_list(&item.path).is_none())
    }

    /// Returns the files in archive order: the items, the lists of withheld files, and then the files in those lists.
    pub(crate) fn in_archive_order(&self) -> impl Iterator<Item = &Item> {
        let lists = self.disclosed().iter().filter(|item| HeldPart::of_list(&item.path).is_some());
        self.items.iter().chain(lists).chain(self.withheld_files())
    }

    /// Returns the item or the known withheld file at a path, if any.
    pub fn item(&self, path: &str) -> Option<&Item> {
        [&self.items[..], self.disclosed()].into_iter().find_map(|items| {
            let at = items.binary_search_by(|item| item.path.as_str().cmp(path)).ok()?;
            Some(&items[at])
        })
    }

    /// Returns `true` if a withheld part's files are hidden, so that not even their paths are known.
    pub(crate) fn hides(&self, part: HeldPart) -> bool {
        self.withheld.as_ref().is_some_and(|withheld| !withheld.knows(part))
    }

    /// Returns `true` if any withheld files are hidden, so that not even their paths are known.
    pub fn is_hiding(&self) -> bool {
        HeldPart::ALL.into_iter().any(|part| self.hides(part))
    }

    /// Checks the items together with the known withheld files.
    pub(crate) fn check_files(&self) -> Result<(), SnapshotError> {
        check::check_files(self)
    }

    /// Returns the leaves of the tree for [`merkle::root`] and [`merkle::prove`]: the items and the header, sorted by
    /// the bytes of their paths.
    ///
    /// # Errors
    /// Returns an error if the recipe cannot be written as canonical JSON.
    pub fn leaves(&self) -> Result<Vec<Leaf>, SnapshotError> {
        let header = canonical_digest(&Header {
            format: self.format,
            name: &self.name,
            kind: self.kind,
            semantics: self.semantics,
            generation: self.generation,
            version: self.version.as_deref(),
            parent: self.parent,
            canary: &self.canary,
            commitment: self.commitment,
            recipe: &self.recipe,
        })?;
        let items = self.items.iter().map(|item| Leaf { path: item.path.clone(), digest: item.digest });
        let mut leaves: Vec<Leaf> = items.collect();
        let lists = HeldPart::ALL.into_iter().zip(self.withheld.iter().cycle());
        leaves.extend(
            lists.map(|(part, withheld)| Leaf { path: part.list().into(), digest: withheld.digest(part) }),
        );
        leaves.push(Leaf { path: HEADER_LEAF.into(), digest: header });
        leaves.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(leaves)
    }

    /// Sorts the items, and computes the root and the checksum. Call this function last, because changing any field
    /// afterwards invalidates the root or the checksum.
    ///
    /// # Errors
    /// Returns an error if two items have the same path, an item has the path [`HEADER_LEAF`], or the recipe cannot be
    /// written as canonical JSON.
    pub fn seal_root(&mut self) -> Result<(), SnapshotError> {
        self.items.sort_by(|a, b| a.path.cmp(&b.path));
        self.root = self.computed_root()?;
        self.checksum = self.computed_checksum();
        Ok(())
    }

    /// Computes the checksum from the root, the lock file and the sizes. The result may differ from the stated
    /// checksum.
    pub(crate) fn computed_checksum(&self) -> Digest {
        let mut text = format!("{}\n{}\n", self.root, self.lockfile);
        for item in &self.items {
            text += &format!("{}\n", item.size);
        }
        Digest::of(text.as_bytes())
    }

    /// Computes the root from the header and the items. The result may differ from the stated root.
    ///
    /// # Errors
    /// See [`Manifest::seal_root`].
    pub fn computed_root(&self) -> Result<Digest, SnapshotError> {
        Ok(merkle::root(&self.leaves()?)?)
    }

    /// Reads a manifest, and checks everything that can be checked without the files, except the root.
    /// [`check_integrity`](crate::check_integrity) reports a wrong root together with the problems in the files.
    ///
    /// # Errors
    /// Returns an error in each of these cases:
    ///
    /// - The manifest is too large, has a different format, or is not JSON with the expected structure.
    /// - The items are unsorted, too large or too many. Item paths are duplicate, reserved or unsafe, or differ only
    ///   in case.
    /// - The name or the canary is malformed.
    /// - A commitment is missing or unexpected.
    /// - The recipe nests too deeply or contains too many values.
    pub fn parse(bytes: &[u8]) -> Result<Manifest, SnapshotError> {
        if bytes.len() as u64 > MANIFEST_LIMIT {
            return Err(SnapshotError::TooLarge { path: MANIFEST_FILE.into(), limit: MANIFEST_LIMIT });
        }
        let syntax = |source| SnapshotError::Syntax { path: MANIFEST_FILE.into(), source };
        // The version is read first, because additions in a newer format must not be judged by the rules of
        // this format.
        let version: Version = serde_json::from_slice(bytes).map_err(syntax)?;
        if version.format > u64::from(SEALED_FORMAT) && !commits_to_known_format(bytes) {
            return Err(SnapshotError::Format { found: version.format, known: SEALED_FORMAT });
        }
        let manifest: Manifest = serde_json::from_slice(bytes).map_err(syntax)?;
        check::check(&manifest)?;
        Ok(manifest)
    }

    /// Returns the bytes of `MANIFEST.json`: canonical JSON, from which [`Manifest::parse`] restores the same
    /// manifest.
    ///
    /// # Errors
    /// Returns an error if `parse` would reject the manifest, or if its root or checksum differs from the computed
    /// value.
    pub fn to_bytes(&self) -> Result<Vec<u8>, SnapshotError> {
        check::check(self)?;
        bounded::bounded(&self.recipe).map_err(|error| check::unsound(error.to_string()))?;
        if self.root != self.computed_root()? {
            return Err(check::unsound("the root does not match the items: seal the root last".into()));
        }
        if self.checksum != self.computed_checksum() {
            return Err(check::unsound(
                "the checksum does not match the lock file and the sizes: seal the root last".into(),
            ));
        }
        let bytes = self.text()?.into_bytes();
        if bytes.len() as u64 > MANIFEST_LIMIT {
            return Err(SnapshotError::TooLarge { path: MANIFEST_FILE.into(), limit: MANIFEST_LIMIT });
        }
        Ok(bytes)
    }

    /// Returns `true` if the given bytes are this manifest's text in this format. The comparison does not build a
    /// second copy of the text.
    ///
    /// # Errors
    /// Returns an error if the recipe cannot be written as canonical JSON.
    pub(crate) fn is_text(&self, bytes: &[u8]) -> Result<bool, SnapshotError> {
        Ok(is_canonical_json(self, bytes)?)
    }

    /// Returns this manifest's text in this format without any checks.
    pub(crate) fn text(&self) -> Result<String, SnapshotError> {
        Ok(to_canonical_json(self)?)
    }
}

/// Returns `true` if a manifest's root matches the format inferred from its fields, whatever version it states. The
/// root covers the version, so no release in a different format can have this root.
fn commits_to_known_format(bytes: &[u8]) -> bool {
    let Ok(mut manifest) = serde_json::from_slice::<Manifest>(bytes) else { return false };
    manifest.format = check::shape(&manifest);
    manifest.computed_root().is_ok_and(|root| root == manifest.root)
}

/// The fields common to all formats.
#[derive(Deserialize)]
struct Version {
    format: u64,
}

#[cfg(test)]
pub(crate) mod tests {
    use serde_json::json;

    use super::*;

    /// Returns a sealed manifest of the given files.
    pub(crate) fn example(files: &[(&str, &[u8])]) -> Manifest {
        let mut manifest = Manifest {
            format: FORMAT,
            name: "2026-12".into(),
            kind: ReleaseKind::Sealed,
            semantics: 3,
            generation: 4,
            version: Some("0.4.0".into()),
            parent: Some(Digest::of(b"the release before")),
            canary: crate::canary(&Digest::of(b"commitment")),
            commitment: Some(Digest::of(b"commitment")),
            lockfile: Digest::of(b"lock"),
            recipe: json!({ "name": "2026-12", "games": [{ "count": 2, "rate": 0.1 }], "sizes": [9, 13] }),
            items: files.iter().map(|(path, content)| Item::of(*path, content)).collect(),
            withheld: None,
            root: Digest::of(b"not yet"),
            checksum: Digest::of(b"not yet"),
        };
        manifest.seal_root().expect("distinct paths");
        manifest
    }

    fn two_files() -> Manifest {
        example(&[("games/x/lvl0.txt", b"w"), ("README.md", b"read me")])
    }

    /// These texts and roots define the formats. They were computed by an independent implementation.
    #[test]
    fn golden() {
        #[track_caller]
        fn check(manifest: &Manifest, expect: &str, root: &str) {
            let bytes = manifest.to_bytes().expect("sound");
            assert_eq!(String::from_utf8(bytes).expect("JSON is UTF-8"), expect);
            assert_eq!(manifest.root.to_string(), root);
            assert_eq!(&Manifest::parse(expect.as_bytes()).expect("golden"), manifest);
        }
        let manifest = two_files();
        check(
            &manifest,
            include_str!("format-2.json"),
            "18004ddc5792ffe7321ac8267a161b1e4b232638edf40883b17be88c300a7705",
        );
        let mut old = Manifest { format: 1, version: None, ..manifest };
        old.seal_root().expect("distinct paths");
        check(
            &old,
            include_str!("format-1.json"),
            "6871261f83a66c26cd308695d0019b0d88fce29a5d0d5c1ba27ff490c54e5175",
        );
    }

    #[test]
    fn parse_reads_what_to_bytes_writes() {
        for manifest in [two_files(), example(&[])] {
            let bytes = manifest.to_bytes().expect("sound");
            assert_eq!(Manifest::parse(&bytes).expect("what was written"), manifest);
        }
    }

    #[test]
    fn every_header_field_and_item_is_under_the_root() {
        let sealed = two_files();
        let root_after = |change: &dyn Fn(&mut Manifest)| {
            let mut manifest = sealed.clone();
            change(&mut manifest);
            manifest.computed_root().expect("distinct paths")
        };
        let changes: [&dyn Fn(&mut Manifest); 15] = [
            &|m| m.format = 1,
            &|m| m.version = Some("0.4.1".into()),
            &|m| m.version = None,
            &|m| m.name.push('x'),
            &|m| m.kind = ReleaseKind::Open,
            &|m| m.semantics += 1,
            &|m| m.generation += 1,
            &|m| m.parent = None,
            &|m| m.canary.push('0'),
            &|m| m.commitment = None,
            &|m| m.recipe["games"][0]["rate"] = json!(0.2),
            &|m| m.items[0].digest = Digest::of(b""),
            &|m| m.items[0].path.push('x'),
            &|m| drop(m.items.pop()),
            &|m| m.items.push(Item::of("z", b"")),
        ];
        for (n, change) in changes.iter().enumerate() {
            assert_ne!(root_after(change), sealed.root, "change {n}");
        }
        // Provenance and the root itself are not covered, and a size follows from the digest.
        assert_eq!(root_after(&|m| m.lockfile = Digest::of(b"")), sealed.root);
        assert_eq!(root_after(&|m| m.root = Digest::of(b"")), sealed.root);
        assert_eq!(root_after(&|m| m.items[0].size += 1), sealed.root);
    }

    #[test]
    fn items_can_be_proved_alone() {
        let manifest = two_files();
        let leaves = manifest.leaves().expect("plain recipe");
        assert_eq!(
            leaves.iter().map(|l| &*l.path).collect::<Vec<_>>(),
            ["MANIFEST", "README.md", "games/x/lvl0.txt"]
        );
        for leaf in &leaves {
            let proof = merkle::prove(&leaves, &leaf.path).expect("present");
            assert!(proof.verify(leaf, &manifest.root));
        }
    }

    #[test]
    fn duplicate_and_reserved_paths_cannot_be_sealed() {
        for path in ["README.md", HEADER_LEAF] {
            let mut manifest = two_files();
            manifest.items.push(Item::of(path, b""));
            let error = manifest.seal_root().expect_err("listed twice");
            assert!(error.to_string().contains(&format!("`{path}` is listed twice")), "{error}");
        }
    }

    #[test]
    fn a_stale_root_is_not_written() {
        let mut manifest = two_files();
        manifest.semantics += 1;
        let error = manifest.to_bytes().expect_err("stale root");
        assert!(error.to_string().contains("seal the root last"), "{error}");
    }

    #[track_caller]
    fn refuse(json: &str, expect: &str) {
        let error = Manifest::parse(json.as_bytes()).expect_err(expect);
        let source = std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default();
        let message = format!("{error} ({source})");
        assert!(message.contains(expect), "{message}");
    }

    #[test]
    fn the_format_is_judged_first() {
        refuse(
            r#"{ "format": 7, "novelty": [] }"#,
            "snapshot format 7 is newer than this version of arcade supports (3): use a newer version",
        );
        refuse(r#"{ "format": 18446744073709551615 }"#, "snapshot format 18446744073709551615 is newer");
        refuse("[7]", "snapshot format 7 is newer");
        let text = two_files().text().expect("plain recipe");
        refuse(
            &text.replace("\"format\": 2", "\"format\": 3"),
            "the manifest states format 3, but has the layout of format 2",
        );
        refuse(r#"{ "format": -1 }"#, "invalid value");
        refuse("{}", "missing field `format`");
        refuse("", "EOF");
        refuse(
            &text.replace("\"format\": 2", "\"format\": 0"),
            "the manifest states format 0, but has the layout of format 2",
        );
    }

    #[test]
    fn the_shape_is_closed() {
        let text = two_files().text().expect("plain recipe");
        refuse(&text.replacen('{', "{\"more\": 1,", 1), "unknown field `more`");
        refuse(&text.replace("\"size\": 1", "\"size\": 1, \"mode\": 7"), "unknown field `mode`");
        refuse(&text.replacen('{', "{\"format\": 2,", 1), "duplicate field `format`");
        refuse(&text.replace("\"sealed\"", "\"Sealed\""), "unknown variant `Sealed`");
        refuse(&text[..text.len() - 3], "EOF");
        refuse(&format!("{text}{{"), "trailing characters");
        let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
        refuse(&text.replace("0.1", &deep), "the recipe is nested deeper than 16 levels");
        let oversize = " ".repeat(MANIFEST_LIMIT as usize + 1);
        refuse(&oversize, "larger than 67108864 bytes");
    }
}
