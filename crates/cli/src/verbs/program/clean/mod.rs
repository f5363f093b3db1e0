//! `arcade clean`: removes files left behind by interrupted runs.

mod leftover;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::text::sorted_entries;
use crate::paths;
use base::MessagePath;
use leftover::{Leftover, LeftoverKind};
use serde_json::json;
use snapshots::MANIFEST_FILE;
use std::fs;
use std::path::{Path, PathBuf};

/// Removes files that killed runs left behind: unfinished `.partial` folders and files, and the scratch folders of
/// players.
///
/// Searches the folders and all their subfolders, and the system's temporary folder for players' scratch folders. It
/// removes only files that were certainly made by arcade and that no running process uses; it never follows links.
/// Interrupted runs with finished jobs, which --resume continues, and shards, which `arcade merge` joins, are listed,
/// and removed only on request.
///
/// Example: arcade clean releases --dry-run
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folders to search [default: the current folder]
    #[arg(value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Print what would be removed without removing anything
    #[arg(long)]
    dry_run: bool,
    /// Also remove interrupted runs that --resume could continue
    #[arg(long)]
    interrupted: bool,
    /// Also remove shards
    #[arg(long)]
    shards: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let here = [PathBuf::from(".")];
    let folders = if args.folders.is_empty() { &here } else { args.folders.as_slice() };
    let mut found = Vec::new();
    for folder in folders {
        if !paths::metadata(folder)?.is_some_and(|found| found.is_dir()) {
            bail!("{}: there is no such folder; check the path", folder.in_message());
        }
        search(folder, console, &mut found)?;
    }
    found.extend(leftover::scratch());
    let (mut entries, mut removed, mut freed) = (Vec::new(), 0_usize, 0);
    for leftover in found {
        let (path, bytes, (kind, what)) = (leftover.path.clone(), leftover.bytes(), leftover.described());
        let kept = kept(args, &leftover.kind);
        if kept.is_none() {
            if !args.dry_run {
                leftover.remove()?;
            }
            removed += 1;
            freed += bytes;
        }
        let verb = match (&kept, args.dry_run) {
            (Some(_), _) => "kept",
            (None, true) => "would remove",
            (None, false) => "removed",
        };
        let why = kept.map_or(String::new(), |why| format!("; {why}"));
        console.say(format_args!("{verb} {}: {what}, {}{why}", path.in_message(), size(bytes)));
        entries.push(json!({
            "path": paths::in_json(&path),
            "kind": kind,
            "bytes": bytes,
            "removed": kept.is_none() && !args.dry_run,
            "kept": kept,
        }));
    }
    console.document(&json!({ "dry_run": args.dry_run, "found": entries, "bytes": freed }))?;
    let verb = if args.dry_run { "would be removed" } else { "removed" };
    match entries.len() {
        0 => console.say("nothing to remove"),
        all => console.say(format_args!("{removed} of {all} {verb}, {}", size(freed))),
    }
    Ok(true)
}

/// Returns the reason for keeping a leftover, with advice, or `None` if it will be removed.
fn kept(args: &Args, kind: &LeftoverKind) -> Option<&'static str> {
    match kind {
        LeftoverKind::Draft(draft) if draft.finished_jobs > 0 && !args.interrupted => Some(
            "continue it with the same command and --resume, or remove it with `arcade clean --interrupted`",
        ),
        LeftoverKind::Shard(_) if !args.shards => {
            Some("join shards with `arcade merge`, or remove them with `arcade clean --shards`")
        }
        _ => None,
    }
}

/// Adds the leftovers in the folder and in all its subfolders.
fn search(folder: &Path, console: &Console, found: &mut Vec<Leftover>) -> Result<(), Failure> {
    let mut waiting = vec![folder.to_path_buf()];
    while let Some(folder) = waiting.pop() {
        if fs::symlink_metadata(folder.join(MANIFEST_FILE)).is_ok() {
            // A release is complete, so it contains no leftovers.
            continue;
        }
        let entries = match sorted_entries(&folder) {
            Ok(entries) => entries,
            Err(failure) => {
                console.remark(format_args!("skipped: {failure}"));
                continue;
            }
        };
        for path in entries.into_iter().rev() {
            match Leftover::at(&path)? {
                Some(leftover) => found.push(leftover),
                None if fs::symlink_metadata(&path).is_ok_and(|found| found.is_dir()) => waiting.push(path),
                None => {}
            }
        }
    }
    Ok(())
}

fn size(bytes: u64) -> String {
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..1_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", bytes as f64 / 1e6),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}
