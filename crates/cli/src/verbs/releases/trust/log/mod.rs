//! `arcade trust log`: maintains a public, append-only log.

mod append;
mod check;
mod cosign;
mod prove;
mod row;
mod show;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use base::Digest;
use base::MessagePath;
use snapshots::Secret;
use std::path::Path;
use trust::log::{Checkpoint, Entry, Log, MAX_CHECKPOINT, Revealed, problems};
use trust::{Anchor, PublicKey, read_bounded};

/// Keeps a public log of commitments, roots, reveals and results, from which nothing can be removed unnoticed.
///
/// A log is a folder of files that any web server can serve, in the C2SP tlog-tiles format; its states are signed.
/// See `arcade docs trust`.
///
/// Examples: arcade trust log append log --origin example.org/arcade --secret log.key --release releases/2027-01,
/// arcade trust log check log --key log.pub --seen checkpoint.old --release releases/2027-01
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    Append(Box<append::Args>),
    Show(show::Args),
    Prove(Box<prove::Args>),
    Check(Box<check::Args>),
    Cosign(Box<cosign::Args>),
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    match &args.what {
        What::Append(args) => append::run(args, console),
        What::Show(args) => show::run(args, console),
        What::Prove(args) => prove::run(args, console),
        What::Check(args) => check::run(args, console),
        What::Cosign(args) => cosign::run(args, console),
    }
}

/// Reads the log in a folder.
fn open(folder: &Path) -> Result<Log, Failure> {
    Log::open(folder)?.ok_or_else(|| absent(folder))
}

/// Formats the number of entries in a log for people.
fn counted(size: u64) -> String {
    if size == 1 { "1 entry".to_owned() } else { format!("{size} entries") }
}

/// Formats an entry as one human-readable line. Commitments and roots are shown with their parent release.
fn line(entry: &Entry, all: &[Entry]) -> String {
    let (Entry::Commitment { parent, .. } | Entry::Root { parent, .. }) = entry else { return entry.line() };
    let named = |parent: &Digest| {
        let name = all.iter().find_map(|entry| match entry {
            Entry::Root { release, root, .. } if root == parent => Some(release),
            _ => None,
        });
        name.map_or_else(|| format!("after the root {}", parent.short()), |name| format!("after `{name}`"))
    };
    format!("{}, {}", entry.line(), parent.as_ref().map_or_else(|| "after no release".to_owned(), named))
}

/// Returns the failure for a folder that contains no log.
fn absent(folder: &Path) -> Failure {
    malformed!(
        "`{}` does not contain a log, because it has no `checkpoint` file: pass a log's folder",
        folder.in_message()
    )
}

/// Reads a public key.
fn public_key(file: &Path) -> Result<PublicKey, Failure> {
    match crate::input::trusted::anchor(file)? {
        Anchor::Key(key) => Ok(key),
        Anchor::Set(_) => {
            Err(malformed!("`{}` is a set of keys: a log is signed by one key, NAME.pub", file.in_message()))
        }
    }
}

/// Reads a log's checkpoint.
fn checkpoint(file: &Path) -> Result<Checkpoint, Failure> {
    let text = read_text(file, MAX_CHECKPOINT)?;
    Ok(Checkpoint::parse(&text, &file.in_message().to_string())?)
}

fn read_text(file: &Path, limit: u64) -> Result<String, Failure> {
    Ok(String::from_utf8_lossy(&read_bounded(file, limit)?).into_owned())
}

/// Returns the contradictions among a log's entries.
fn rules(entries: &[Entry]) -> Vec<String> {
    problems(entries, &commitment_of)
}

/// Computes the commitment to a revealed secret in the same way as for releases.
fn commitment_of(revealed: &Revealed) -> Digest {
    let Revealed { release, seed, nonce, recipe, .. } = revealed.clone();
    Secret { name: release, seed, nonce, recipe: Some(recipe) }.commitment()
}
