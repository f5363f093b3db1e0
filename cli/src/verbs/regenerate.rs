//! `arcade regenerate`: a check that the recipe reproduces a snapshot.

use crate::console::Console;
use crate::counted::count;
use crate::embedded;
use crate::failure::Answer;
use crate::interrupt;
use crate::protected;
use crate::shell;
use crate::verbs::release::{ProgressBars, commit, in_pool};
use serde_json::json;
use snapshots::mint::{JobFolder, JobStore, Memory, make_jobs};
use snapshots::{Draft, Regeneration};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Mints a snapshot again from the recipe in its manifest and compares every byte.
///
/// Exit status 0: identical. 1: not identical, with every differing file named. 2: this arcade cannot mint it.
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
    /// Resume an interrupted run with the same --out
    #[arg(long, requires = "out")]
    resume: bool,
    /// Threads; all cores if not given
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

impl Args {
    /// Returns the command that resumes after an interruption.
    fn resumed(&self, out: &Path) -> String {
        let [verb, to, resume] = ["regenerate", "--out", "--resume"].map(OsStr::new);
        shell::command([verb, self.snapshot.as_os_str(), to, out.as_os_str(), resume])
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    args.out.as_deref().map_or(Ok(()), protected::check)?;
    let corpus = embedded::corpus()?;
    let release = Regeneration::of(&args.snapshot)?;
    let plan = release.plan(&corpus)?;
    let open = if args.resume { Draft::resume } else { Draft::create };
    let draft = args.out.as_deref().map(open).transpose()?;
    let store: Box<dyn JobStore> = match &draft {
        Some(draft) => {
            let digest = plan.digest()?;
            Box::new(JobFolder::open(&draft.jobs(), digest)?)
        }
        None => Box::new(Memory::default()),
    };
    if let Some(out) = &args.out {
        interrupt::watch(|| (), format!("interrupted; continue with: {}", args.resumed(out)));
    }
    let bars = ProgressBars::new(console);
    let result = in_pool(args.jobs, || {
        make_jobs(&plan, plan.jobs(), &*store, &bars)?;
        let mut also = |path: &str, content: &[u8]| match &draft {
            Some(draft) => draft.write(path, content),
            None => Ok(()),
        };
        release.compare(&plan, &*store, embedded::lockfile(), &mut also)
    })??;
    bars.finish();
    interrupt::defer();
    if let Some(draft) = draft {
        commit(draft, &result.minted, str::to_owned)?;
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
            "identical: the manifest and {}, root {root}",
            count(result.minted.manifest.items.len(), "file")
        )),
        false => console.say(format_args!("NOT identical; files that differ: {}", result.differences.len())),
    }
    Ok(identical)
}
