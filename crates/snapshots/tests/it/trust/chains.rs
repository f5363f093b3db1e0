//! Tests of chains of releases in folders.

use super::small::{Small, home, small};
use base::canonical::to_canonical_json;
use base::{Digest, Seed};
use serde_json::json;
use snapshots::archive::pack;
use snapshots::chain::{Chain, Link, follow};
use snapshots::{SnapshotError, canary, verify};
use std::fs;
use std::path::{Path, PathBuf};
use std::slice::from_ref;

fn three() -> [Small; 3] {
    let first = small("2026-12", None);
    let second = small("2027-01", Some(&first));
    let third = small("2027-02", Some(&second));
    [first, second, third]
}

fn ask(start: &Path, folders: &[PathBuf]) -> Result<Chain, SnapshotError> {
    let verification = verify(start)?;
    assert!(verification.problems.is_empty(), "{:?}", verification.problems);
    follow(Link::of(&verification.manifest, start), folders)
}

#[track_caller]
fn check(start: &Path, folders: &[PathBuf], names: &[&str], problems: &[&str]) {
    let chain = ask(start, folders).expect("readable");
    let found: Vec<&str> = chain.releases.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(found, names);
    assert_eq!(chain.problems.len(), problems.len(), "{:?}", chain.problems);
    for (problem, words) in chain.problems.iter().zip(problems) {
        assert!(problem.contains(words), "{problem}");
    }
}

#[test]
fn a_folder_of_releases() {
    let home = home();
    let [first, second, third] = three().map(|release| release.write_in(&home));
    fs::create_dir(home.path().join("notes")).expect("created");
    fs::write(home.path().join("notes/todo.txt"), "x").expect("written");
    fs::write(home.path().join("notes.txt"), "x").expect("written");
    let all = home.path().to_path_buf();
    check(&third, &[all], &["2027-02", "2027-01", "2026-12"], &[]);
    check(&third, &[second.clone(), first.clone()], &["2027-02", "2027-01", "2026-12"], &[]);
    check(&first, from_ref(&second), &["2026-12"], &[]);
    let missing = format!("`2027-02` follows the release with root {}", verify(&second).expect("sound").root);
    check(&third, from_ref(&first), &["2027-02"], &[&missing]);
    let missing = format!("`2027-01` follows the release with root {}", verify(&first).expect("sound").root);
    check(&third, &[second], &["2027-02", "2027-01"], &[&missing]);
    let notes = home.path().join("notes");
    assert!(matches!(ask(&third, from_ref(&notes)), Err(SnapshotError::NoRelease(path)) if path == notes));
    assert!(matches!(ask(&third, &[home.path().join("absent")]), Err(SnapshotError::NotASnapshot(_))));
}

#[test]
fn a_sealed_release_lies_one_folder_deeper() {
    let home = home();
    let [first, _, _] = three();
    let second = small("2027-01", Some(&first)).write_in(&home);
    let place = first.write_in(&home);
    fs::create_dir(home.path().join("sealed")).expect("created");
    fs::rename(place, home.path().join("sealed/public")).expect("moved");
    check(&second, &[home.path().to_path_buf()], &["2027-01", "2026-12"], &[]);
}

#[test]
fn archives_are_links_too() {
    let home = home();
    let [first, second, third] = three().map(|release| release.write_in(&home));
    let archive = home.path().join("2026-12.tar.zst");
    pack(&first, &archive).expect("packed");
    // Two copies of the same release count as one.
    check(&third, &[home.path().to_path_buf()], &["2027-02", "2027-01", "2026-12"], &[]);
    fs::remove_dir_all(first).expect("removed");
    check(&third, &[second, archive], &["2027-02", "2027-01", "2026-12"], &[]);
}

/// Unrelated archives beside the releases are ignored, but an archive of a release is never ignored, however
/// damaged.
#[test]
fn other_archives_are_left_alone() {
    let home = home();
    let [first, _, _] = three();
    let second = small("2027-01", Some(&first)).write_in(&home);
    let place = first.write_in(&home);
    let all = [home.path().to_path_buf()];
    let mut tar = tar::Builder::new(Vec::new());
    tar.append_dir_all("photos", place.join("games")).expect("in memory");
    let tar = zstd::encode_all(&tar.into_inner().expect("in memory")[..], 3).expect("in memory");
    let backup = home.path().join("backup.tar.zst");
    for content in [&tar[..], b"", b"no archive at all"] {
        fs::write(&backup, content).expect("written");
        check(&second, &all, &["2027-01", "2026-12"], &[]);
    }
    // A file that is given explicitly is not ignored.
    let chain = ask(&second, &[place.clone(), backup.clone()]).expect("readable");
    assert!(chain.problems[0].contains("backup.tar.zst"), "{:?}", chain.problems);
    fs::remove_file(&backup).expect("removed");
    let archive = home.path().join("a.tar.zst");
    pack(&place, &archive).expect("packed");
    let sound = fs::read(&archive).expect("there");
    for (spoil, byte) in [(0, b'x'), (sound.len() / 2, sound[sound.len() / 2] ^ 1)] {
        let mut spoilt = sound.clone();
        spoilt[spoil] = byte;
        fs::write(&archive, spoilt).expect("written");
        check(&second, &all, &["2027-01", "2026-12"], &["a.tar.zst"]);
    }
    fs::write(&archive, &sound[..sound.len() - 50]).expect("written");
    check(&second, &all, &["2027-01", "2026-12"], &["a.tar.zst"]);
}

#[test]
fn broken_chain_links_are_reported_and_not_followed() {
    let home = home();
    let [_, second, third] = three().map(|release| release.write_in(&home));
    let all = [home.path().to_path_buf()];
    fs::write(second.join("README.md"), "# 2027-01").expect("written");
    check(&third, &all, &["2027-02"], &["2027-01: README.md: wrong size", "which is not among those given"]);
    fs::write(second.join("MANIFEST.json"), "{ \"format\": 1").expect("written");
    check(&third, &all, &["2027-02"], &["is not a snapshot manifest", "which is not among those given"]);
    fs::write(second.join("MANIFEST.json"), "{ \"format\": 9 }").expect("written");
    check(&third, &all, &["2027-02"], &["snapshot format 9 is newer", "which is not among those given"]);
}

#[test]
fn conflicting_histories_are_reported() {
    let home = home();
    let [first, _, third] = three();
    let second = small("2027-01", Some(&first));
    let fork = small("2027-01-b", Some(&first));
    let places: Vec<PathBuf> =
        [&first, &second, &third, &fork].iter().map(|release| release.write_in(&home)).collect();
    let all = [home.path().to_path_buf()];
    check(&places[2], &all, &["2027-02", "2027-01", "2026-12"], &["`2027-01` in"]);
    let chain = ask(&places[2], &all).expect("readable");
    assert!(chain.problems[0].contains("`2027-01-b`") && chain.problems[0].contains("different histories"));
    assert!(chain.complete && chain.others == 1);
    // From the fork's point of view, the others form the second history.
    check(&places[3], &all, &["2027-01-b", "2026-12"], &["different histories"]);
}

/// A release that follows a missing rival is reported.
#[test]
fn followers_of_absent_rivals_are_reported() {
    let home = home();
    let [first, second, third] = three();
    let rival = small("2027-01-b", Some(&first));
    let after = small("2027-02-b", Some(&rival)).write_in(&home);
    let places = [&first, &second, &third].map(|release| release.write_in(&home));
    let all = [home.path().to_path_buf()];
    let expect = format!("`2027-02-b` in {} follows the release with root", after.display());
    check(&places[2], &all, &["2027-02", "2027-01", "2026-12"], &[&expect]);
    check(&places[2], &places, &["2027-02", "2027-01", "2026-12"], &[]);
}

/// Changes a release's recipe, and its canary accordingly, as a forger would.
fn restate(release: &mut Small, alter: impl FnOnce(&mut serde_json::Value)) {
    alter(&mut release.manifest.recipe);
    let text = to_canonical_json(&release.manifest.recipe).expect("plain data");
    let mark = canary(&Digest::of(text.as_bytes()));
    let old = std::mem::replace(&mut release.manifest.canary, mark.clone());
    for (_, content) in &mut release.files {
        *content = String::from_utf8(content.clone()).expect("a text").replace(&old, &mark).into_bytes();
    }
    release.seal();
}

/// A release must list the content of its parent, and repeat no part of it.
#[test]
fn known_content_equals_the_parents() {
    let first = small("2026-12", None);
    let honest = small("2027-01", Some(&first));
    let known = |alter: &dyn Fn(&mut serde_json::Value), words: &str| {
        let home = home();
        let mut second = honest.clone();
        restate(&mut second, |recipe| alter(&mut recipe["known"]));
        first.write_in(&home);
        let second = second.write_in(&home);
        check(&second, &[home.path().to_path_buf()], &["2027-01", "2026-12"], &[words]);
    };
    let not_known = "has a wrong list of earlier content";
    known(&|known| known["items"] = json!([]), not_known);
    known(&|known| known["items"] = json!([Digest::of(b"x")]), not_known);
    known(&|known| known["games"] = json!(["BasicGame"]), not_known);
    known(&|known| known["releases"] = json!(["2026-11"]), not_known);

    // A copy of the parent, with an honest list of known games.
    let home = home();
    let mut copy = first.clone();
    let recipe = honest.manifest.recipe.clone();
    (copy.manifest.name, copy.manifest.parent) = (honest.manifest.name.clone(), honest.manifest.parent);
    restate(&mut copy, |stated| *stated = recipe);
    first.write_in(&home);
    let copy = copy.write_in(&home);
    let words = "repeats earlier content: games/mole-";
    check(&copy, &[home.path().to_path_buf()], &["2027-01", "2026-12"], &[words]);
}

/// Archives are read one at a time and not kept, so memory is needed for only one file of one archive.
#[test]
fn archives_of_a_chain_are_not_kept() {
    let home = home();
    let mut sampler = Seed::from_text("noise").sampler();
    let noise: Vec<u8> = (0..1 << 20).map(|_| sampler.below(256) as u8).collect();
    let [mut first, _, _] = three();
    for number in 0..8 {
        first.files.push((format!("games/noise{number}"), noise.clone()));
    }
    first.seal();
    let second = small("2027-01", Some(&three()[0])).write_in(&home);
    fs::create_dir(home.path().join("others")).expect("created");
    for number in 0..3 {
        let place = first.write_in(&home);
        pack(&place, &home.path().join(format!("others/{number}.tar.zst"))).expect("packed");
        fs::remove_dir_all(place).expect("removed");
    }
    let start = Link::of(&verify(&second).expect("readable").manifest, &second);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let memory = pool.install(|| {
        allocation_counter::measure(|| {
            follow(start, &[home.path().join("others")]).expect("readable");
        })
    });
    assert!(memory.bytes_max < 4 << 20, "{memory:?}");
}
