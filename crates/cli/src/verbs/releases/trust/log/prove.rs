//! `arcade trust log prove`: writes a small file that proves a fact about a log to people who do not have the
//! log.

use super::{checkpoint, open};
use crate::console::Console;
use crate::failure::Answer;
use crate::whole_file;
use base::MessagePath;
use serde_json::json;
use std::path::{Path, PathBuf};
use trust::log::Entry;

/// Writes a proof that an entry is in a log, or that the log has only been appended to since a checkpoint.
///
/// The proof of an entry is in the C2SP tlog-proof format. `arcade trust log check` checks either proof without the
/// log.
///
/// Example: arcade trust log prove log --release 2027-01 --out 2027-01.proof --write-entry 2027-01.entry
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log's folder
    #[arg(value_name = "LOG")]
    log: PathBuf,
    /// The number of the entry
    #[arg(long, value_name = "N", required_unless_present_any = ["release", "since"])]
    entry: Option<u64>,
    /// The name of a release, for the entry of its root
    #[arg(long, value_name = "NAME", conflicts_with = "entry")]
    release: Option<String>,
    /// An earlier checkpoint, for the proof of growth
    #[arg(long, value_name = "FILE", conflicts_with_all = ["entry", "release", "write_entry"])]
    since: Option<PathBuf>,
    /// The file to write the proof to
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// The file to write the entry to
    #[arg(long, value_name = "FILE")]
    write_entry: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let log = open(&args.log)?;
    let size = log.checkpoint.size;
    let out = args.out.in_message().to_string();
    let inputs: Vec<&Path> = [&args.log].into_iter().chain(&args.since).map(PathBuf::as_path).collect();
    for file in [&args.out].into_iter().chain(&args.write_entry) {
        whole_file::check(file, &inputs)?;
    }
    if args.write_entry.as_ref() == Some(&args.out) {
        bail!("--out and --write-entry specify the same file, `{out}`; use two files");
    }
    if let Some(file) = &args.since {
        let seen = checkpoint(file)?;
        if let Some(fault) = log.fork(&seen) {
            bail!("the proof cannot be written: {fault}");
        }
        let Some(proof) = log.prove_growth(seen.size) else {
            bail!("every log extends an empty log, so there is nothing to prove")
        };
        whole_file::write(&args.out, proof.to_text().as_bytes())?;
        console.document(&json!({ "out": out, "old": seen.size, "size": size }))?;
        console.say(format_args!("proof of growth from {} to {size} entries written to {out}", seen.size));
        return Ok(true);
    }
    let number = match (&args.release, args.entry) {
        (Some(name), _) => {
            let is_it = |entry: &Entry| matches!(entry, Entry::Root { release, .. } if release == name);
            let Some(number) = log.entries()?.iter().position(is_it) else {
                bail!("`{name}` is not in the log")
            };
            number as u64
        }
        (None, number) => number.unwrap_or_default(),
    };
    let (Some(proof), Some(entry)) = (log.prove(number), log.entry(number)) else {
        bail!("there is no entry {number}: the log has {size} entries, counted from 0");
    };
    whole_file::write(&args.out, proof.to_text().as_bytes())?;
    if let Some(file) = &args.write_entry {
        whole_file::write(file, entry)?;
    }
    console.document(&json!({ "out": out, "entry": number, "size": size }))?;
    console.say(format_args!("proof of entry {number} of {size} written to {out}"));
    Ok(true)
}
