//! Proofs for single items, written from a snapshot and checked without it.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use base::Digest;
use base::MessagePath;
use base::count;
use disk::Access;
use serde_json::json;
use snapshots::folder::{self, Limits};
use snapshots::proof::{ItemProof, MAX_PROOF};
use snapshots::{Manifest, SnapshotError};
use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Writes the proof for an item in a verified snapshot, and returns a message.
pub(super) fn write(manifest: &Manifest, id: &str, file: &Path) -> Result<String, Failure> {
    let proof = ItemProof::of(manifest, id)?;
    let bytes = proof.to_bytes()?;
    disk::create(file, &bytes, Access::Shared).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            malformed!(
                "`{}` already exists: choose another path for --write-proof, or remove it",
                file.in_message()
            )
        }
        _ => Failure::write(file, error),
    })?;
    Ok(format!("proof of {} written to {}", count(proof.files.len(), "file"), file.in_message()))
}

/// Checks an item against its proof and a root from another source.
pub(super) fn check(place: &Path, id: &str, file: &Path, root: &Digest, console: &Console) -> Answer {
    let bytes = read(file)?;
    let proof = ItemProof::parse(&bytes).map_err(|error| malformed!("`{}`: {error}", file.in_message()))?;
    if place.is_file() && proof.item == id && proof.files.iter().any(|file| file.path != id) {
        let count = count(proof.files.len(), "file");
        bail!("`{id}` is a game with {count}: pass its folder");
    }
    let problems = problems(place, id, &proof, root)?;
    let sound = problems.is_empty();
    let paths: Vec<&str> = proof.files.iter().map(|file| file.path.as_str()).collect();
    console.document(&json!({ "item": id, "root": root, "files": paths, "problems": problems }))?;
    for problem in &problems {
        console.say(problem);
    }
    match sound {
        true => {
            console.say(format_args!("{id}: in the release with root {root}; {}", count(paths.len(), "file")))
        }
        false => console.say(format_args!("{}: NOT proven to be `{id}` in that release", place.in_message())),
    }
    Ok(sound)
}

fn problems(place: &Path, id: &str, proof: &ItemProof, root: &Digest) -> Result<Vec<String>, SnapshotError> {
    let io = |action, path: &Path, source| SnapshotError::Io { action, path: path.to_path_buf(), source };
    let found = fs::metadata(place).map_err(|source| io("examine", place, source))?;
    if found.is_dir() {
        // The place is the game's own folder, or a folder that contains it.
        let inside = place.join("games").join(id);
        let top = if inside.is_dir() { inside } else { place.to_path_buf() };
        let prefix = format!("games/{id}/");
        let below = |path: &str| path.strip_prefix(&prefix).map_or_else(|| path.to_owned(), str::to_owned);
        let listing = folder::list(&top, &Limits::SNAPSHOT)?;
        let sizes: Vec<(&str, u64)> =
            listing.entries.iter().map(|entry| (entry.path.as_str(), entry.size)).collect();
        let mut problems = proof.check(id, root, |path| {
            let path = below(path);
            match sizes.iter().any(|(known, _)| *known == path) {
                true => folder::read(&top, &path, Limits::SNAPSHOT.file_bytes).map(|b| Some(Digest::of(&b))),
                false => Ok(None),
            }
        })?;
        let proved: BTreeSet<String> = proof.files.iter().map(|file| below(&file.path)).collect();
        problems.extend(listing.problems.iter().map(ToString::to_string));
        if proof.item == id && proof.files.iter().any(|file| file.path != id) {
            let extra = sizes.iter().filter(|(path, _)| !proved.contains(*path));
            problems.extend(extra.map(|(path, _)| format!("{path}: extra (not in the proof)")));
        }
        return Ok(problems);
    }
    if !found.is_file() {
        return Err(SnapshotError::ReleaseKind { path: place.to_path_buf(), expected: "file" });
    }
    let limit = Limits::SNAPSHOT.file_bytes;
    if found.len() > limit {
        return Err(SnapshotError::TooLarge { path: place.to_path_buf(), limit });
    }
    let content = fs::read(place).map_err(|source| io("read", place, source))?;
    // A single file can match only one of the item's files.
    proof.check(id, root, |path| Ok((path == id).then(|| Digest::of(&content))))
}

/// Reads a proof, up to its maximum size.
fn read(file: &Path) -> Result<Vec<u8>, Failure> {
    let io = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => malformed!("`{}` does not exist", file.in_message()),
        _ => Failure::environment(error, format_args!("cannot read `{}`", file.in_message())),
    };
    if !fs::metadata(file).map_err(io)?.is_file() {
        bail!("`{}` is not a file", file.in_message());
    }
    disk::read_start(file, MAX_PROOF + 1).map_err(io)
}
