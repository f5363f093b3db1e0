//! Tests that sealed releases hide their withheld files, and commit to them.

use super::small::{Small, home, json, small, witness, won};
use base::Digest;
use serde_json::{Value, json};
use snapshots::archive::{Archive, pack};
use snapshots::proof::ItemProof;
use snapshots::{
    Draft, MANIFEST_FILE, Manifest, ReleaseKind, Reveal, SECRET_FILE, Secret, Witnesses, canary,
    check_integrity, reveal, verify, withhold,
};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The files of a release, by path.
type Files = Vec<(String, Vec<u8>)>;

const LISTS: [&str; 2] = ["held/REST.json", "held/SOLUTIONS.json"];

/// Returns a sealed release whose recipe chooses at random between two wins of each level, and its secret. `more` lists
/// additional withheld files.
fn sealed(more: &[(&str, &[u8])]) -> (Small, Secret) {
    let recipe = json!({ "name": "2026-12", "memory": { "siblings": true, "witnesses": true } });
    let secret = Secret::draw("2026-12", Digest::of(&json(&recipe)), [7; 64]);
    let mark = canary(&secret.commitment());
    let mut release = small("2026-12", None);
    let old = std::mem::replace(&mut release.manifest.canary, mark.clone());
    release.manifest.kind = ReleaseKind::Sealed;
    release.manifest.commitment = Some(secret.commitment());
    release.manifest.recipe = recipe;
    release.manifest.recipe["commitment"] = json!(secret.commitment());
    let episode = won("2026-12", secret.root_seed().child("search", 0));
    for (path, content) in &mut release.files {
        *content = String::from_utf8(content.clone()).unwrap().replace(&old, &mark).into_bytes();
        if let Some((game, level)) = path.clone().split_once("/witness/") {
            *content = json(&witness(&mark, episode.clone(), &[("search", 0)]));
            *path = format!("held/{}/{level}", game.trim_start_matches("games/"));
        }
    }
    release.files.push((SECRET_FILE.to_owned(), json(&secret)));
    release.files.extend(more.iter().map(|(path, content)| ((*path).to_owned(), content.to_vec())));
    hide(&mut release, &secret);
    (release, secret)
}

/// Commits to the withheld files, as a mint does.
fn hide(release: &mut Small, secret: &Secret) {
    release.files.retain(|(path, _)| !LISTS.contains(&path.as_str()));
    release.files.sort();
    release.seal();
    release.files.extend(withhold(&mut release.manifest, secret).unwrap());
    release.manifest.seal_root().unwrap();
    release.files.sort();
}

/// Writes the release, but only the wanted files below `held/`.
fn parts(release: &Small, home: &TempDir, wanted: impl Fn(&str) -> bool) -> PathBuf {
    let mut part = release.clone();
    part.files.retain(|(path, _)| !path.starts_with("held/") || wanted(path));
    part.write_in(home)
}

fn problems(release: &Small, wanted: impl Fn(&str) -> bool) -> Vec<String> {
    verify(&parts(release, &home(), wanted)).unwrap().problems
}

/// Nothing public shows whether a guessed withheld text is correct, or whether such a text exists at all.
#[test]
fn guesses_cannot_be_checked() {
    let guess: &[u8] = b"BasicGame\n    # one of a million renamings\n";
    let (release, secret) = sealed(&[]);
    let (with_sibling, _) = sealed(&[("held/siblings/x/game.vgdl", guess)]);
    let manifest = |release: &Small| String::from_utf8(release.manifest.to_bytes().unwrap()).unwrap();
    let (one, other) = (manifest(&release), manifest(&with_sibling));
    assert_ne!(one, other);
    // Apart from digests, the two manifests are the same, including the paths, the sizes and the number of files.
    let masked = |text: &str| {
        let mut value: Value = serde_json::from_str(text).unwrap();
        for key in ["root", "checksum"] {
            value[key] = json!("");
        }
        value["withheld"] = json!({ "rest": "" });
        value
    };
    assert_eq!((masked(&one), one.len()), (masked(&other), other.len()));
    for (path, content) in with_sibling.files.iter().filter(|(path, _)| path.starts_with("held/")) {
        let digest = Digest::of(content).to_string();
        // A list's digest is public, but the list begins with a salt that nobody can guess.
        assert!(LISTS.contains(&path.as_str()) || !other.contains(&digest), "{path}");
        assert!(!other.contains(path.as_str()), "{path}");
    }
    // Someone who knows everything except the salt computes a different digest.
    let list = |release: &Small, at: usize| {
        let (_, content) = release.files.iter().find(|(path, _)| path == LISTS[at]).unwrap();
        serde_json::from_slice::<Value>(content).unwrap()
    };
    let (rest, solutions) = (list(&release, 0), list(&release, 1));
    assert_ne!(rest["salt"], solutions["salt"]);
    for salt in [&rest["salt"], &solutions["salt"]] {
        let salt = salt.as_str().unwrap();
        assert!(
            salt.len() == 64 && ![secret.seed.clone(), secret.nonce.to_string()].contains(&salt.to_owned())
        );
    }
}

#[test]
fn each_stage_verifies_under_the_same_root() {
    let (release, _) = sealed(&[]);
    let home = home();
    let check = |wanted: &dyn Fn(&str) -> bool, expect: Witnesses| {
        let verification = verify(&parts(&release, &home, wanted)).unwrap();
        assert_eq!(verification.problems, Vec::<String>::new());
        assert_eq!((verification.root, verification.witnesses), (release.manifest.root, expect));
        fs::remove_dir_all(home.path().join("2026-12")).unwrap();
    };
    check(&|_| false, Witnesses::Held);
    check(&|path| path == LISTS[1] || path.contains("/lvl0"), Witnesses::Replayed(1));
    check(&|_| true, Witnesses::Replayed(1));
}

fn split(release: &Small, home: &TempDir) -> [PathBuf; 2] {
    let whole = release.write_in(home);
    let held = home.path().join("held");
    fs::rename(whole.join("held"), &held).unwrap();
    [whole, held]
}

#[test]
fn the_parts_are_joined_and_packed() {
    let (release, _) = sealed(&[]);
    let home = home();
    let [public, held] = split(&release, &home);
    for (what, files) in [(Reveal::Solutions, 2), (Reveal::All, release.files.len() - 5)] {
        let out = home.path().join(format!("{what:?}"));
        let draft = Draft::create(&out).unwrap();
        assert_eq!(reveal(&public, &held, what, &draft).unwrap().root, release.manifest.root);
        draft.commit().unwrap();
        assert!(verify(&out).unwrap().problems.is_empty());
        let there = check_integrity(&out).unwrap().manifest;
        assert_eq!(there.files().filter(|item| item.path.starts_with("held/")).count(), files, "{what:?}");
    }
    let (all, archive) = (home.path().join("All"), home.path().join("a.tar.zst"));
    assert!(pack(&public, &archive).unwrap_err().to_string().contains("complete release"));
    assert!(pack(&home.path().join("Solutions"), &archive).is_err());
    pack(&all, &archive).unwrap();
    assert!(verify(&archive).unwrap().problems.is_empty());
    let unpacked = home.path().join("unpacked");
    Archive::open(&archive).unwrap().unpack(&unpacked).unwrap();
    for (path, content) in &release.files {
        assert_eq!(&fs::read(unpacked.join(path)).unwrap(), content, "{path}");
    }
    // Withheld files are proved through their list.
    let manifest = check_integrity(&all).unwrap().manifest;
    let proof = ItemProof::of(&manifest, LISTS[0]).unwrap();
    let digest = |path: &str| Ok::<_, ()>(fs::read(all.join(path)).ok().map(|bytes| Digest::of(&bytes)));
    assert_eq!(proof.check(LISTS[0], &manifest.root, digest), Ok(Vec::new()));
    let error = ItemProof::of(&manifest, SECRET_FILE).unwrap_err().to_string();
    assert!(error.contains("prove `held/REST.json`"), "{error}");
}

/// Neither a list nor a file in it can be changed, removed, added or moved.
#[test]
fn lists_bind_what_was_withheld() {
    let check = |release: &Small, wanted: &dyn Fn(&str) -> bool, words: &str| {
        let problems = problems(release, wanted);
        assert!(problems.iter().any(|problem| problem.contains(words)), "no `{words}` in {problems:?}");
    };
    let (release, secret) = sealed(&[]);
    check(&release, &|path| path != SECRET_FILE, "held/secret.json: missing");
    check(&release, &|path| !path.contains("lvl0"), "lvl0.json: missing");
    check(&release, &|path| path != LISTS[1], "held/SOLUTIONS.json: missing");
    check(&release, &|path| !LISTS.contains(&path), "held/secret.json: extra");
    check(&release, &|path| path == LISTS[0], "held/SOLUTIONS.json: missing");
    let altered = |path: &str| {
        let mut altered = release.clone();
        let (_, content) = altered.files.iter_mut().find(|(name, _)| name == path).unwrap();
        *content = String::from_utf8(content.clone()).unwrap().replacen('1', "2", 1).into_bytes();
        altered
    };
    for path in [SECRET_FILE, LISTS[0], LISTS[1]] {
        check(&altered(path), &|_| true, &format!("{path}: altered"));
    }
    // Forgeries with their own root are made here.
    let forged = |change: &dyn Fn(&mut Files)| {
        let mut forged = release.clone();
        change(&mut forged.files);
        hide(&mut forged, &secret);
        forged
    };
    let without = |part: &'static str| forged(&move |files| files.retain(|(path, _)| !path.contains(part)));
    check(&without("lvl0.json"), &|_| true, "lvl0.json: not covered by the commitment");
    check(&without("held/secret"), &|_| true, "held/secret.json: not covered by the commitment");
    let added = forged(&|files| files.push(("held/notes.bin".to_owned(), b"x".to_vec())));
    check(&added, &|_| true, "held/notes.bin: not part of a sealed release");
    let mut salted = release.clone();
    hide(&mut salted, &Secret { nonce: Digest::of(b"other"), ..secret.clone() });
    check(&salted, &|_| true, "held/REST.json: the salt is not derived from the release's secret");
    // Files that were committed to, but are not lists.
    let listed = |change: &dyn Fn(&mut Value)| {
        let mut release = release.clone();
        let (_, content) = release.files.iter_mut().find(|(path, _)| path == LISTS[0]).unwrap();
        let mut list = serde_json::from_slice(content).unwrap();
        change(&mut list);
        *content = json(&list);
        let mut manifest: Value = serde_json::to_value(&release.manifest).unwrap();
        manifest["withheld"]["rest"] = json!(Digest::of(content));
        release.manifest = serde_json::from_value(manifest).unwrap();
        release.manifest.seal_root().unwrap();
        release
    };
    let item = |path: &str| json!({ "path": path, "size": 1, "digest": Digest::of(b"x") });
    for (path, words) in [
        ("games/x/lvl0.txt", "`games/x/lvl0.txt` does not belong in this list"),
        ("held/x/lvl0.json", "`held/x/lvl0.json` does not belong in this list"),
        (LISTS[1], "does not belong in this list"),
        ("held/siblings/../x", "cannot be in a snapshot"),
        ("held/secret.json", "listed twice"),
    ] {
        let added = listed(&|list| list["items"].as_array_mut().unwrap().push(item(path)));
        check(&added, &|_| true, words);
    }
    check(&listed(&|list| list["more"] = json!(1)), &|_| true, "not a list of withheld files (unknown field");
}

/// The manifest says nothing about `held/`, and only a sealed manifest withholds files.
#[test]
fn manifests_name_no_withheld_file() {
    let (release, _) = sealed(&[]);
    let refused = |change: &dyn Fn(&mut Manifest), words: &str| {
        let mut manifest = release.manifest.clone();
        change(&mut manifest);
        let error = manifest.seal_root().and_then(|()| manifest.to_bytes()).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(&|manifest| manifest.items.push(snapshots::Item::of("held/x", b"")), "all of held/ is withheld");
    refused(
        &|manifest| (manifest.kind, manifest.commitment) = (ReleaseKind::Open, None),
        "the manifest is open, but withholds files",
    );
    refused(&|manifest| manifest.format = 2, "the manifest states format 2, but has the layout of format 3");
    let home = home();
    let place = parts(&release, &home, |_| false);
    let text = fs::read_to_string(Path::new(&place).join(MANIFEST_FILE)).unwrap();
    assert!(!text.contains("held/"), "{text}");
}
