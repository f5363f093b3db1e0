//! `arcade regenerate`: does the seed give these bytes?

use crate::console::Console;
use crate::embedded;
use crate::failure::{Answer, Failure};
use crate::verbs::release::{Bars, in_pool};
use crate::verbs::verify::failure;
use serde_json::json;
use snapshots::{Draft, MANIFEST_FILE, RegenerateError, regenerate};
use std::path::PathBuf;

/// Mints a snapshot again from the recipe in its manifest and compares every byte.
///
/// Exit status 0: identical. 1: not, with every differing file named. 2: this arcade cannot mint it.
///
/// Example: arcade regenerate releases/starter
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The snapshot's folder
    #[arg(value_name = "SNAPSHOT")]
    snapshot: PathBuf,
    /// Also write the new snapshot to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; all cores if not given
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let corpus = embedded::corpus()?;
    let bars = Bars::new(console);
    let draft = args.out.as_deref().map(Draft::create).transpose().map_err(failure)?;
    let minted = in_pool(args.jobs, || {
        let mut also = |path: &str, content: &[u8]| match &draft {
            Some(draft) => draft.write(path, content),
            None => Ok(()),
        };
        regenerate(&args.snapshot, &corpus, embedded::lockfile(), &bars, &mut also)
    })?;
    bars.finish();
    let result = minted.map_err(|error| match error {
        RegenerateError::Snapshot(error) => failure(error),
        other => Failure::Malformed(other.into()),
    })?;
    if let Some(draft) = draft {
        let manifest = result.minted.manifest.to_bytes().map_err(failure)?;
        draft.write(MANIFEST_FILE, &manifest).map_err(failure)?;
        draft.commit().map_err(failure)?;
    }
    let identical = result.differences.is_empty();
    let root = result.minted.manifest.root;
    console.document(&json!({ "identical": identical, "differences": result.differences, "root": root }))?;
    for difference in &result.differences {
        console.say(difference);
    }
    if result.other_lockfile {
        console.remark(
            "note: minted with another Cargo.lock than the original; only its digest in the manifest differs",
        );
    }
    match identical {
        true => console.say(format_args!(
            "identical: the manifest and {} files, root {root}",
            result.minted.manifest.items.len()
        )),
        false => console.say(format_args!("NOT identical: {} differences", result.differences.len())),
    }
    Ok(identical)
}
