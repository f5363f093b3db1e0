//! `arcade verify`: is this snapshot what it claims to be?

use crate::console::Console;
use crate::failure::{Answer, Failure};
use serde_json::json;
use snapshots::{MANIFEST_FILE, SnapshotError, Verification, Witnesses, verify};
use std::path::PathBuf;

/// Checks a snapshot: paths, sizes, digests, root; then parses every game and level and replays every witness.
///
/// Exit status 0: sound. 1: not, with every problem named. 2: not a snapshot.
///
/// Example: arcade verify releases/starter
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The snapshot's folder
    #[arg(value_name = "SNAPSHOT")]
    snapshot: PathBuf,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let verification = match verify(&args.snapshot) {
        Ok(verification) => verification,
        // There is a manifest, and it is damaged: that is an answer.
        Err(error @ (SnapshotError::Syntax { .. } | SnapshotError::Manifest { .. })) => {
            let problem = format!("{MANIFEST_FILE}: {:#}", anyhow::Error::from(error));
            console.document(&json!({ "problems": [problem] }))?;
            console.say(&problem);
            console.say(format_args!("{}: does NOT verify", args.snapshot.display()));
            return Ok(false);
        }
        Err(error) => return Err(failure(error)),
    };
    let Verification { name, root, files, games, levels, witnesses, problems } = &verification;
    console.document(&verification)?;
    for problem in problems {
        console.say(problem);
    }
    if !problems.is_empty() {
        console.say(format_args!("{name}: does NOT verify; problems: {}", problems.len()));
        return Ok(false);
    }
    let replays = match witnesses {
        Witnesses::Replayed(count) => format!("{count} witnesses replayed to a win"),
        Witnesses::NotReplayed { semantics } => {
            format!("integrity: ok, witnesses: not replayed (needs an arcade of semantics {semantics})")
        }
    };
    console.say(format_args!(
        "{name}: verified; the manifest and {files} files, {games} games, {levels} levels, {replays}"
    ));
    console.say(format_args!("root {root}"));
    Ok(true)
}

/// A folder that is no snapshot is a malformed question; a disk that fails is not.
pub(crate) fn failure(error: SnapshotError) -> Failure {
    match error {
        SnapshotError::Io { .. } => Failure::Surroundings(error.into()),
        _ => Failure::Malformed(error.into()),
    }
}
