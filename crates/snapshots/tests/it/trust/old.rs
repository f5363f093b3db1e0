//! Tests of releases minted by other versions. They are stored in `tests/suite/snapshots`, and must stay
//! readable.

use snapshots::chain::{Link, follow};
use snapshots::{ReleaseKind, SnapshotError, Witnesses, check_integrity, verify};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The digest of the archive of `format-1`.
pub(crate) const FORMAT_1_ARCHIVE: &str = "b1b84cca97d2f13874c28fa0c97487cad52e766e6512c8883ec05278c03efae4";

fn stored(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/suite/snapshots").join(name)
}

#[test]
fn format_1_is_read() {
    let place = stored("format-1");
    let verification = verify(&place).expect("readable");
    assert!(verification.problems.is_empty(), "{:?}", verification.problems);
    assert_eq!((verification.games, verification.levels), (1, 1));
    // The stored release has semantics 2, and this test must keep passing under later semantics.
    assert_eq!(verification.manifest.semantics, 2);
    assert_eq!(verification.witnesses, of_one_level(2));
}

/// Returns the expected result for the witnesses of a one-level release with the given semantics.
fn of_one_level(semantics: u32) -> Witnesses {
    match semantics == engine::SEMANTICS {
        true => Witnesses::Replayed(1),
        false => Witnesses::NotReplayed { semantics },
    }
}

/// From format 2 on, the manifest states the version. The sealed release pins its commitment and the seeds of its
/// episodes.
#[test]
fn format_2_is_read() {
    for (name, kind) in [("format-2", ReleaseKind::Open), ("sealed", ReleaseKind::Sealed)] {
        let verification = verify(&stored(name)).expect("readable");
        assert!(verification.problems.is_empty(), "{:?}", verification.problems);
        assert_eq!(verification.witnesses, of_one_level(3));
        let manifest = verification.manifest;
        assert_eq!((manifest.format, manifest.kind, manifest.version.as_deref()), (2, kind, Some("0.12.0")));
    }
}

/// The witness's hashes were made under different semantics, so replaying it under the current ones would
/// fail.
#[test]
fn witnesses_of_other_semantics_are_not_replayed() {
    let verification = verify(&stored("other-semantics")).expect("readable");
    assert!(verification.problems.is_empty(), "{:?}", verification.problems);
    assert_eq!((verification.games, verification.levels), (1, 1));
    assert_eq!(verification.witnesses, Witnesses::NotReplayed { semantics: 1 });
}

#[test]
fn other_generations_verify_like_any() {
    let verification = verify(&stored("other-generation")).expect("readable");
    assert!(verification.problems.is_empty(), "{:?}", verification.problems);
    assert_ne!(verification.manifest.generation, generators::GENERATION);
    assert_eq!(verification.manifest.parent, Some(verify(&stored("format-1")).expect("readable").root));
}

/// The stored releases form a chain across versions.
#[test]
fn the_chain_crosses_versions() {
    let newest = verify(&stored("other-semantics")).expect("readable");
    let place = stored("other-semantics");
    let chain = follow(Link::of(&newest.manifest, &place), &[stored("")]).expect("readable");
    assert!(chain.problems.is_empty(), "{:?}", chain.problems);
    let names: Vec<&str> = chain.releases.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["other-semantics", "other-generation", "format-1"]);
}

/// Releases from earlier versions are checked like current ones, except for the replay.
#[test]
fn tampered_old_releases_are_detected() {
    let home = super::small::home();
    let place = unpacked("other-semantics", &home);
    let integrity = check_integrity(&place).expect("readable");
    for item in &integrity.manifest.items {
        let path = place.join(&item.path);
        let content = fs::read(&path).expect("readable");
        let mut altered = content.clone();
        altered[content.len() / 2] ^= 1;
        fs::write(&path, altered).expect("written");
        let problems = verify(&place).expect("readable").problems;
        assert!(problems.len() == 1 && problems[0].starts_with(&item.path), "{problems:?}");
        fs::write(&path, content).expect("restored");
    }
    assert!(verify(&place).expect("readable").problems.is_empty());
}

#[test]
fn newer_formats_are_refused_by_name() {
    let home = super::small::home();
    let place = home.path().join("newer");
    fs::create_dir(&place).expect("created");
    fs::write(place.join("MANIFEST.json"), "{ \"format\": 4, \"novelty\": true }").expect("written");
    assert!(matches!(verify(&place), Err(SnapshotError::Format { found: 4, known: 3 })));
}

/// Makes a copy of a stored release.
pub(crate) fn unpacked(name: &str, home: &TempDir) -> PathBuf {
    let (from, to) = (stored(name), home.path().join(name));
    let manifest = check_integrity(&from).expect("stored").manifest;
    for path in manifest.items.iter().map(|item| item.path.as_str()).chain(["MANIFEST.json"]) {
        let target = to.join(path);
        fs::create_dir_all(target.parent().expect("below")).expect("created");
        fs::copy(from.join(path), target).expect("copied");
    }
    to
}
