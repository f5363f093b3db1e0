//! Tests of tampering. `verify` detects every mutation of a release, and reports the affected file.
//!
//! The sweep is seeded, so that failures can be reproduced. It needs Unix for links and sockets.

use super::archives::compress;
use super::small::{Small, home, small};
use base::canonical::to_canonical_json;
use base::{Sampler, Seed};
use serde_json::{Value, json};
use snapshots::archive::pack;
use snapshots::{MANIFEST_FILE, verify};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The number of mutations of the folder in `cargo xtask sweep`. Other runs make a quarter as many.
const FOLDERS: u64 = 1400;
/// The number of mutations of the archive's bytes in `cargo xtask sweep`. Other runs make a quarter as many.
const ARCHIVES: u64 = 600;
/// The number of mutations of the bytes inside the archive in `cargo xtask sweep`. Other runs make a quarter
/// as many.
const INSIDES: u64 = 600;

/// The files of a release by path, including the manifest.
type Files = Vec<(String, Vec<u8>)>;

fn original() -> (Small, Files) {
    let release = small("mole", None);
    let mut files = release.files.clone();
    files.push((MANIFEST_FILE.to_owned(), release.manifest.to_bytes().expect("sound")));
    (release, files)
}

fn write(folder: &Path, files: &Files) {
    for (path, content) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("below")).expect("created");
        fs::write(path, content).expect("written");
    }
}

/// Restores the folder to exactly these files, and removes everything else from it. This is much faster than
/// creating a new folder.
fn heal(home: &TempDir, folder: &Path, files: &Files) {
    let mut open = vec![home.path().to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).expect("readable") {
            let path = entry.expect("readable").path();
            let kind = fs::symlink_metadata(&path).expect("there");
            let wanted = |file: &str| folder.join(file);
            if kind.is_dir()
                && files.iter().any(|(file, _)| wanted(file).starts_with(&path) && wanted(file) != path)
            {
                open.push(path);
            } else if kind.is_dir() {
                fs::remove_dir_all(path).expect("removed");
            } else if !kind.is_file()
                || !files.iter().any(|(file, content)| {
                    wanted(file) == path
                        && content.len() as u64 == kind.len()
                        && fs::read(&path).expect("there") == *content
                })
            {
                fs::remove_file(path).expect("removed");
            }
        }
    }
    for (file, content) in files {
        let path = folder.join(file);
        if !path.exists() {
            fs::create_dir_all(path.parent().expect("below")).expect("created");
            fs::write(path, content).expect("written");
        }
    }
}

/// Returns the objections of `verify` to the release at `place`; empty if the release is sound.
fn complaint(place: &Path) -> String {
    match verify(place) {
        Ok(verification) => verification.problems.join("\n"),
        Err(error) => match std::error::Error::source(&error) {
            Some(source) => format!("{error} ({source})"),
            None => error.to_string(),
        },
    }
}

#[test]
fn folders() {
    let (release, files) = original();
    let mut counts: BTreeMap<&str, u32> = BTreeMap::new();
    let home = home();
    let folder = home.path().join("mole");
    let mutations = if std::env::var_os("ARCADE_SWEEP").is_some() { FOLDERS } else { FOLDERS / 4 };
    for number in 0..mutations {
        heal(&home, &folder, &files);
        assert_eq!(complaint(&folder), "", "untouched");
        let mut sampler = Seed::from_text("tamper with folders").child("mutation", number).sampler();
        let kind = KINDS[number as usize % KINDS.len()];
        let names = tamper(kind, &folder, &files, &mut sampler);
        *counts.entry(kind).or_default() += 1;
        let said = complaint(&folder);
        assert!(!said.is_empty(), "mutation {number}, {kind} of {names:?}, slipped through");
        let named = names.iter().any(|name| said.contains(name.as_str()));
        assert!(named, "mutation {number}, {kind} of {names:?}, was not named: {said}");
    }
    assert!(counts.values().all(|count| *count >= 10), "{counts:?}");
    assert!(release.manifest.items.len() == 6);
}

/// The kinds of mutations of a folder. Each kind runs about eleven times (forty-five times in a sweep) with
/// different random choices.
const KINDS: [&str; 31] = [
    "flip",
    "flip",
    "flip",
    "flip",
    "flip",
    "flip",
    "byte",
    "byte",
    "cut",
    "grow",
    "insert",
    "remove",
    "add",
    "rename",
    "swap",
    "replace",
    "empty folder",
    "folder for file",
    "unsafe name",
    "huge",
    "link",
    "link to folder",
    "hard link",
    "socket",
    "reorder",
    "drop item",
    "double item",
    "escape",
    "double key",
    "number",
    "nest",
];

/// Applies a mutation, and returns the paths that may be reported for it.
fn tamper(kind: &str, folder: &Path, files: &Files, sampler: &mut Sampler) -> Vec<String> {
    let (name, content) = sampler.choose(files).clone();
    let other = loop {
        let other = sampler.choose(files);
        if other.0 != name {
            break other.clone();
        }
    };
    let path = folder.join(&name);
    let put = |bytes: &[u8]| fs::write(&path, bytes).expect("written");
    let mut altered = content.clone();
    let place = sampler.below(content.len());
    match kind {
        "flip" => {
            altered[place] ^= 1 << sampler.below(8);
            put(&altered);
        }
        "byte" => {
            altered[place] = altered[place].wrapping_add(1 + sampler.below(255) as u8);
            put(&altered);
        }
        "cut" => put(&content[..place]),
        "grow" => {
            altered.extend((0..1 + sampler.below(600)).map(|_| sampler.below(256) as u8));
            put(&altered);
        }
        "insert" => {
            altered.insert(place, sampler.below(256) as u8);
            put(&altered);
        }
        "remove" => fs::remove_file(&path).expect("removed"),
        "add" => {
            let at = [".hidden", "games/new.txt", "MANIFEST", "games/x/game.vgdl", "games/Thumbs.db"];
            let at = sampler.choose(&at).to_string();
            fs::create_dir_all(folder.join(&at).parent().expect("below")).expect("created");
            fs::write(folder.join(&at), &content).expect("written");
            return vec![at];
        }
        "rename" => {
            let to = format!("{name}x");
            fs::rename(&path, folder.join(&to)).expect("renamed");
            return vec![name, to];
        }
        "swap" => {
            fs::write(&path, &other.1).expect("written");
            fs::write(folder.join(&other.0), &content).expect("written");
            return vec![name, other.0];
        }
        "replace" => put(&other.1),
        "empty folder" => {
            fs::create_dir_all(folder.join("games/none")).expect("created");
            return vec!["games/none".into()];
        }
        "folder for file" => {
            fs::remove_file(&path).expect("removed");
            fs::create_dir(&path).expect("created");
            if sampler.ratio(1, 2) {
                fs::write(path.join("inside"), &content).expect("written");
            }
        }
        "unsafe name" => {
            let name = *sampler.choose(&["a b", "a\\b", "a:b", "a\u{1b}b", "caf\u{e9}", "end."]);
            fs::write(folder.join(name), &content).expect("written");
            return vec![name.escape_debug().to_string()];
        }
        // The file is large without filling the disk, so a test would notice if the file were read.
        "huge" => {
            let file = fs::File::options().write(true).open(&path).expect("there");
            file.set_len((65 << 20) + sampler.below(1 << 30) as u64).expect("sparse");
        }
        "link" => {
            let outside = folder.with_file_name("outside");
            fs::rename(&path, &outside).expect("moved");
            let targets = [outside.display().to_string(), "nowhere".into(), ".".into(), name.clone()];
            std::os::unix::fs::symlink(sampler.choose(&targets), &path).expect("linked");
        }
        "link to folder" => {
            fs::rename(folder.join("games"), folder.with_file_name("games")).expect("moved");
            std::os::unix::fs::symlink("../games", folder.join("games")).expect("linked");
            return vec!["games".into()];
        }
        // A hard link to the same content is harmless. A link to different content counts as a different file.
        "hard link" => {
            fs::remove_file(&path).expect("removed");
            fs::hard_link(folder.join(&other.0), &path).expect("linked");
        }
        "socket" => {
            fs::remove_file(&path).expect("removed");
            drop(std::os::unix::net::UnixListener::bind(&path).expect("bound"));
        }
        _ => return tamper_with_manifest(kind, folder, sampler),
    }
    vec![name]
}

/// Changes the content of the manifest, in canonical form.
fn tamper_with_manifest(kind: &str, folder: &Path, sampler: &mut Sampler) -> Vec<String> {
    let path = folder.join(MANIFEST_FILE);
    let text = fs::read_to_string(&path).expect("readable");
    let mut manifest: Value = serde_json::from_str(&text).expect("JSON");
    let items = manifest["items"].as_array_mut().expect("items");
    let count = items.len();
    let (one, two) = (sampler.below(count), sampler.below(count - 1));
    let mut insert = None;
    match kind {
        "reorder" => items.swap(one, if two >= one { two + 1 } else { two }),
        "drop item" => drop(items.remove(one)),
        "double item" => items.insert(two, items[one].clone()),
        "escape" => {
            let paths = [
                "../mole/README.md",
                "/etc/passwd",
                "games/../README.md",
                "C:\\x",
                "./README.md",
                "",
                "a\0b",
            ];
            items[one]["path"] = json!(sampler.choose(&paths));
        }
        "number" => {
            let field = *sampler.choose(&["size", "format", "semantics", "generation"]);
            let wrong = ["1e999", "-1", "1.5", "18446744073709551616", "4294967296", "0", "1e1", "null"];
            let wrong = *sampler.choose(&wrong);
            let start = text.find(&format!("\"{field}\": ")).expect("a field") + field.len() + 4;
            let end = start + text[start..].find([',', '\n']).expect("an end");
            insert = Some(format!("{}{wrong}{}", &text[..start], &text[end..]));
        }
        "double key" => {
            let key = *sampler.choose(&["root", "items", "format", "canary", "parent", "recipe"]);
            let value = sampler.choose(&["null", "1", "[]", "\"x\""]);
            insert = Some(text.replacen('{', &format!("{{\n  \"{key}\": {value},"), 1));
        }
        "nest" => {
            let depth = *sampler.choose(&[2, 15, 16, 127, 128, 100_000]);
            let deep = format!("{}{}", "[".repeat(depth), "]".repeat(depth));
            insert = Some(text.replacen("\"seed\": ", &format!("\"deep\": {deep},\n    \"seed\": "), 1));
        }
        other => panic!("no such kind: {other}"),
    }
    let text = insert.unwrap_or_else(|| to_canonical_json(&manifest).expect("plain data"));
    fs::write(&path, text).expect("written");
    vec![MANIFEST_FILE.into()]
}

/// A forger who updates the manifest gets a different root, and still cannot turn a loss into a win.
#[test]
fn forgeries() {
    let honest = small("mole", None);
    for number in 0..200 {
        let mut sampler = Seed::from_text("forge").child("mutation", number).sampler();
        let mut forged = honest.clone();
        let (path, content) = {
            let place = sampler.below(forged.files.len());
            &mut forged.files[place]
        };
        // The line feed at the end is not part of a level.
        let place = sampler.below(content.len() - 1);
        content[place] ^= 1 << sampler.below(7);
        let path = path.clone();
        forged.seal();
        assert_ne!(forged.manifest.root, honest.manifest.root, "{path}, byte {place}");
        let home = home();
        let folder = home.path().join("mole");
        let manifest = (MANIFEST_FILE.to_owned(), forged.manifest.to_bytes().expect("sealed"));
        write(&folder, &[forged.files.clone(), vec![manifest]].concat());
        let said = complaint(&folder);
        if path.ends_with("lvl0.txt") || path.ends_with("witness/lvl0.json") {
            assert!(said.contains(&path), "{path}, byte {place}: {said}");
        }
    }
}

/// The content of a draft, at any depth, is not a published release.
#[test]
fn drafts() {
    let home = home();
    let draft = home.path().join("mole.partial");
    let public = draft.join("tree/public");
    fs::create_dir_all(&public).expect("created");
    let (_, files) = original();
    write(&public, &files);
    // A user's own folder may have such a name.
    assert_eq!(complaint(&public), "");
    fs::write(draft.join(".lock"), "").expect("written");
    for place in [public, draft.join("tree"), draft] {
        let said = complaint(&place);
        assert!(said.contains("is unfinished"), "{}: {said}", place.display());
    }
}

/// A change in the compressed bytes is detected, even if it does not change the content.
#[test]
fn archives() {
    let home = home();
    let (release, _) = original();
    let file = home.path().join("mole.tar.zst");
    pack(&release.write_in(&home), &file).expect("packed");
    let honest = fs::read(&file).expect("there");
    for number in 0..ARCHIVES {
        let mut sampler = Seed::from_text("tamper with archives").child("mutation", number).sampler();
        let mut bytes = honest.clone();
        let place = sampler.below(bytes.len());
        let bit = sampler.below(8);
        match number % 6 {
            0 => bytes.truncate(place),
            1 => bytes.insert(place, sampler.below(256) as u8),
            2 => bytes.extend((0..1 + sampler.below(40)).map(|_| sampler.below(256) as u8)),
            _ => bytes[place] ^= 1 << bit,
        }
        fs::write(&file, &bytes).expect("written");
        let said = complaint(&file);
        let of = honest.len();
        let named = said.contains("mole.tar.zst")
            || said.contains(MANIFEST_FILE)
            || release.manifest.items.iter().any(|item| said.contains(&item.path));
        assert!(named, "mutation {number}, bit {bit} of byte {place} of {of}: {said:?}");
    }
}

#[test]
fn insides() {
    let home = home();
    let (release, files) = original();
    let file = home.path().join("mole.tar.zst");
    pack(&release.write_in(&home), &file).expect("packed");
    let mut honest = Vec::new();
    zstd::stream::copy_decode(fs::File::open(&file).expect("there"), &mut honest).expect("zstd");
    for number in 0..INSIDES {
        let mut sampler = Seed::from_text("tamper with insides").child("mutation", number).sampler();
        let mut bytes = honest.clone();
        let place = sampler.below(bytes.len());
        let block = |sampler: &mut Sampler| 512 * sampler.below(honest.len() / 512);
        match number % 8 {
            0 => bytes.truncate(place),
            1 => drop(bytes.drain(place..place + sampler.between(1, honest.len() - place))),
            2 => {
                let from = block(&mut sampler);
                let piece = bytes[from..from + 512].to_vec();
                let to = block(&mut sampler);
                bytes.splice(to..to, piece);
            }
            3 => bytes.extend([0; 512].repeat(1 + sampler.below(9))),
            _ => bytes[place] ^= 1 << sampler.below(8),
        }
        if bytes == honest {
            continue;
        }
        fs::write(&file, compress(&bytes)).expect("written");
        let said = complaint(&file);
        let named =
            files.iter().any(|(path, _)| said.contains(path.as_str())) || said.contains("mole.tar.zst");
        assert!(named, "mutation {number} at {place}: {said:?}");
    }
}
