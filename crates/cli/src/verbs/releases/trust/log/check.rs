//! `arcade trust log check`: checks a log, or a log proof.

use super::{absent, append, checkpoint, counted, line, public_key, read_text, row, rules};
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::whole_file;
use base::MessagePath;
use serde_json::json;
use snapshots::Manifest;
use std::path::{Path, PathBuf};
use trust::log::{Consistency, Entry, Inclusion, Log, MAX_CHECKPOINT, MAX_ENTRY, frozen, is_month, unkept};
use trust::{PublicKey, TrustError, read_bounded};

/// Checks a log: its signature, its root, its files, and the consistency of its entries.
///
/// Keep the checkpoint of each visit (--save) and pass it at the next (--seen). Only this reveals a log that was rolled back, or
/// that shows others a different history. --month reveals a copy that is no longer updated. With --proof and --entry, or --growth
/// and --seen, a proof is checked without the log.
///
/// Exit status 0: sound. 1: not sound, with every reason listed. 2: malformed input.
///
/// Example: arcade trust log check log --key log.pub --seen log.seen --save log.seen --month 2027-03
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log's folder; not allowed with --proof or --growth
    #[arg(value_name = "LOG", required_unless_present_any = ["proof", "growth"], conflicts_with_all = ["proof", "growth"])]
    log: Option<PathBuf>,
    /// The public key of the log
    #[arg(long, value_name = "FILE")]
    key: PathBuf,
    /// An earlier checkpoint that the log must extend
    #[arg(long, value_name = "FILE")]
    seen: Option<PathBuf>,
    /// Write the checkpoint here if the log is sound
    #[arg(long, value_name = "FILE", conflicts_with_all = ["proof", "growth"])]
    save: Option<PathBuf>,
    /// The month whose release must be in the log by now, such as 2027-03
    #[arg(long, value_name = "MONTH", value_parser = month, conflicts_with_all = ["proof", "growth"])]
    month: Option<String>,
    /// Releases that must be in the log, as folders or archives
    #[arg(long, value_name = "SNAPSHOT", num_args = 1.., conflicts_with_all = ["proof", "growth"], value_parser = crate::paths::release_parser())]
    release: Vec<PathBuf>,
    /// Results folders whose rows must be in the log; every episode is replayed, and its games are compared with those of the
    /// --release
    #[arg(long, value_name = "RESULTS", num_args = 1.., conflicts_with_all = ["proof", "growth"])]
    replay: Vec<PathBuf>,
    /// Witnesses that must have signed the checkpoint, each with its public key
    #[arg(long, value_name = "NAME=FILE", num_args = 1.., conflicts_with_all = ["proof", "growth"])]
    witness: Vec<String>,
    /// A proof that an entry is in the log
    #[arg(long, value_name = "FILE", requires = "entry", conflicts_with = "growth")]
    proof: Option<PathBuf>,
    /// The entry that the proof is about
    #[arg(long, value_name = "FILE", requires = "proof")]
    entry: Option<PathBuf>,
    /// A proof that the log has only been appended to since the checkpoint in --seen
    #[arg(long, value_name = "FILE", requires = "seen")]
    growth: Option<PathBuf>,
}

/// Parses a month's name as given by the user.
fn month(text: &str) -> Result<String, String> {
    match is_month(text) {
        true => Ok(text.to_owned()),
        false => Err("not a month: write a year and a month, such as 2027-03".to_owned()),
    }
}

/// The maximum size of a proof, in bytes.
const MAX_PROOF: u64 = MAX_CHECKPOINT + (1 << 14);

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let key = public_key(&args.key)?;
    if let (Some(proof), Some(entry)) = (&args.proof, &args.entry) {
        return inclusion(proof, entry, &key, console);
    }
    if let (Some(growth), Some(seen)) = (&args.growth, &args.seen) {
        return consistency(growth, seen, &key, console);
    }
    let folder = args.log.as_deref().expect("the arguments require the log's folder");
    let log = match Log::open(folder) {
        // A log exists but is damaged, so this is an answer, not a failure.
        Err(error @ TrustError::Document { .. }) => return damaged(&error, console),
        Ok(None) => return Err(absent(folder)),
        log => log?.expect("the log exists"),
    };
    // The new checkpoint may replace the one seen last.
    if let Some(file) = &args.save {
        whole_file::check(file, &[folder, &args.key])?;
    }
    let mut problems = log.faults(&key);
    if let Some(file) = &args.seen {
        let seen = checkpoint(file)?;
        // A checkpoint that the log did not sign is no evidence against it.
        seen.check(&key).map_err(|fault| malformed!("`{}`: {fault}", file.in_message()))?;
        problems.extend(log.fork(&seen));
    }
    let entries = match log.entries() {
        Err(error @ TrustError::Document { .. }) if !problems.is_empty() => return damaged(&error, console),
        entries => entries?,
    };
    problems.extend(rules(&entries));
    let mut found = Vec::new();
    if let Some(month) = &args.month {
        match frozen(&entries, month) {
            Some(problem) => problems.push(problem),
            None => found.push(reached(&entries, month)),
        }
    }
    problems.extend(witnesses(&args.witness, &log)?);
    let mut releases = Vec::new();
    for place in &args.release {
        let manifest = append::sound(place)?;
        match missing(place, manifest.clone(), &entries)? {
            Some(problem) => problems.push(problem),
            None => found.extend(placed(place, &manifest, &entries)),
        }
        releases.push(manifest);
    }
    let mut notes = Vec::new();
    for folder in &args.replay {
        let replayed = replay(folder, &entries, &releases)?;
        problems.extend(replayed.problems);
        notes.extend(replayed.note);
    }
    let sound = problems.is_empty();
    let unkept = unkept(&entries);
    if let (Some(file), true) = (&args.save, sound) {
        whole_file::write(file, log.checkpoint.to_text().as_bytes())?;
    }
    let size = log.checkpoint.size;
    console.document(&json!({
        "origin": log.checkpoint.origin, "size": size, "entries": entries, "unkept": unkept, "found": found, "notes": notes,
        "problems": problems,
    }))?;
    for (number, entry) in entries.iter().enumerate() {
        console.say(format_args!("{number:>5}  {}", line(entry, &entries)));
    }
    for name in &unkept {
        console.say(format_args!("`{name}` has a commitment, but no root yet"));
    }
    found.iter().chain(&notes).chain(&problems).for_each(|line| console.say(line));
    let entries = counted(size);
    console.say(match sound {
        true => format!("{}: sound; {entries}, signed by {}", log.checkpoint.origin, key.id()),
        false => format!("{}: NOT sound; problems: {}", log.checkpoint.origin, problems.len()),
    });
    Ok(sound)
}

/// Reports an unreadable log.
fn damaged(error: &TrustError, console: &Console) -> Answer {
    console.document(&json!({ "problems": [error.to_string()] }))?;
    console.say(error);
    console.say("the log is NOT sound: files were changed, truncated or removed");
    Ok(false)
}

fn witnesses(asked: &[String], log: &Log) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for text in asked {
        let Some((name, file)) = text.split_once('=') else {
            bail!("`{text}` does not specify a witness's name and public key: write NAME=FILE");
        };
        if log.checkpoint.witnessed(name, &public_key(Path::new(file))?).is_none() {
            problems.push(format!("the witness `{name}` has not signed the checkpoint"));
        }
    }
    Ok(problems)
}

/// Returns a sentence about the month that the log has reached.
fn reached(entries: &[Entry], month: &str) -> String {
    match root_of(entries, month) {
        Some(number) => format!("the release of {month} is entry {number}"),
        None => format!("the log has a release of a later month, but no release of {month}"),
    }
}

/// Returns a sentence about a release's entry in the log.
fn placed(place: &Path, manifest: &Manifest, entries: &[Entry]) -> Option<String> {
    let number = root_of(entries, &manifest.name)?;
    Some(format!(
        "`{}`: `{}` is entry {number}, with the same root, parent, commitment and beacon",
        place.in_message(),
        manifest.name
    ))
}

/// Returns the index of the entry with the root of the named release; `None` if the log has no such entry.
fn root_of(entries: &[Entry], name: &str) -> Option<usize> {
    entries.iter().position(|entry| matches!(entry, Entry::Root { release, .. } if release == name))
}

/// Returns the problem that the log lacks the given release.
fn missing(place: &Path, manifest: Manifest, entries: &[Entry]) -> Result<Option<String>, Failure> {
    let shown = place.in_message();
    let asked = append::release(manifest, place)?;
    let Entry::Root { release, root, parent, commitment, beacon, .. } = &asked else { return Ok(None) };
    let found =
        entries.iter().find(|entry| matches!(entry, Entry::Root { release: name, .. } if name == release));
    let fault = match found {
        None => Some(format!("`{shown}`: `{release}` with root {root} is not in the log")),
        Some(Entry::Root { root: logged, .. }) if logged != root => Some(format!(
            "`{shown}` has the root {root}, but the log has `{release}` with root {logged}: two releases \
             have the same name"
        )),
        Some(Entry::Root { parent: a, commitment: b, beacon: c, .. })
            if (a, b, c) != (parent, commitment, beacon) =>
        {
            Some(format!(
                "`{shown}`: the log records a different parent, commitment or beacon than its manifest"
            ))
        }
        Some(_) => None,
    };
    Ok(fault)
}

/// The result of checking a leaderboard row.
#[derive(Default)]
struct Replayed {
    problems: Vec<String>,
    /// A note about a comparison that was omitted.
    note: Option<String>,
}

/// Returns the differences between a row in the log and the same row recomputed from the episodes, which are
/// replayed on the release's games.
fn replay(folder: &Path, entries: &[Entry], releases: &[Manifest]) -> Result<Replayed, Failure> {
    let shown = folder.in_message();
    let only = |problem: String| Ok(Replayed { problems: vec![format!("`{shown}`: {problem}")], note: None });
    let digest = row::digest(folder)?;
    let logged = entries.iter().find_map(|entry| match entry {
        Entry::Result(row) if row.results == digest => Some(row),
        _ => None,
    });
    let Some(logged) = logged else {
        return only(format!(
            "no row in the log has the digest of these results, {digest}: the results were altered later, \
             or never appended"
        ));
    };
    // If an episode does not replay, the row is wrong. This is an answer, not a failure.
    let again = match row::of(folder, entries) {
        Ok(again) => again,
        Err(Failure::Malformed(error)) => return only(format!("{error:#}")),
        Err(failure) => return Err(failure),
    };
    let mut replayed = Replayed::default();
    replayed.problems.extend(logged.differences(&again).iter().map(|found| format!("`{shown}`: {found}")));
    match releases.iter().find(|manifest| manifest.root == again.root) {
        Some(manifest) => replayed.problems.extend(row::not_of(manifest, folder)?),
        None => {
            replayed.note = Some(format!(
                "`{shown}`: its games were not compared with those of the release `{}`; pass that release \
                 as well, with --release",
                again.release
            ));
        }
    }
    Ok(replayed)
}

fn inclusion(proof: &Path, entry: &Path, key: &PublicKey, console: &Console) -> Answer {
    let found = Inclusion::parse(&read_text(proof, MAX_PROOF)?, &proof.in_message().to_string())?;
    let bytes = read_bounded(entry, MAX_ENTRY as u64)?;
    let problems = found.check(&bytes, key).err().unwrap_or_default();
    let (origin, index, size) = (&found.checkpoint.origin, found.index, found.checkpoint.size);
    console.document(&json!({ "origin": origin, "index": index, "size": size, "problems": problems }))?;
    problems.iter().for_each(|problem| console.say(problem));
    console.say(match problems.is_empty() {
        true => format!("{}: entry {index} of {size} in the log {origin}", entry.in_message()),
        false => format!("{}: NOT proven to be in the log {origin}", entry.in_message()),
    });
    Ok(problems.is_empty())
}

fn consistency(growth: &Path, seen: &Path, key: &PublicKey, console: &Console) -> Answer {
    let found = Consistency::parse(&read_text(growth, MAX_PROOF)?, &growth.in_message().to_string())?;
    let problems = found.check(&checkpoint(seen)?, key).err().unwrap_or_default();
    let (origin, old, size) = (&found.checkpoint.origin, found.old, found.checkpoint.size);
    console.document(&json!({ "origin": origin, "old": old, "size": size, "problems": problems }))?;
    problems.iter().for_each(|problem| console.say(problem));
    console.say(match problems.is_empty() {
        true => format!("{origin}: has grown from {old} to {size} entries, and no earlier entry was changed"),
        false => format!("{origin}: NOT proven to be append-only"),
    });
    Ok(problems.is_empty())
}
