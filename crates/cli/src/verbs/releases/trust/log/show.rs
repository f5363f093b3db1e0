//! `arcade trust log show`: lists a log's entries without checking them.

use super::{counted, line, open};
use crate::console::Console;
use crate::failure::Answer;
use serde_json::json;
use std::path::PathBuf;

/// Lists the entries of a log without checking them. `arcade trust log check` checks a log with its public key.
///
/// Example: arcade trust log show log
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log's folder
    #[arg(value_name = "LOG")]
    log: PathBuf,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let log = open(&args.log)?;
    let entries = log.entries()?;
    let (origin, size) = (&log.checkpoint.origin, log.checkpoint.size);
    console.document(&json!({ "origin": origin, "size": size, "entries": entries }))?;
    for (number, entry) in entries.iter().enumerate() {
        console.say(format_args!("{number:>5}  {}", line(entry, &entries)));
    }
    console.say(format_args!("{origin}: {}, not checked", counted(size)));
    Ok(true)
}
