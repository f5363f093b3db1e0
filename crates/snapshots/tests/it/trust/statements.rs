//! Tests of false statements that a release makes about itself after a forger has updated all digests.

use super::small::{Small, home, json, small, witness, won};
use base::Digest;
use base::canonical::to_canonical_json;
use serde_json::json;
use snapshots::export::{Export, Format, export};
use snapshots::released::Released;
use snapshots::{
    Bounds, COMMITS_TO_RECIPE_SINCE, Draft, ReleaseKind, Reveal, SECRET_FILE, Secret, Verification,
    Witnesses, canary, reveal, verify, verify_within,
};
use statistics::{Z95, wilson};
use std::fs;

/// Changes the file whose path ends with the given text.
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
        assert!(problem.contains(words), "{problem} lacks {words}");
    }
}

#[test]
fn manifest_and_recipe_agree() {
    check(|_| {}, &[]);
    check(|release| release.manifest.name = "2027-01".into(), &["the `name` differs from the recipe's"]);
    check(
        |release| release.manifest.parent = Some(Digest::of(b"x")),
        &["the `parent` differs", "`known` lists no release, but the manifest states a parent"],
    );
    check(
        |release| release.manifest.recipe = json!("a pie"),
        &["the `name` differs from the recipe's", "the `canary` does not match the recipe"],
    );
}

/// Adds a request for ceilings to the recipe, and a file with the same number of wins at every commitment.
fn with_ceilings(release: &mut Small, exact: bool, wins: u64, episodes: u64) {
    let recipe = &mut release.manifest.recipe;
    recipe["ceilings"] = json!({ "episodes": 10 });
    let mark = canary(&Digest::of(&json(recipe)));
    let old = std::mem::replace(&mut release.manifest.canary, mark.clone());
    for (_, content) in &mut release.files {
        *content = String::from_utf8(content.clone()).expect("a text").replace(&old, &mark).into_bytes();
    }
    let interval = wilson(wins, episodes, Z95);
    let interval = if exact { [1.0, 1.0] } else { [interval.low, interval.high] };
    let ceilings = ["1", "5", "10", "all"].map(|commit| {
        json!({
            "commit": commit, "player": "witness", "played": "all", "wins": wins, "episodes": episodes,
            "rate": wins as f64 / episodes as f64, "interval": interval,
        })
    });
    let card = release.files.iter().find(|(path, _)| path.ends_with("card.json")).expect("a card");
    let id = card.0.split('/').nth(1).expect("a folder").to_owned();
    let levels = json!([{ "exact": exact, "ceilings": ceilings }]);
    let file = json!({
        "canary": mark, "format": 1, "asked": { "episodes": 10 }, "games": [{ "id": id, "levels": levels }],
    });
    release.files.push(("CEILINGS.json".to_owned(), json(&file)));
}

#[test]
fn ceilings_fit_the_recipe_and_the_levels() {
    check(|release| with_ceilings(release, true, 1, 1), &[]);
    check(
        |release| {
            with_ceilings(release, true, 1, 1);
            release.files.pop();
        },
        &["CEILINGS.json: missing, although the recipe requests ceilings"],
    );
    check(|release| with_ceilings(release, false, 9, 10), &["level 0: `exact` is wrong"]);
    check(|release| with_ceilings(release, false, 9, 9), &["the wins and episodes do not match the recipe"]);
    check(
        |release| {
            with_ceilings(release, false, 9, 10);
            change(release, "CEILINGS.json", |text| text.replacen("\"wins\": 9", "\"wins\": 10", 1));
        },
        &["the win rate and its interval do not follow from the wins"],
    );
    check(
        |release| release.files.push(("CEILINGS.json".to_owned(), b"{}".to_vec())),
        &["CEILINGS.json: not part of a release"],
    );
}

#[test]
fn every_file_carries_the_canary() {
    for file in ["README.md", "game.vgdl"] {
        let expect = format!("{file}: the release's canary is missing");
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
    let expect = &["card.json: the ticks and score differ from those of the episode that wins lvl0.txt"][..];
    check(
        |release| {
            change(release, "card.json", |text| text.replace("\"witness_ticks\": 3", "\"witness_ticks\": 4"))
        },
        &[expect[0], "CARD.json: the card's `witness_ticks` does not match the games' cards"],
    );
    check(
        |release| {
            change(release, "card.json", |text| text.replace("\"witness_score\": 1", "\"witness_score\": 2"))
        },
        expect,
    );
}

/// Returns a secret for the release `2026-12`, whose recipe contains only its name.
fn secret(chance: u8) -> Secret {
    let recipe = Digest::of(&json(&json!({ "name": "2026-12" })));
    Secret::draw("2026-12", recipe, [chance; 64])
}

/// Seals the release by adding its secret and its withheld witness.
fn seal(release: &mut Small) {
    seal_with(release, &secret(7), &secret(7));
}

/// Seals the release with one secret, although its witness was played under a different one.
fn seal_with(release: &mut Small, secret: &Secret, played: &Secret) {
    let mark = canary(&secret.commitment());
    let old = std::mem::replace(&mut release.manifest.canary, mark.clone());
    release.manifest.kind = ReleaseKind::Sealed;
    release.manifest.commitment = Some(secret.commitment());
    release.manifest.recipe = json!({ "name": "2026-12", "commitment": secret.commitment() });
    let episode = won("2026-12", played.root_seed().child("search", 0).child("play", 3));
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

/// A secret unrelated to the games, a recipe changed after the commitment, and a made-up secret are all
/// detected without minting again.
#[test]
fn secrets_must_match_games_and_recipe() {
    check(
        |release| seal_with(release, &secret(7), &secret(8)),
        &["lvl0.json: the seed is not derived from the release's secret"],
    );
    check(
        |release| {
            seal(release);
            release.manifest.recipe["corpus"] = json!({ "games": 3 });
        },
        &["held/secret.json: the manifest's recipe does not match the commitment"],
    );
    let made_up = Secret { seed: "hunter2".to_owned(), ..secret(7) };
    check(
        |release| seal_with(release, &made_up, &made_up),
        &["held/secret.json: the `seed` is not 64 lower-case hexadecimal digits"],
    );
    let pair = Secret { recipe: None, ..secret(7) };
    check(
        |release| {
            seal_with(release, &pair, &pair);
            release.manifest.generation = COMMITS_TO_RECIPE_SINCE;
        },
        &["held/secret.json: the secret does not specify a recipe"],
    );
    // The release is sealed in the way of earlier generations.
    check(
        |release| {
            seal_with(release, &pair, &secret(8));
            release.manifest.generation = COMMITS_TO_RECIPE_SINCE - 1;
            release.manifest.format = 1;
            release.manifest.version = None;
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
    check(without("held/mole"), &["lvl0.json: not covered by the commitment"]);
    check(without("held/secret"), &["held/secret.json: not covered by the commitment"]);
    check(
        without("held/"),
        &["lvl0.json: not covered by the commitment", "secret.json: not covered by the commitment"],
    );
    check(
        |release| {
            seal(release);
            release.files.push(("held/notes.bin".to_owned(), b"x".to_vec()));
        },
        &["held/notes.bin: not part of a sealed release"],
    );
    check(
        |release| {
            seal(release);
            release.manifest.recipe = json!({ "name": "2026-12", "commitment": Digest::of(b"x") });
        },
        &["the `commitment` differs from the recipe's"],
    );
}

/// Problems that concern the whole release are detected before the reveal. The two parts are merged only if
/// they belong together.
#[test]
fn mismatched_parts_are_not_joined() {
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
        let draft = Draft::create(&out).expect("vacant");
        reveal(&whole, &held, Reveal::All, &draft).map_err(|error| error.to_string())
    };
    assert!(joined(&secret(7), &secret(7), &|_| {}).is_ok());
    let refused = |secret: &Secret, played: &Secret, change: &dyn Fn(&mut Small), words: &str| {
        let error = joined(secret, played, change).expect_err(words);
        assert!(error.contains(words), "{error}");
    };
    refused(&secret(7), &secret(8), &|_| {}, "the seed is not derived from the release's secret");
    let other = |release: &mut Small| release.manifest.recipe["board"] = json!({ "rows": [5, 6] });
    refused(&secret(7), &secret(7), &other, "the manifest's recipe does not match the commitment");
    let made_up = Secret { seed: "hunter2".to_owned(), ..secret(7) };
    refused(&made_up, &made_up, &|_| {}, "is not 64 lower-case hexadecimal digits");
}

#[test]
fn revealed_witnesses_are_replayed() {
    let home = home();
    let mut release = small("2026-12", None);
    seal(&mut release);
    release.files.sort();
    release.seal();
    let verification = verify(&release.write_in(&home)).expect("readable");
    assert_eq!(verification.witnesses, Witnesses::Replayed(1));
}

fn verified(release: &mut Small, bounds: &Bounds) -> Verification {
    release.files.sort();
    release.seal();
    verify_within(&release.write_in(&home()), bounds).expect("readable")
}

/// Expects at least the given problems, and ignores any others that follow from them.
#[track_caller]
fn complains(alter: impl FnOnce(&mut Small), words: &[&str]) {
    let mut release = small("2026-12", None);
    alter(&mut release);
    let problems = verified(&mut release, &Bounds::RELEASE).problems;
    for words in words {
        assert!(problems.iter().any(|problem| problem.contains(words)), "no `{words}` in {problems:?}");
    }
}

/// Changes the game's card as JSON.
fn change_card(release: &mut Small, alter: impl Fn(&mut serde_json::Value)) {
    change(release, "/card.json", |text| {
        let mut card = serde_json::from_str(&text).expect("JSON");
        alter(&mut card);
        to_canonical_json(&card).expect("plain data")
    });
}

#[test]
fn impossible_semantics_are_problems() {
    for semantics in [0, engine::SEMANTICS - 1, engine::SEMANTICS + 1, u32::MAX] {
        let expect =
            format!("MANIFEST.json: GENERATION {} never had SEMANTICS {semantics}", generators::GENERATION);
        check(|release| release.manifest.semantics = semantics, &[&expect]);
    }
    check(|release| release.manifest.generation = 0, &["GENERATION 0 never had SEMANTICS"]);
    let number = snapshots::version::CURRENT.number;
    let expect = format!("is minted by version {number}, not 0.1.0");
    check(|release| release.manifest.version = Some("0.1.0".to_owned()), &[&expect]);
    // Later and earlier versions are both possible, but their witnesses are not replayed here.
    let later = (engine::SEMANTICS + 1, generators::GENERATION + 1, "0.99.0");
    for (semantics, generation, version) in [later, (2, 8, "0.8.0")] {
        let mut release = small("2026-12", None);
        (release.manifest.semantics, release.manifest.generation) = (semantics, generation);
        release.manifest.version = Some(version.to_owned());
        let verification = verified(&mut release, &Bounds::RELEASE);
        assert_eq!(verification.problems, [""; 0]);
        assert_eq!(verification.witnesses, Witnesses::NotReplayed { semantics });
    }
}

#[test]
fn impossible_card_numbers() {
    let of_level = |key: &'static str, value: serde_json::Value, words: &str| {
        complains(
            |release| change_card(release, |card| card["levels"][0][key] = value.clone()),
            &[&format!("card.json: lvl0.txt: {words}")],
        );
    };
    of_level("difficulty", json!(1e300), "the difficulty 1000");
    of_level("difficulty", json!(-0.5), "the difficulty -0.5");
    of_level("columns", json!(7), "the card states a board of 7 by 3, but the board is 6 by 3");
    of_level("optimal_ticks", json!(4), "the card states a shortest win of 4 ticks, but a witness of 3");
    of_level("optimal_ticks", json!(0), "the card states a shortest win of 0 ticks");
    of_level("witness_score", json!(1e300), "the card states a score of 1000");
    for who in ["mcts", "random", "idle"] {
        let rate = json!({ "calls": 0, "interval": [0.0, 0.5], "mean_score": 0.0, "plays": 4, "wins": 99 });
        of_level(who, rate, &format!("`{who}` has 99 wins in 4 plays"));
        let rate = json!({ "calls": 0, "interval": [0.0, 0.5], "mean_score": 0.0, "plays": 4, "wins": 0 });
        of_level(who, rate, &format!("`{who}` has the interval 0 to 0.5"));
    }
    let ladder = json!({ "rungs": [], "held_out": [], "ease": 1e300, "difficulty": "medium" });
    of_level("ladder", ladder, "the ease is not between 0 and 1");
}

#[test]
fn large_cards_are_not_read() {
    complains(
        |release| change_card(release, |card| card["title"] = json!("x".repeat(1 << 20))),
        &["card.json: the card has 1050", "the limit is 1048576"],
    );
    let patterns =
        json!({ "from": "generated", "generator": "x", "patterns": vec!["a"; 2000], "candidate": 0 });
    complains(
        |release| change_card(release, |card| card["origin"] = patterns.clone()),
        &["more than 1024 patterns"],
    );
}

#[test]
fn releases_describe_themselves() {
    for file in ["README.md", "CARD.json"] {
        complains(
            |release| release.files.retain(|(path, _)| path != file),
            &[&format!("{file}: missing, but required in every release")],
        );
    }
    complains(
        |release| change(release, "CARD.json", |_| "{".to_owned()),
        &["CARD.json: not a valid release card: EOF"],
    );
    complains(|release| change(release, "CARD.json", |_| "[]".to_owned()), &["not a JSON object"]);
    let with = |key: &'static str, value: serde_json::Value, words: &str| {
        complains(
            |release| {
                change(release, "CARD.json", |text| {
                    let mut card: serde_json::Value = serde_json::from_str(&text).expect("JSON");
                    card[key] = value.clone();
                    to_canonical_json(&card).expect("plain data")
                });
            },
            &[&format!("CARD.json: {words}")],
        );
    };
    with("games", json!(7), "the card's `games` is 7, but the release has 1");
    with("levels", json!("many"), "the card's `levels` is \"many\", but the release has 1");
    with("canary", json!("x"), "the canary differs from the release's canary");
    with("more", json!(1), "not a valid release card: unknown field `more`");
    with("generators", json!({ "search": 1 }), "the card's `generators` does not match");
    with("goals", json!({}), "the card's `goals` does not match");
    with("difficulty", json!({ "easy": 1 }), "the card's `difficulty` does not match");
}

#[test]
fn the_canary_is_that_of_the_recipe() {
    check(
        |release| {
            let mark = release.manifest.canary.clone();
            release.manifest.canary = canary(&Digest::of(b"another"));
            for (_, content) in &mut release.files {
                let text = String::from_utf8(content.clone()).expect("a text");
                *content = text.replace(&mark, &release.manifest.canary).into_bytes();
            }
        },
        &["MANIFEST.json: the `canary` does not match the recipe"],
    );
}

/// Repeats the release's level.
fn repeat_level(release: &mut Small, times: usize) {
    change_card(release, |card| {
        let levels = (0..times).map(|number| {
            let mut level = card["levels"][0].clone();
            level["file"] = json!(format!("lvl{number}.txt"));
            level
        });
        card["levels"] = levels.collect();
    });
    for (path, content) in release.files.clone() {
        for number in 1..times {
            if path.contains("lvl0.") {
                release.files.push((path.replace("lvl0.", &format!("lvl{number}.")), content.clone()));
            }
        }
    }
}

/// Repeats the release's game under a different name.
fn repeat_game(release: &mut Small, name: &str) {
    for (path, content) in release.files.clone() {
        if path.contains("mole-") {
            let text = String::from_utf8(content).expect("a text").replace("\"mole-", &format!("\"{name}-"));
            release.files.push((path.replace("mole-", &format!("{name}-")), text.into_bytes()));
        }
    }
}

/// Identical slow levels cost the verifier only one replay.
#[test]
fn duplicates_are_problems_and_replayed_once() {
    let once = verified(&mut small("2026-12", None), &Bounds::RELEASE);
    assert!(once.work > 0);
    let mut release = small("2026-12", None);
    repeat_level(&mut release, 260);
    let verification = verified(&mut release, &Bounds::RELEASE);
    assert_eq!(verification.work, once.work);
    assert_eq!(verification.witnesses, Witnesses::Replayed(1));
    let again = verification.problems.iter().filter(|one| one.contains("the same level as lvl0.txt"));
    assert_eq!(again.count(), 259);

    let mut release = small("2026-12", None);
    for number in 0..50 {
        repeat_game(&mut release, &format!("vole{number}"));
    }
    let verification = verified(&mut release, &Bounds::RELEASE);
    assert_eq!(verification.work, once.work);
    let again = verification.problems.iter().filter(|one| one.contains("the same game as games/mole-"));
    assert_eq!(again.count(), 50);
}

/// The bound holds for all replays together. Replays beyond it are not played.
#[test]
fn replays_are_bounded() {
    let work = verified(&mut small("2026-12", None), &Bounds::RELEASE).work;
    let bounds = |work, work_per_level| Bounds { work, work_per_level };
    let fits = verified(&mut small("2026-12", None), &bounds(work - 1, 1));
    assert_eq!((fits.problems.len(), fits.work), (0, work));
    let over = verified(&mut small("2026-12", None), &bounds(work - 1, 0));
    assert_eq!(over.work, work - 1);
    let expect = format!("replaying the witnesses takes more than {} units of work", work - 1);
    assert!(over.problems[0].contains(&expect), "{:?}", over.problems);
    // A release's bound grows with the number of levels that it declares.
    assert_eq!(Bounds::RELEASE.of(600), (1 << 31) + 600 * (1 << 21));
}

/// Witnesses that are too long are rejected before the first tick.
#[test]
fn no_witness_is_longer_than_an_episode_can_be() {
    let lengthen = |release: &mut Small, times: usize| {
        change(release, "witness/lvl0.json", |text| {
            let mut witness: serde_json::Value = serde_json::from_str(&text).expect("JSON");
            for key in ["actions", "hashes"] {
                let list = witness["episode"][key].as_array_mut().expect("a list");
                let last = list.last().expect("not empty").clone();
                list.resize(times, last);
            }
            to_canonical_json(&witness).expect("plain data")
        });
        change_card(release, |card| card["levels"][0]["witness_ticks"] = json!(times));
    };
    complains(
        |release| lengthen(release, 2001),
        &[
            "lvl0.json: the episode has 2001 ticks",
            "the card states a witness of 2001 ticks, but a witness has 1 to 2000 ticks",
        ],
    );
    complains(|release| lengthen(release, 4), &["the episode ends in tick 3, but contains further actions"]);
    let mut release = small("2026-12", None);
    lengthen(&mut release, 2001);
    assert_eq!(verified(&mut release, &Bounds::RELEASE).work, 0);
}

#[test]
fn known_content_matches_the_parent() {
    let first = small("2026-12", None);
    let second = small("2027-01", Some(&first));
    assert_eq!(verified(&mut second.clone(), &Bounds::RELEASE).problems, [""; 0]);
    let known = |value: serde_json::Value, words: &str| {
        let mut release = second.clone();
        release.manifest.recipe["known"] = value;
        let problems = verified(&mut release, &Bounds::RELEASE).problems;
        assert!(problems.iter().any(|problem| problem.contains(words)), "{problems:?}");
    };
    known(json!({}), "`known` lists no release, but the manifest states a parent");
    known(json!("nothing"), "`known` is malformed");
    known(
        json!({ "releases": ["2026-12", "2026-12"] }),
        "lists a release twice, or lists the release itself",
    );
    known(json!({ "releases": ["2027-01"] }), "lists a release twice, or lists the release itself");
    let mut orphan = first;
    orphan.manifest.recipe["known"] = json!({ "releases": ["2026-11"] });
    let problems = verified(&mut orphan, &Bounds::RELEASE).problems;
    assert!(
        problems.iter().any(|problem| problem.contains("but the manifest states no parent")),
        "{problems:?}"
    );
}

/// Withheld solutions cannot be exported, not even as empty lists.
#[test]
fn sealed_releases_export_no_solutions() {
    let sealed = |keep: bool| {
        let mut release = small("2026-12", None);
        seal(&mut release);
        release.files.sort();
        release.seal();
        if !keep {
            release.files.retain(|(path, _)| !path.starts_with("held/"));
        }
        let home = home();
        let released = Released::read(&release.write_in(&home)).expect("sound");
        let rows = Export { format: Format::JsonLines, solutions: true, twin: None };
        export(&released, &rows).map(|exported| exported.levels)
    };
    assert_eq!(sealed(true).expect("revealed"), 1);
    let error = sealed(false).expect_err("held back").to_string();
    assert!(error.contains("`2026-12` is sealed") && error.contains("--reveal"), "{error}");
}

/// Texts that follow from the rules are compared with the rules. Texts that belong to a different game, or to
/// no game, are problems.
#[test]
fn cards_say_of_the_rules_what_the_game_says() {
    let html = "<script>alert(1)</script>";
    check(
        |release| change_card(release, |card| card["rules"] = json!(html)),
        &["card.json: the card's `rules` do not match game.vgdl"],
    );
    for text in ["goal", "description"] {
        check(
            |release| change_card(release, |card| card[text] = json!(html)),
            &[&format!("card.json: the card's `{text}` does not match game.vgdl")],
        );
    }
    for title in [html, "Mole "] {
        check(
            |release| change_card(release, |card| card["title"] = json!(title)),
            if title == html { &["card.json: the card's `title` does not match game.vgdl"] } else { &[] },
        );
    }
    complains(
        |release| change_card(release, |card| card["deterministic"] = json!(false)),
        &["card.json: the card's `deterministic` does not match game.vgdl"],
    );
    // Other versions have different wording.
    let mut release = small("2026-12", None);
    (release.manifest.semantics, release.manifest.generation) = (2, 8);
    release.manifest.version = Some("0.8.0".to_owned());
    change_card(&mut release, |card| card["rules"] = json!("Rules in the words of another version."));
    let problems = verified(&mut release, &Bounds::RELEASE).problems;
    assert!(!problems.iter().any(|problem| problem.contains("`rules`")), "{problems:?}");
}
