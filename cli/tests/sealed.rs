//! Sealed releases: what is public gives nothing away, and what is revealed is what was committed to.

mod arcade;

use arcade::{copy_tree, files, run, text};
use std::fs;
use std::path::Path;

/// One new game, one level.
fn recipe(commitment: &str) -> String {
    format!(
        "name = 'sealed'\ndescription = 'x'\ncommitment = '{commitment}'\n[generated]\ngames = 1\nlevels = 1\n\
         candidates = 2.0\n[criteria]\ndecision = 200\nbudget = 240000\ndepths = [10, 25]\nrandom_plays = 20\n"
    )
}

/// Commits and mints into `out`; the secret as JSON.
fn minted(folder: &Path) -> serde_json::Value {
    fs::write(folder.join("sealed.toml"), recipe(&"0".repeat(64))).unwrap();
    let output = run(folder, &["--json", "release", "sealed.toml", "--commit"], 0);
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    fs::write(folder.join("sealed.toml"), recipe(answer["commitment"].as_str().unwrap())).unwrap();
    run(folder, &["release", "sealed.toml", "--secret", "sealed.secret.json", "--out", "out"], 0);
    serde_json::from_slice(&fs::read(folder.join("sealed.secret.json")).unwrap()).unwrap()
}

#[test]
fn a_sealed_release_is_verified_revealed_and_minted_again() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let secret = minted(folder);
    let again = run(folder, &["release", "sealed.toml", "--commit"], 2);
    assert!(text(&again.stderr).contains("never overwritten"), "{}", text(&again.stderr));
    let without = run(folder, &["release", "sealed.toml", "--out", "x"], 2);
    assert!(text(&without.stderr).contains("--secret FILE"), "{}", text(&without.stderr));

    // Nothing public tells the seed, the nonce, or how a level is won.
    let held = files(&folder.join("out/held"));
    let mut secrets: Vec<String> =
        ["seed", "nonce"].map(|key| secret[key].as_str().unwrap().to_owned()).into();
    for (_, content) in held.iter().filter(|(name, _)| *name != "secret.json") {
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
    assert!(text(&output.stdout).contains("held back"), "{}", text(&output.stdout));
    let output = run(folder, &["regenerate", "out/public"], 2);
    assert!(text(&output.stderr).contains("sealed"), "{}", text(&output.stderr));
    run(folder, &["release", "out/public", "--reveal", "out/held", "--out", "revealed"], 0);
    let archived = run(folder, &["export", "out/public", "--format", "archive", "--out", "x.tar.zst"], 2);
    assert!(text(&archived.stderr).contains("pack it when it is revealed"), "{}", text(&archived.stderr));
    let solved = ["export", "out/public", "--format", "jsonl", "--solutions", "--out", "none"];
    let said = text(&run(folder, &solved, 2).stderr);
    assert!(said.contains("its solutions are held back") && !folder.join("none").exists(), "{said}");
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

    // Any other seed, nonce or item is refused, by name.
    let tampered = |file: &str, change: &dyn Fn(String) -> String| {
        let _ = fs::remove_dir_all(folder.join("copy"));
        copy_tree(&folder.join("out"), &folder.join("copy"));
        let path = folder.join("copy").join(file);
        fs::write(&path, change(fs::read_to_string(&path).unwrap())).unwrap();
        let output = run(folder, &["release", "copy/public", "--reveal", "copy/held", "--out", "x"], 1);
        assert!(!folder.join("x").exists());
        text(&output.stdout)
    };
    for key in ["seed", "nonce"] {
        let value = secret[key].as_str().unwrap().to_owned();
        let other = value.chars().rev().collect::<String>();
        let said = tampered("held/secret.json", &|text| text.replace(&value, &other));
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

/// Else seed and witnesses would be published in the belief that they are held back.
#[test]
fn a_secret_for_an_open_release_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    run(folder, &["release", "tiny", "--commit"], 0);
    let output = run(folder, &["release", "tiny", "--secret", "tiny.secret.json", "--out", "x"], 2);
    assert!(text(&output.stderr).contains("the release is open"), "{}", text(&output.stderr));
    assert!(!folder.join("x").exists() && !folder.join("x.partial").exists());
}

/// Hours of work are not to be lost to a wrong name on the command line.
#[test]
fn another_recipe_does_not_go_on_with_the_lots_of_one() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let one = recipe("x").replacen("commitment", "seed", 1);
    fs::write(folder.join("one.toml"), format!("{one}[taxonomy.goals]\ndeliver = [1.0, 1.0]\n")).unwrap();
    run(folder, &["release", "one.toml", "--out", "out"], 2);
    let before = files(&folder.join("out.partial/lots"));
    assert!(before.len() > 2, "{:?}", before.keys());
    let output = run(folder, &["release", "tiny", "--resume", "--out", "out"], 2);
    assert!(text(&output.stderr).contains("another recipe"), "{}", text(&output.stderr));
    assert_eq!(files(&folder.join("out.partial/lots")), before);
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
        text(&output.stderr).contains("not the one that the recipe's `commitment`"),
        "{}",
        text(&output.stderr)
    );
}
