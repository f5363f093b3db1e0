//! What a release says of itself, by a forger who states the digests of what is there.

use crate::small::{Small, home, json, small, witness, won};
use engine::Digest;
use serde_json::json;
use snapshots::{COVERING, Draft, Kind, SECRET_FILE, Secret, Witnesses, canary, reveal, verify};
use std::fs;

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

/// A secret for the release `2026-12`, whose recipe says nothing but its name.
fn secret(chance: u8) -> Secret {
    let recipe = Digest::of(&json(&json!({ "name": "2026-12" })));
    Secret::draw("2026-12", recipe, [chance; 64])
}

/// The same release sealed: its secret and witness are held back, or there.
fn seal(release: &mut Small) {
    seal_with(release, &secret(7), &secret(7));
}

/// Sealed with one secret, and its witness played under another.
fn seal_with(release: &mut Small, secret: &Secret, played: &Secret) {
    let mark = canary(&secret.commitment());
    let old = std::mem::replace(&mut release.manifest.canary, mark.clone());
    release.manifest.kind = Kind::Sealed;
    release.manifest.commitment = Some(secret.commitment());
    release.manifest.recipe = json!({ "name": "2026-12", "commitment": secret.commitment() });
    let episode = won(played.root_seed().child("search", 0).child("play", 3));
    for (path, content) in &mut release.files {
        *content = String::from_utf8(content.clone()).expect("a text").replace(&old, &mark).into_bytes();
        if path.contains("/witness/") {
            *content = json(&witness(&mark, episode.clone(), &[("search", 0), ("play", 3)]));
        }
        if let Some((game, level)) = path.clone().split_once("/witness/") {
            *path = format!("held/{}/{level}", game.trim_start_matches("games/"));
        }
    }
    release.files.push((SECRET_FILE.to_owned(), json(secret)));
}

/// A secret that has nothing to do with the games, a recipe that was changed after it was committed to, a secret that was made
/// up: each is told without minting again.
#[test]
fn a_secret_has_to_be_that_of_the_games_and_of_the_recipe() {
    check(
        |release| seal_with(release, &secret(7), &secret(8)),
        &["lvl0.json: its chance does not come from the release's secret"],
    );
    check(
        |release| {
            seal(release);
            release.manifest.recipe["corpus"] = json!({ "games": 3 });
        },
        &["held/secret.json: the manifest's recipe is not the one that was committed to"],
    );
    let made_up = Secret { seed: "hunter2".to_owned(), ..secret(7) };
    check(
        |release| seal_with(release, &made_up, &made_up),
        &["held/secret.json: its `seed` is not 64 lower-case hexadecimal digits"],
    );
    let pair = Secret { recipe: None, ..secret(7) };
    check(
        |release| {
            seal_with(release, &pair, &pair);
            release.manifest.generation = COVERING;
        },
        &["held/secret.json: it names no recipe"],
    );
    // As releases of earlier generations were sealed.
    check(
        |release| {
            seal_with(release, &pair, &secret(8));
            release.manifest.generation = COVERING - 1;
        },
        &[],
    );
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

/// What is told of a release that is there is told before it is: the two parts are joined only if they belong together.
#[test]
fn two_parts_that_do_not_belong_together_are_not_joined() {
    let joined = |secret: &Secret, played: &Secret, change: &dyn Fn(&mut Small)| {
        let home = home();
        let mut release = small("2026-12", None);
        seal_with(&mut release, secret, played);
        change(&mut release);
        release.files.sort();
        release.seal();
        let whole = release.write_in(&home);
        let (held, out) = (home.path().join("held"), home.path().join("out"));
        fs::rename(whole.join("held"), &held).expect("moved");
        reveal(&whole, &held, &Draft::create(&out).expect("vacant")).map_err(|error| error.to_string())
    };
    assert!(joined(&secret(7), &secret(7), &|_| {}).is_ok());
    let refused = |secret: &Secret, played: &Secret, change: &dyn Fn(&mut Small), words: &str| {
        let error = joined(secret, played, change).expect_err(words);
        assert!(error.contains(words), "{error}");
    };
    refused(&secret(7), &secret(8), &|_| {}, "its chance does not come from the release's secret");
    let other = |release: &mut Small| release.manifest.recipe["board"] = json!({ "rows": [5, 6] });
    refused(&secret(7), &secret(7), &other, "the manifest's recipe is not the one that was committed to");
    let made_up = Secret { seed: "hunter2".to_owned(), ..secret(7) };
    refused(&made_up, &made_up, &|_| {}, "is not 64 lower-case hexadecimal digits");
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
