//! What a release says of itself, by a forger who states the digests of what is there.

use crate::small::{Small, home, small};
use engine::Digest;
use serde_json::json;
use snapshots::{Kind, SECRET_FILE, Secret, Witnesses, canary, verify};

/// The file at the path that ends so, changed.
fn change(release: &mut Small, end: &str, change: impl Fn(String) -> String) {
    let (_, content) = release.files.iter_mut().find(|(path, _)| path.ends_with(end)).expect("there");
    *content = change(String::from_utf8(content.clone()).expect("a text")).into_bytes();
}

#[track_caller]
fn check(alter: impl FnOnce(&mut Small), problems: &[&str]) {
    let home = home();
    let mut release = small("2026-12", None);
    alter(&mut release);
    release.files.sort();
    release.seal();
    let verification = verify(&release.write_in(&home)).expect("readable");
    assert_eq!(verification.problems.len(), problems.len(), "{:?}", verification.problems);
    for (problem, words) in verification.problems.iter().zip(problems) {
        assert!(problem.contains(words), "{problem}");
    }
}

#[test]
fn the_manifest_says_what_its_recipe_says() {
    check(|_| {}, &[]);
    check(|release| release.manifest.name = "2027-01".into(), &["its `name` is not that of its recipe"]);
    check(|release| release.manifest.parent = Some(Digest::of(b"x")), &["its `parent` is not"]);
    check(|release| release.manifest.recipe = json!("a pie"), &["its `name` is not that of its recipe"]);
}

#[test]
fn every_file_carries_the_canary() {
    for file in ["README.md", "game.vgdl"] {
        let expect = format!("{file}: without the release's canary");
        check(
            |release| {
                let mark = release.manifest.canary.clone();
                change(release, file, |text| text.replace(&mark, "-"));
            },
            &[&expect],
        );
    }
}

#[test]
fn cards_tell_of_the_episode_that_wins() {
    let expect = &["card.json: not the ticks and score of the episode that wins lvl0.txt"][..];
    check(
        |release| {
            change(release, "card.json", |text| text.replace("\"witness_ticks\": 3", "\"witness_ticks\": 4"))
        },
        expect,
    );
    check(
        |release| {
            change(release, "card.json", |text| text.replace("\"witness_score\": 1", "\"witness_score\": 2"))
        },
        expect,
    );
}

/// The same release sealed: its secret and witness are held back, or there.
fn seal(release: &mut Small) {
    let secret = Secret::draw("2026-12", [7; 64]);
    let mark = canary(&secret.commitment());
    let old = std::mem::replace(&mut release.manifest.canary, mark.clone());
    release.manifest.kind = Kind::Sealed;
    release.manifest.commitment = Some(secret.commitment());
    release.manifest.recipe = json!({ "name": "2026-12", "commitment": secret.commitment() });
    for (path, content) in &mut release.files {
        *content = String::from_utf8(content.clone()).expect("a text").replace(&old, &mark).into_bytes();
        if let Some((game, level)) = path.clone().split_once("/witness/") {
            *path = format!("held/{}/{level}", game.trim_start_matches("games/"));
        }
    }
    let text = serde_json::to_vec(&secret).expect("plain data");
    release.files.push((SECRET_FILE.to_owned(), text));
}

#[test]
fn a_sealed_release_commits_to_a_witness_of_every_level() {
    check(seal, &[]);
    let without = |part: &'static str| {
        move |release: &mut Small| {
            seal(release);
            release.files.retain(|(path, _)| !path.contains(part));
        }
    };
    check(without("held/mole"), &["lvl0.json: not committed to"]);
    check(without("held/secret"), &["held/secret.json: not committed to"]);
    check(without("held/"), &["lvl0.json: not committed to", "secret.json: not committed to"]);
    check(
        |release| {
            seal(release);
            release.files.push(("held/notes.bin".to_owned(), b"x".to_vec()));
        },
        &["held/notes.bin: a sealed release has no such file"],
    );
    check(
        |release| {
            seal(release);
            release.manifest.recipe = json!({ "name": "2026-12", "commitment": Digest::of(b"x") });
        },
        &["its `commitment` is not that of its recipe"],
    );
}

#[test]
fn what_is_revealed_is_replayed() {
    let home = home();
    let mut release = small("2026-12", None);
    seal(&mut release);
    release.files.sort();
    release.seal();
    let verification = verify(&release.write_in(&home)).expect("readable");
    assert_eq!(verification.witnesses, Witnesses::Replayed(1));
}
