//! Tests of signed releases: keys, key sets, and the way `verify` and other subcommands use them.

use crate::arcade::{copy_of_tiny, copy_tree, run, text};
use serde_json::Value;
use snapshots::Manifest;
use std::fs;
use std::path::Path;

fn json(folder: &Path, args: &[&str], status: i32) -> Value {
    let args: Vec<&str> = ["--json"].into_iter().chain(args.iter().copied()).collect();
    serde_json::from_slice(&run(folder, &args, status).stdout).unwrap()
}

#[track_caller]
fn says(folder: &Path, args: &[&str], status: i32, words: &str) {
    let output = run(folder, args, status);
    let said = text(&output.stdout) + &text(&output.stderr);
    assert!(said.contains(words), "{said}");
}

#[test]
fn releases_are_signed_by_enough_keys() {
    let (home, _) = copy_of_tiny();
    let folder = home.path();
    for name in ["ada", "bo", "cy"] {
        json(folder, &["trust", "keygen", name, "--no-password"], 0);
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = fs::metadata(folder.join("ada.key")).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
    }
    says(folder, &["trust", "keygen", "ada", "--no-password"], 2, "keys are never overwritten");
    // A lost public key is written again.
    let public = fs::read(folder.join("ada.pub")).unwrap();
    fs::remove_file(folder.join("ada.pub")).unwrap();
    run(folder, &["trust", "keygen", "ada", "--no-password"], 0);
    assert_eq!(fs::read(folder.join("ada.pub")).unwrap(), public);

    says(
        folder,
        &["verify", "tiny", "--key", "ada.pub"],
        1,
        "there are no signatures at `tiny/papers/signatures`",
    );
    says(folder, &["trust", "sign", "tiny"], 2, "--secret FILE");
    says(folder, &["trust", "sign", "tiny", "--secret", "ada.key"], 0, "signed by");
    says(folder, &["verify", "tiny", "--key", "ada.pub"], 0, "(1 needed)");
    says(folder, &["verify", "tiny", "--key", "bo.pub"], 1, "not signed by the key in bo.pub (");

    let add = [
        "trust",
        "keys",
        "trust",
        "--add",
        "ada=ada.pub",
        "bo=bo.pub",
        "--threshold",
        "2",
        "--secret",
        "ada.key",
    ];
    says(folder, &add, 0, "2 of 2 keys must sign");
    says(folder, &["verify", "tiny", "--key", "trust/keys-1.json"], 1, "does not specify a set of keys");
    let keys = ["--keys", "trust/keys-1.json"];
    says(folder, &["trust", "sign", "tiny", "--secret", "cy.key", keys[0], keys[1]], 2, "is not in the set");
    says(
        folder,
        &["trust", "sign", "tiny", "--secret", "ada.key", keys[0], keys[1]],
        1,
        "more keys must sign",
    );
    let signed = json(
        folder,
        &["trust", "sign", "tiny", "--secret", "bo.key", keys[0], keys[1], "--commit", "0123abc"],
        1,
    );
    assert_eq!(signed["signed"]["signers"], serde_json::json!(["bo"]), "another statement");
    says(
        folder,
        &["trust", "sign", "tiny", "--secret", "bo.key", keys[0], keys[1]],
        0,
        "signed by ada, bo (2 needed",
    );
    says(folder, &["verify", "tiny", "--key", "trust/keys-1.json"], 0, "signed by ada, bo (2 needed");

    // `bo` has lost the key, and `cy` takes over. Both keys of the old set would have to sign, so a set whose
    // threshold is all keys cannot afford to lose one.
    let next = [
        "trust",
        "keys",
        "trust",
        "--add",
        "cy=cy.pub",
        "--revoke",
        "bo=lost",
        "--secret",
        "ada.key",
        "cy.key",
    ];
    says(folder, &next, 1, "keys-2.json: signed by ada of the previous set, but 2 must sign");
    says(folder, &["trust", "keys", "trust", "--secret", "bo.key"], 0, "the set follows from keys-1.json");
    let keys = ["--keys", "trust/keys-2.json"];
    says(
        folder,
        &["trust", "sign", "tiny", "--secret", "ada.key", "cy.key", keys[0], keys[1]],
        0,
        "newest set of keys: 2",
    );
    says(folder, &["verify", "tiny", "--key", "trust/keys-1.json"], 0, "signed by ada, cy (2 needed");
    says(folder, &["verify", "tiny", "--key", "bo.pub"], 1, "the key of `bo` is revoked: lost");

    // The same holds for an archive, whose signatures lie beside it.
    let said =
        text(&run(folder, &["export", "tiny", "--format", "archive", "--out", "tiny.tar.zst"], 0).stdout);
    let copy = said
        .lines()
        .find(|line| line.contains("cp -r "))
        .and_then(|line| line.split_once("next to the archive:  "));
    let copy = shlex::split(copy.unwrap().1).unwrap();
    assert_eq!(copy, ["cp", "-r", "tiny/papers/signatures", "tiny.signatures"]);
    says(
        folder,
        &["verify", "tiny.tar.zst", "--key", "ada.pub"],
        1,
        "there are no signatures at `tiny.signatures`: copy the release's papers/signatures to that folder",
    );
    copy_tree(&folder.join(&copy[2]), &folder.join(&copy[3]));
    run(folder, &["verify", "tiny.tar.zst", "--key", "trust/keys-1.json"], 0);
    fs::remove_dir_all(folder.join(&copy[3])).unwrap();
    says(folder, &["trust", "sign", "tiny.tar.zst", "--secret", "ada.key"], 0, "signed by");
    let found = json(folder, &["verify", "tiny.tar.zst", "--key", "ada.pub"], 0);
    assert_eq!(found["signed"]["threshold"], 1);

    // Subcommands that use a release accept its root or its key, and record the checks made.
    let (ada, bo) = (["--key", "ada.pub"], ["--key", "bo.pub"]);
    says(
        folder,
        &["export", "tiny", "--format", "jsonl", "--out", "rows", bo[0], bo[1]],
        1,
        "nothing was done",
    );
    let found = json(folder, &["export", "tiny", "--format", "jsonl", "--out", "rows", ada[0], ada[1]], 0);
    assert_eq!(
        (&found["origin"]["root_compared"], &found["origin"]["signed"]["threshold"]),
        (&false.into(), &1.into())
    );
    says(folder, &["diff", "tiny", "tiny", bo[0], bo[1]], 1, "the key of `bo` is revoked: lost");
    run(folder, &["diff", "tiny", "tiny", ada[0], ada[1]], 0);
    let play = ["evaluate", "tiny", "--player", "nil", "--max-steps", "2", "--out", "results"];
    let other = "0".repeat(64);
    says(folder, &[&play[..], &["--root", &other]].concat(), 1, "the root is");
    says(
        folder,
        &["evaluate", "hailglass", "--player", "nil", "--root", &other],
        2,
        "--root and --key require a snapshot",
    );
    run(folder, &[&play[..], &["--key", "trust/keys-1.json"]].concat(), 0);
    let record: Value =
        serde_json::from_slice(&fs::read(folder.join("results/origin.json")).unwrap()).unwrap();
    assert_eq!(record["signed"]["keys"], 2);
    says(
        folder,
        &["report", "results", "--root", &other, "--out", "report"],
        1,
        "the results belong to the release with root",
    );

    // A manifest with a different lock file has the same root, but is not the signed manifest.
    let manifest = folder.join("tiny/MANIFEST.json");
    let honest = fs::read_to_string(&manifest).unwrap();
    let mut altered = Manifest::parse(honest.as_bytes()).unwrap();
    altered.lockfile = base::Digest::of(b"another");
    altered.seal_root().unwrap();
    fs::write(&manifest, altered.to_bytes().unwrap()).unwrap();
    run(folder, &["verify", "tiny"], 0);
    says(
        folder,
        &["verify", "tiny", ada[0], ada[1]],
        1,
        "but the signed statement specifies a different one",
    );
    fs::write(&manifest, honest).unwrap();

    // A changed release is not signed.
    fs::write(folder.join("tiny/README.md"), "changed").unwrap();
    says(
        folder,
        &["trust", "sign", "tiny", "--secret", "ada.key"],
        2,
        "does not verify, so nothing was signed: README.md",
    );
}

#[test]
fn passwords_are_kept() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("pass"), "correct horse\n").unwrap();
    fs::write(folder.join("wrong"), "battery\n").unwrap();
    run(folder, &["trust", "keygen", "ada", "--password-file", "pass"], 0);
    fs::remove_file(folder.join("ada.pub")).unwrap();
    says(folder, &["trust", "keygen", "ada", "--password-file", "wrong"], 2, "`ada.key`: wrong password");
    run(folder, &["trust", "keygen", "ada", "--password-file", "pass"], 0);
    fs::write(folder.join("empty"), "").unwrap();
    says(folder, &["trust", "keygen", "bo", "--password-file", "empty"], 2, "the password is empty");
    says(folder, &["trust", "keys", "trust"], 2, "make the first set with --add");
    says(folder, &["trust", "keys", "trust", "--add", "ada"], 2, "write NAME=FILE");
    says(
        folder,
        &["trust", "keys", "trust", "--add", "ada=ada.key"],
        2,
        "`ada.key`: not a minisign public key",
    );
}
