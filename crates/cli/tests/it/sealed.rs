//! Tests of sealed releases, whose seed and witnesses are withheld. The public part reveals no secret, and the revealed
//! part matches the commitment.

use crate::arcade::{commit, copy_tree, files, run, sweeping, text};
use base::Digest;
use snapshots::Secret;
use std::fs;
use std::path::Path;

/// Returns a recipe with one new game and one level.
fn recipe(commitment: &str) -> String {
    format!(
        "name = 'sealed'\ndescription = 'x'\ncommitment = '{commitment}'\n[generated]\ngames = 1\nlevels = 1\n\
         candidates = 2.0\n[criteria]\ndecision = 200\nbudget = 240000\ndepths = [10, 25]\nrandom_plays = 20\n"
    )
}

/// Commits to a recipe and mints it into `out`. Returns the secret.
fn minted(folder: &Path) -> Secret {
    let secret = commit(folder, &recipe);
    run(folder, &["release", "sealed.toml", "--secret", "sealed.secret.json", "--out", "out"], 0);
    secret
}

#[test]
fn sealed_releases_are_verified_revealed_and_reminted() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let secret = minted(folder);
    let again = run(folder, &["release", "sealed.toml", "--commit"], 2);
    assert!(text(&again.stderr).contains("never overwritten"), "{}", text(&again.stderr));
    // Data covered by the commitment must not be changed either.
    let committed = fs::read_to_string(folder.join("sealed.toml")).unwrap();
    fs::write(folder.join("changed.toml"), committed.replace("candidates = 2.0", "candidates = 3.0"))
        .unwrap();
    let changed =
        run(folder, &["release", "changed.toml", "--secret", "sealed.secret.json", "--out", "x"], 2);
    let said = text(&changed.stderr);
    assert!(said.contains("the recipe does not match its `commitment`"), "{said}");
    assert!(!folder.join("x").exists() && !folder.join("x.partial").exists());
    let without = run(folder, &["release", "sealed.toml", "--out", "x"], 2);
    assert!(text(&without.stderr).contains("--secret FILE"), "{}", text(&without.stderr));

    // Nothing public reveals the seed, the nonce, or how a level is won.
    let held = files(&folder.join("out/held"));
    let mut secrets = vec![secret.seed, secret.nonce.to_string()];
    for (_, content) in held.iter().filter(|(name, _)| name.contains('/')) {
        let witness: serde_json::Value = serde_json::from_slice(content).unwrap();
        secrets.push(witness["episode"]["seed"].to_string().trim_matches('"').to_owned());
        secrets.push(witness["episode"]["actions"].to_string().trim_matches('"').to_owned());
    }
    assert!(secrets.len() >= 4 && secrets.iter().all(|secret| secret.len() > 8), "{secrets:?}");
    for (name, content) in files(&folder.join("out/public")) {
        let content = text(&content);
        assert!(!name.contains("witness"), "{name}");
        assert!(!secrets.iter().any(|secret| content.contains(secret.as_str())), "{name}");
        assert!(!content.contains("\"actions\":"), "{name}");
    }

    let output = run(folder, &["verify", "out/public"], 0);
    assert!(text(&output.stdout).contains("withheld"), "{}", text(&output.stdout));
    let output = run(folder, &["regenerate", "out/public"], 2);
    assert!(text(&output.stderr).contains("sealed"), "{}", text(&output.stderr));
    // The folder with both parts stands for the published part.
    let output = run(folder, &["regenerate", "out"], 2);
    assert!(text(&output.stderr).contains("sealed"), "{}", text(&output.stderr));
    run(folder, &["trust", "keygen", "lab", "--no-password"], 0);
    run(folder, &["trust", "sign", "out", "--secret", "lab.key"], 0);
    assert!(folder.join("out/public/papers/signatures").is_dir());
    for arguments in [
        &["verify", "out", "--key", "lab.pub"][..],
        &["diff", "out", "out/public", "--key", "lab.pub"],
        &["trust", "log", "append", "log", "--secret", "lab.key", "--origin", "x.org/y", "--release", "out"],
        &["gallery", "out", "--out", "page"],
        &["export", "out", "--format", "jsonl", "--out", "withheld"],
        &["evaluate", "out", "--player", "nil", "--max-steps", "2", "--out", "results", "--key", "lab.pub"],
    ] {
        // A sealed release can be appended to a log only after its commitment.
        let status = if arguments[0] == "trust" { 2 } else { 0 };
        let output = run(folder, arguments, status);
        let said = text(&output.stdout) + &text(&output.stderr);
        assert!(!said.contains("no MANIFEST.json"), "{said}");
        assert!(status == 0 || said.contains("no commitment came before its root"), "{said}");
    }
    let card = fs::read_to_string(folder.join("withheld/README.md")).unwrap();
    assert!(
        card.contains("withholds its winning episodes") && !card.contains("every win replayed"),
        "{card}"
    );
    fs::remove_dir_all(folder.join("out/public/papers/signatures")).unwrap();
    // The messages explain common mistakes.
    for (arguments, words) in [
        (vec!["release", "--reveal", "out/held", "--out", "x"], "needs the public folder"),
        (vec!["release", "out", "--reveal", "out/held", "--out", "x"], "did you mean out/public?"),
        (vec!["release", "out/public", "--reveal", "out", "--out", "x"], "did you mean out/held?"),
        (vec!["release", "out/public", "--reveal", "out/public", "--out", "x"], "is not the held part"),
        (vec!["release", "out/public", "--reveal", "out/held"], "--reveal needs --out"),
    ] {
        let said = text(&run(folder, &arguments, 2).stderr);
        assert!(said.contains(words), "{said}");
    }
    fs::write(folder.join("out/public/papers/doi.txt"), "10.5281/zenodo.0").unwrap();
    let output = run(folder, &["release", "out/public", "--reveal", "out/held", "--out", "revealed"], 0);
    assert!(text(&output.stdout).contains("arcade regenerate revealed"), "{}", text(&output.stdout));
    let readme = fs::read_to_string(folder.join("revealed/README.md")).unwrap();
    assert!(readme.contains("was sealed") && !readme.contains("held back"), "{readme}");
    // Only the datasheet differs, because it states that nothing is withheld any longer.
    let papers = |part: &str| {
        let mut papers = files(&folder.join(part).join("papers"));
        assert!(papers.remove("DATASHEET.md").is_some());
        papers
    };
    assert_eq!(papers("revealed"), papers("out/public"));
    let archived = run(folder, &["export", "out/public", "--format", "archive", "--out", "x.tar.zst"], 2);
    assert!(
        text(&archived.stderr).contains("only a complete release can be packed"),
        "{}",
        text(&archived.stderr)
    );
    let solved = ["export", "out/public", "--format", "jsonl", "--solutions", "--out", "none"];
    let said = text(&run(folder, &solved, 2).stderr);
    assert!(said.contains("its solutions are withheld") && !folder.join("none").exists(), "{said}");
    run(folder, &["export", "revealed", "--format", "jsonl", "--solutions", "--out", "rows"], 0);
    let rows = files(&folder.join("rows"));
    let (_, rows) = rows.iter().find(|(name, _)| name.ends_with(".jsonl")).unwrap();
    assert!(!text(rows).contains("\"solution\":[]"), "solutions are exported");
    #[cfg(unix)]
    for place in ["out/held/secret.json", "revealed/held/secret.json"] {
        use std::os::unix::fs::PermissionsExt;
        assert_eq!(fs::metadata(folder.join(place)).unwrap().permissions().mode() & 0o077, 0, "{place}");
    }
    let output = run(folder, &["verify", "revealed"], 0);
    assert!(text(&output.stdout).contains("replayed to a win"), "{}", text(&output.stdout));
    run(folder, &["regenerate", "revealed"], 0);
    let root = |snapshot: &str| {
        let output = run(folder, &["--json", "verify", snapshot], 0);
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()["root"].clone()
    };
    assert_eq!(root("out/public"), root("revealed"));

    // Any other seed, nonce or item is rejected with its name.
    let tampered = |file: &str, change: &dyn Fn(String) -> String| {
        let _ = fs::remove_dir_all(folder.join("copy"));
        copy_tree(&folder.join("out"), &folder.join("copy"));
        let path = folder.join("copy").join(file);
        fs::write(&path, change(fs::read_to_string(&path).unwrap())).unwrap();
        let output = run(folder, &["release", "copy/public", "--reveal", "copy/held", "--out", "x"], 1);
        assert!(!folder.join("x").exists());
        text(&output.stdout)
    };
    for value in &secrets[..2] {
        let other = value.chars().rev().collect::<String>();
        let said = tampered("held/secret.json", &|text| text.replace(value.as_str(), &other));
        assert!(said.contains("held/secret.json"), "{said}");
    }
    let level =
        files(&folder.join("out/public")).into_keys().find(|name| name.ends_with("lvl0.txt")).unwrap();
    let said = tampered(&format!("public/{level}"), &|text| text.replacen('w', ".", 1));
    assert!(said.contains(&level), "{said}");
    let witness = held.keys().find(|name| name.ends_with("lvl0.json")).unwrap();
    let said = tampered(&format!("held/{witness}"), &|text| text.replacen('1', "2", 1));
    assert!(said.contains(witness.as_str()), "{said}");
    fs::remove_dir_all(folder.join("copy")).unwrap();
    copy_tree(&folder.join("out"), &folder.join("copy"));
    fs::remove_file(folder.join("copy/held").join(witness)).unwrap();
    let output = run(folder, &["release", "copy/public", "--reveal", "copy/held", "--out", "x"], 1);
    assert!(text(&output.stdout).contains("missing"), "{}", text(&output.stdout));
}

/// A commitment covers the whole recipe. Therefore, impossible requests and missing guarantees are reported
/// before the commitment is public.
#[test]
fn commitments_are_made_to_recipes_that_can_be_minted() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let recipe = |name: &str, seed: &str, more: &str| {
        let text = format!("name = '{name}'\ndescription = 'x'\n{seed}[generated]\n{more}\n");
        fs::write(folder.join(format!("{name}.toml")), text).unwrap();
    };
    recipe("many", "", "games = 40\nkinds = ['rescue']");
    let said = text(&run(folder, &["release", "many.toml", "--commit"], 2).stderr);
    assert!(
        said.contains("`generated.games` is 40, but the limit is ") && said.contains("of the kinds rescue"),
        "{said}"
    );
    assert!(!folder.join("many.secret.json").exists());
    recipe("many", "seed = 'x'\n", "games = 40\nkinds = ['rescue']");
    for mode in [&["--dry-run"][..], &["--out", "x"]] {
        let said = text(&run(folder, &[&["release", "many.toml"], mode].concat(), 2).stderr);
        assert!(said.contains("; lower `generated.games` to "), "{said}");
    }
    recipe("bare", "seed = 'x'\n", "games = 2");
    let said = text(&run(folder, &["release", "bare.toml", "--dry-run"], 0).stdout);
    for words in [
        "in about ",
        "one mint in twenty takes more than",
        "follows no earlier release",
        "no gates",
        "difficulty is not measured",
    ] {
        assert!(said.contains(words), "no `{words}` in {said}");
    }
    recipe("late", "", &format!("games = 2\ncommitment = '{}'", "0".repeat(64)));
    let said = text(&run(folder, &["release", "late.toml", "--dry-run"], 2).stderr);
    assert!(said.contains("move the line above the first [table]"), "{said}");
}

/// An invented seed can be guessed, so it is rejected.
#[test]
fn invented_secrets_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("sealed.toml"), recipe(&"0".repeat(64))).unwrap();
    let drawn = Secret {
        name: "sealed".to_owned(),
        seed: Digest::of(b"seed").to_string(),
        nonce: Digest::of(b"nonce"),
        recipe: Some(Digest::of(b"recipe")),
    };
    let other = |change: &dyn Fn(&mut Secret)| {
        let mut secret = drawn.clone();
        change(&mut secret);
        secret
    };
    for made_up in [
        other(&|secret| secret.seed = "hunter2".to_owned()),
        other(&|secret| secret.seed = "5".repeat(64)),
        other(&|secret| secret.nonce = secret.seed.parse().unwrap()),
    ] {
        fs::write(folder.join("my secret.json"), serde_json::to_vec(&made_up).unwrap()).unwrap();
        // The commitment has the form that an older `arcade` accepted.
        fs::write(folder.join("sealed.toml"), recipe(&made_up.commitment().to_string())).unwrap();
        for verb in
            [vec!["release", "sealed.toml", "--out", "x"], vec!["release", "sealed.toml", "--dry-run"]]
        {
            let said = text(&run(folder, &[&verb[..], &["--secret", "my secret.json"]].concat(), 2).stderr);
            assert!(
                said.contains("my secret.json") && said.contains("arcade release RECIPE --commit"),
                "{said}"
            );
        }
    }
}

/// The command that `--commit` proposes works, even if names contain spaces. Cases in which it cannot work
/// are rejected immediately.
#[test]
fn proposed_commands_work() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let said = text(&run(folder, &["release", "sealed", "--commit"], 2).stderr);
    assert!(said.contains("no recipe named `sealed`"), "{said}");
    fs::create_dir(folder.join("my recipes")).unwrap();
    let path = folder.join("my recipes/sealed.toml");
    fs::write(&path, recipe(&"0".repeat(64))).unwrap();
    let said = text(&run(folder, &["release", "sealed", "--commit"], 2).stderr);
    assert!(!said.contains("to read your file"), "{said}");
    let said = text(&run(folder, &["release", "my recipes/sealed", "--commit"], 2).stderr);
    assert!(said.contains("pass its path: 'my recipes/sealed.toml'"), "{said}");

    let output =
        run(folder, &["release", "my recipes/sealed.toml", "--commit", "--out", "my secret.json"], 0);
    let said = text(&output.stdout);
    let line = |words: &str| said.lines().find_map(|line| line.trim().strip_prefix(words)).unwrap().trim();
    let commitment = line("commitment =").trim_matches('"').to_owned();
    fs::write(&path, recipe(&commitment)).unwrap();
    let command = shlex::split(line("mint it with:")).unwrap();
    let arguments: Vec<&str> = command.iter().skip(1).map(String::as_str).collect();
    let output = run(folder, &[&arguments[..], &["--dry-run"]].concat(), 0);
    assert!(text(&output.stdout).contains("would mint 1 new game of"), "{}", text(&output.stdout));
    assert!(!text(&output.stdout).contains("corpus games"), "{}", text(&output.stdout));

    // A recipe of the binary cannot be changed.
    let said = text(&run(folder, &["release", "tiny", "--commit"], 0).stdout);
    assert!(said.contains("arcade recipes show tiny > tiny.toml"), "{said}");
    assert!(said.contains("arcade release tiny.toml --secret tiny.secret.json"), "{said}");
}

/// A shard contains winning episodes, like a release's withheld part.
#[cfg(unix)]
#[test]
fn shards_of_a_sealed_release_are_private() {
    use std::os::unix::fs::PermissionsExt;
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let commitment = commit(folder, &recipe).commitment().to_string();
    let secret = ["--secret", "sealed.secret.json"];
    for (shard, out) in [("1/2", "one"), ("2/2", "two")] {
        let mint = [&["release", "sealed.toml", "--shard", shard, "--out", out][..], &secret].concat();
        let said = text(&run(folder, &mint, 0).stdout);
        assert!(said.contains("arcade merge SHARD... --out DIR --secret FILE"), "{said}");
        let said = text(&run(folder, &[&mint[..], &["--resume"]].concat(), 0).stdout);
        assert!(said.contains("already complete"), "{said}");
        let shard = folder.join(out);
        let jobs = files(&shard).into_keys().map(|name| shard.join(name));
        let places: Vec<_> = jobs.chain([shard.clone(), shard.join("jobs")]).collect();
        assert_eq!(places.len(), 4, "{places:?}");
        for place in places {
            let mode = fs::metadata(&place).unwrap().permissions().mode();
            assert_eq!(mode & 0o077, 0, "{}: {mode:o}", place.display());
        }
    }
    run(folder, &[&["merge", "one", "two", "--out", "out"][..], &secret].concat(), 0);
    run(folder, &["verify", "out/public"], 0);
    let resumed = ["release", "sealed.toml", "--out", "out", "--resume"];
    let said = text(&run(folder, &[&resumed[..], &secret].concat(), 0).stdout);
    assert!(said.contains("already complete"), "{said}");
    // If a folder is inaccessible or a loop, its content is unknown.
    std::os::unix::fs::symlink("loop", folder.join("loop")).unwrap();
    run(folder, &["release", "out/public", "--reveal", "loop", "--out", "x"], 3);
    run(folder, &["release", "out/public", "--reveal", "out/held", "--out", "whole"], 0);
    let datasheet = |part: &str| fs::read_to_string(folder.join(part).join("papers/DATASHEET.md")).unwrap();
    assert!(datasheet("out/public").contains("held back until it is revealed"));
    let revealed = datasheet("whole");
    assert!(revealed.contains("sealed and revealed") && !revealed.contains("held back"), "{revealed}");
    // A lost commitment can be restored from the secret.
    fs::write(folder.join("lost.toml"), recipe("x").replace("commitment = 'x'\n", "")).unwrap();
    let lost = text(&run(folder, &[&["release", "lost.toml"][..], &secret].concat(), 2).stderr);
    assert!(lost.contains(&commitment), "{lost}");
}

/// A secret is rejected for an open release. Otherwise, the seed and the witnesses would be published in the
/// belief that they are withheld.
#[test]
fn a_secret_for_an_open_release_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    run(folder, &["release", "tiny", "--commit"], 0);
    let output = run(folder, &["release", "tiny", "--secret", "tiny.secret.json", "--out", "x"], 2);
    assert!(text(&output.stderr).contains("the release is open"), "{}", text(&output.stderr));
    assert!(!folder.join("x").exists() && !folder.join("x.partial").exists());
}

/// A wrong name on the command line must not destroy hours of work.
#[test]
fn other_recipes_do_not_reuse_finished_jobs() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let one = recipe("x").replacen("commitment", "seed", 1);
    fs::write(folder.join("one.toml"), format!("{one}[taxonomy.goals]\ndeliver = [1.0, 1.0]\n")).unwrap();
    run(folder, &["release", "one.toml", "--out", "out"], 2);
    let before = files(&folder.join("out.partial/jobs"));
    assert!(before.len() > 2, "{:?}", before.keys());
    let output = run(folder, &["release", "tiny", "--resume", "--out", "out"], 2);
    assert!(text(&output.stderr).contains("a different recipe"), "{}", text(&output.stderr));
    assert_eq!(files(&folder.join("out.partial/jobs")), before);
    fs::write(folder.join("one.toml"), one).unwrap();
    run(folder, &["release", "one.toml", "--out", "out", "--resume"], 0);
}

#[test]
fn another_secret_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("sealed.toml"), recipe(&"0".repeat(64))).unwrap();
    run(folder, &["release", "sealed.toml", "--commit"], 0);
    let output = run(folder, &["release", "sealed.toml", "--secret", "sealed.secret.json", "--out", "x"], 2);
    assert!(
        text(&output.stderr).contains("does not match the recipe's `commitment`"),
        "{}",
        text(&output.stderr)
    );
}

/// A recipe uses memory tests and a beacon together. The random choices, the renamed copies and the second wins follow
/// from the seed combined with the beacon's value.
#[test]
fn coins_follow_from_the_beacon_too() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    commit(folder, &|commitment| {
        recipe(commitment) + "[memory]\nwitnesses = true\n[beacon]\nsource = 'dice'\nround = 7\n"
    });
    let mut roots = Vec::new();
    for (name, value) in [("one", "ab"), ("two", "cd")] {
        let value = value.repeat(32);
        let drawn = format!("{{ \"source\": \"dice\", \"round\": 7, \"value\": \"{value}\" }}");
        fs::write(folder.join("round.json"), drawn).unwrap();
        let secret = ["--secret", "sealed.secret.json", "--beacon", "round.json", "--out", name];
        run(folder, &[&["release", "sealed.toml"][..], &secret].concat(), 0);
        let [public, held, revealed] = ["public", "held", "revealed"].map(|part| format!("{name}/{part}"));
        run(folder, &["verify", &public], 0);
        run(folder, &["release", &public, "--reveal", &held, "--out", &revealed], 0);
        let held = files(&folder.join(&held)).into_keys().filter(|name| name.contains('/')).count();
        assert!(held > 0, "something is withheld");
        run(folder, &["verify", &revealed], 0);
        if name == "two" || sweeping() {
            run(folder, &["regenerate", &revealed], 0);
        }
        let manifest = fs::read(folder.join(revealed).join("MANIFEST.json")).unwrap();
        let manifest: serde_json::Value = serde_json::from_slice(&manifest).unwrap();
        assert_eq!(manifest["recipe"]["beacon"]["value"], value);
        roots.push(manifest["root"].clone());
    }
    assert_ne!(roots[0], roots[1]);
    // The beacon's value is under the root.
    let moved = folder.join("one/revealed/MANIFEST.json");
    let swapped = fs::read_to_string(&moved).unwrap().replace(&"ab".repeat(32), &"cd".repeat(32));
    fs::write(&moved, swapped).unwrap();
    let output = run(folder, &["verify", "one/revealed"], 1);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("wrong root"), "{said}");
}
