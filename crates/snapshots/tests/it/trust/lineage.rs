//! Tests of a release's ancestors, some of which are missing or damaged.

use super::small::{Small, home, small};
use snapshots::archive::pack;
use snapshots::chain::Link;
use snapshots::lineage::{Ancestor, Lineage, trace};
use snapshots::verify;
use std::fs;
use std::path::{Path, PathBuf};
use std::slice::from_ref;

fn three() -> [Small; 3] {
    let first = small("2026-12", None);
    let second = small("2027-01", Some(&first));
    let third = small("2027-02", Some(&second));
    [first, second, third]
}

fn ask(start: &Path, folders: &[PathBuf]) -> Lineage {
    let verification = verify(start).expect("readable");
    let mut heard = Vec::new();
    let lineage = trace(&Link::of(&verification.manifest, start), folders, &mut |ancestor| {
        heard.push(ancestor.clone());
        true
    });
    let lineage = lineage.expect("readable");
    assert_eq!(lineage.ancestors, heard);
    lineage
}

/// Returns an ancestor's name, or `None` if the ancestor is missing, and the number of its problems.
fn told(ancestor: &Ancestor) -> (Option<&str>, usize) {
    (ancestor.link.as_ref().map(|link| link.name.as_str()), ancestor.problems.len())
}

#[track_caller]
fn check(start: &Path, folders: &[PathBuf], ancestors: &[(Option<&str>, usize)], complete: bool) -> Lineage {
    let lineage = ask(start, folders);
    assert_eq!(lineage.ancestors.iter().map(told).collect::<Vec<_>>(), ancestors);
    assert_eq!((lineage.complete, &lineage.problems), (complete, &Vec::new()));
    lineage
}

#[test]
fn parents_are_followed_as_far_as_they_are_found() {
    let home = home();
    let [first, second, third] = three().map(|release| release.write_in(&home));
    let all = [home.path().to_path_buf()];
    let lineage = check(&third, &all, &[(Some("2027-01"), 0), (Some("2026-12"), 0)], true);
    let roots: Vec<_> = lineage.ancestors.iter().map(|ancestor| ancestor.root).collect();
    assert_eq!(roots, [&second, &first].map(|place| verify(place).expect("sound").root));
    check(&first, &all, &[], true);
    // Later releases and releases of other histories do not matter.
    check(&second, &all, &[(Some("2026-12"), 0)], true);
    check(&third, from_ref(&second), &[(Some("2027-01"), 0), (None, 0)], false);
    check(&third, &[], &[(None, 0)], false);
    // Archives are found too.
    let archive = home.path().join("2026-12.tar.zst");
    pack(&first, &archive).expect("packed");
    fs::remove_dir_all(&first).expect("removed");
    check(&third, &all, &[(Some("2027-01"), 0), (Some("2026-12"), 0)], true);
}

#[test]
fn altered_parents_are_recognised() {
    let home = home();
    let [_, second, third] = three().map(|release| release.write_in(&home));
    let all = [home.path().to_path_buf()];
    let readme = fs::read(second.join("README.md")).expect("there");
    fs::write(second.join("README.md"), "# 2027-01").expect("written");
    let lineage = check(&third, &all, &[(Some("2027-01"), 1)], false);
    assert!(lineage.ancestors[0].problems[0].contains("README.md"), "{lineage:?}");
    // A sound copy in a different folder is preferred.
    let other = super::small::home();
    let copy = three()[1].write_in(&other);
    let both = [all[0].clone(), copy];
    check(&third, &both, &[(Some("2027-01"), 0), (Some("2026-12"), 0)], true);
    // With its own root, it is a different release.
    fs::write(second.join("README.md"), readme).expect("written");
    let mut forged = three()[1].clone();
    forged.files.retain(|(path, _)| path != "README.md");
    forged.seal();
    fs::remove_dir_all(&second).expect("removed");
    forged.write_in(&home);
    check(&third, &all, &[(None, 0)], false);
    // An unreadable release is reported by name, because it may be the missing one.
    fs::write(second.join("MANIFEST.json"), "{ \"format\": 1").expect("written");
    let lineage = check(&third, &all, &[(None, 0)], false);
    assert!(lineage.unread.iter().any(|place| place.contains("2027-01")), "{:?}", lineage.unread);
}

#[test]
fn whoever_listens_can_end_it() {
    let home = home();
    let [_, _, third] = three().map(|release| release.write_in(&home));
    let manifest = verify(&third).expect("sound").manifest;
    let lineage = trace(&Link::of(&manifest, &third), &[home.path().to_path_buf()], &mut |_| false);
    let lineage = lineage.expect("readable");
    assert_eq!((lineage.ancestors.len(), lineage.complete), (1, false));
}
