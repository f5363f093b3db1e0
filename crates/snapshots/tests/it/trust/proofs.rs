//! Tests of proofs of single items, both honest and forged.

use super::small::small;
use base::{Digest, Seed};
use snapshots::merkle;
use snapshots::proof::{FileProof, ItemProof, MAX_PROOF, ProofError};
use std::convert::Infallible;

fn digest_of(release: &super::small::Small, path: &str) -> Option<Digest> {
    release.files.iter().find(|(known, _)| known == path).map(|(_, content)| Digest::of(content))
}

/// Returns all objections to the proof, given the release's own files.
fn against(proof: &ItemProof, id: &str, root: &Digest) -> Vec<String> {
    let release = small("mole", None);
    let Ok(problems) = proof.check(id, root, |path| Ok::<_, Infallible>(digest_of(&release, path)));
    problems
}

#[test]
fn every_file_and_the_game_are_proved() {
    let release = small("mole", None);
    let root = release.manifest.root;
    for (path, _) in &release.files {
        let proof = ItemProof::of(&release.manifest, path).expect("an item");
        let bytes = proof.to_bytes().expect("small");
        let read = ItemProof::parse(&bytes).expect("what was written");
        assert_eq!(read, proof);
        assert!(against(&read, path, &root).is_empty());
        assert_eq!(against(&read, path, &Digest::of(b"")).len(), 1);
        assert_eq!(against(&read, "games/x", &root).len(), 1);
    }
    let game = release.files[2].0.split('/').nth(1).expect("a game");
    let proof = ItemProof::of(&release.manifest, game).expect("a game");
    assert_eq!(proof.files.len(), release.files.len() - 2);
    assert!(
        against(&ItemProof::parse(&proof.to_bytes().expect("small")).expect("sound"), game, &root).is_empty()
    );
    // If two files are wrong, both are reported, with their digests.
    let Ok(problems) = proof.check(game, &root, |path| {
        Ok::<_, Infallible>((!path.ends_with("card.json")).then(|| Digest::of(b"other")))
    });
    assert_eq!(problems.len(), 4);
    assert!(problems[0].contains("card.json: missing"), "{problems:?}");
    assert!(problems[1].contains(&Digest::of(b"other").to_string()), "{problems:?}");
}

#[test]
fn absent_items_have_no_proof() {
    let release = small("mole", None);
    for id in ["", "games", "games/", "MANIFEST", "MANIFEST.json", "../README.md"] {
        assert!(matches!(ItemProof::of(&release.manifest, id), Err(ProofError::NoSuchItem { .. })), "{id}");
    }
    let error = ItemProof::of(&release.manifest, "README").expect_err("no such item").to_string();
    assert!(error.contains("`README` is neither a file nor a game of `mole`"), "{error}");
}

#[test]
fn hostile_proofs_are_refused_in_words() {
    let release = small("mole", None);
    let honest = ItemProof::of(&release.manifest, "README.md").expect("an item");
    let text = String::from_utf8(honest.to_bytes().expect("small")).expect("JSON");
    let refuse = |text: &str, words: &str| {
        let error = ItemProof::parse(text.as_bytes()).expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    };
    refuse("", "EOF");
    refuse("{}", "missing field");
    refuse("[]", "invalid length");
    refuse(&" ".repeat(MAX_PROOF as usize + 1), "larger than 4194304 bytes");
    refuse(&"[".repeat(100_000), "invalid type");
    refuse(
        &text.replacen("\"release\": \"mole\"", &format!("\"release\": {}", "[".repeat(100_000)), 1),
        "invalid type",
    );
    refuse(&text.replacen('{', "{\"deep\": [[[]]],", 1), "unknown field `deep`");
    refuse(&text.replacen('{', "{\"format\": 1,", 1), "duplicate field `format`");
    refuse(&text.replace("\"format\": 1", "\"format\": 2"), "the proof has format 2");
    refuse(&text.replace("\"format\": 1", "\"format\": 1e99"), "invalid type");
    refuse(&text.replace("\"index\": 2", "\"index\": 99999999999999999999"), "invalid type");
    refuse(&text.replace(&honest.root.to_string(), "12ab"), "`12ab` is not 64 hexadecimal digits");
    refuse(&text.replace("  ", " "), "not in canonical form");
    refuse(
        &text.replace("\"path\": \"README.md\"", "\"path\": \"../README.md\""),
        "`../README.md` cannot be",
    );
    refuse(&text.replace("\"path\": \"README.md\"", "\"path\": \"games/x/y\""), "`games/x/y` isn't part of");
    let written = |proof: &ItemProof| String::from_utf8(proof.to_bytes().expect("small")).expect("JSON");
    let mut many = honest.clone();
    many.files[0].proof.siblings = vec![honest.root; 65];
    refuse(&written(&many), "`README.md` has 65 steps to the root");
    let mut none = honest.clone();
    none.files.clear();
    refuse(&written(&none), "the proof lists no files");
    refuse(
        &text.replace("\"size\": 7", "\"size\": 100001"),
        "leaf 2 of 100001, a position that no release has",
    );
    refuse(&text.replace("\"index\": 2", "\"index\": 7"), "leaf 7 of 7, a position that no release has");
    refuse(
        &text.replace("\"release\": \"mole\"", "\"release\": \"a/b\""),
        "`a/b` is not a valid release name",
    );
    let mut twice = honest.clone();
    twice.files.push(honest.files[0].clone());
    refuse(&written(&twice), "`README.md` is listed twice");
}

/// Every changed character in a proof is detected, except in the release's name, which is only a label, and
/// in the number of leaves, which a path to the root does not bind (RFC 6962).
#[test]
fn every_character_counts() {
    let release = small("mole", None);
    let proof = ItemProof::of(&release.manifest, "README.md").expect("an item");
    let bytes = proof.to_bytes().expect("small");
    let mut sampler = Seed::from_text("proofs").sampler();
    for place in 0..bytes.len() {
        let mut altered = bytes.clone();
        altered[place] ^= 1 << sampler.below(7);
        if let Ok(read) = ItemProof::parse(&altered) {
            let label = ItemProof { release: proof.release.clone(), ..read.clone() } == proof;
            let mut sized = read.clone();
            sized.files[0].proof.size = proof.files[0].proof.size;
            let label = label || sized == proof;
            assert!(label || !against(&read, "README.md", &release.manifest.root).is_empty(), "byte {place}");
        }
    }
}

/// The leaf for the manifest's header is under every root, but it is not a file.
#[test]
fn the_header_is_not_a_file_of_a_release() {
    let release = small("mole", None);
    let leaves = release.manifest.leaves().expect("plain recipe");
    let header = leaves.iter().find(|leaf| leaf.path == "MANIFEST").expect("a leaf");
    let path = merkle::prove(&leaves, "MANIFEST").expect("present");
    for name in ["MANIFEST", "Manifest", "MANIFEST.json"] {
        let crafted = ItemProof {
            format: 1,
            release: "mole".into(),
            root: release.manifest.root,
            item: name.into(),
            files: vec![FileProof { path: name.into(), digest: header.digest, proof: path.clone() }],
        };
        let error = ItemProof::parse(&crafted.to_bytes().expect("small")).expect_err("no file").to_string();
        assert!(error.contains(&format!("`{name}` is the reserved name of the manifest")), "{error}");
    }
}

/// A game's files must have positions in the same tree.
#[test]
fn files_of_a_game_are_of_one_tree() {
    let release = small("mole", None);
    let game = release.files[2].0.split('/').nth(1).expect("a game");
    let honest = ItemProof::of(&release.manifest, game).expect("a game");
    for (index, size) in [(honest.files[0].proof.index, 9), (honest.files[1].proof.index, 7)] {
        let mut crafted = honest.clone();
        (crafted.files[0].proof.index, crafted.files[0].proof.size) = (index, size);
        let error = ItemProof::parse(&crafted.to_bytes().expect("small")).expect_err("apart").to_string();
        assert!(error.contains("cannot be in the same release"), "{error}");
    }
}
