//! `arcade regenerate`: checks that a snapshot's recipe reproduces it.

use crate::console::Console;
use crate::failure::Answer;
use crate::flags::threads;
use crate::input::embedded;
use crate::interrupt;
use crate::marks;
use crate::protected;
use crate::shell;
use crate::verbs::releases::release::{LONG, ProgressBars, corpus_with, forecast, forecast_words};
use base::MessagePath;
use base::count;
use serde_json::json;
use snapshots::mint::{JobFolder, JobStore, Memory, jobs_left, make_jobs};
use snapshots::{Compared, Draft, Manifest, Regenerated, Regeneration};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The default maximum number of forward-model calls per level.
const MAX_WORK: u64 = 1 << 28;

/// Mints a snapshot again from the recipe in its manifest and compares every byte.
///
/// If a folder contains only MANIFEST.json, only the manifest is compared, including the root in it.
///
/// Exit status 0: identical. 1: not identical, with every differing file listed. 2: this version of arcade cannot
/// mint it, or its manifest is damaged. 128 + signal, such as 130 for Ctrl-C: interrupted; --resume continues only
/// with --out.
///
/// Example: arcade regenerate releases/starter
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The snapshot's folder
    #[arg(value_name = "SNAPSHOT", value_parser = crate::paths::release_parser())]
    snapshot: PathBuf,
    /// Also write the new snapshot to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Resume an interrupted run with the same --out
    #[arg(long, requires = "out")]
    resume: bool,
    /// The folder of designs from which the snapshot was minted, if its recipe has the section [designs]
    #[arg(long, value_name = "DIR")]
    designs: Option<PathBuf>,
    /// Maximum number of forward-model calls that the recipe may allow for one level [default: 268435456,
    /// about ten times what the built-in recipes allow]
    #[arg(long, value_name = "CALLS", default_value_t = MAX_WORK, hide_default_value = true)]
    max_work: u64,
}

impl Args {
    /// Returns the command that resumes the run after an interruption.
    fn resumed(&self, out: &Path) -> String {
        let mut command: Vec<OsString> = vec!["regenerate".into(), self.snapshot.as_os_str().to_owned()];
        command.extend(["--out".into(), out.as_os_str().to_owned()]);
        if let Some(designs) = &self.designs {
            command.extend(["--designs".into(), designs.as_os_str().to_owned()]);
        }
        command.extend(threads::flags());
        command.push("--resume".into());
        shell::command(command)
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    args.out.as_deref().map_or(Ok(()), protected::check)?;
    let corpus = corpus_with(args.designs.as_deref())?;
    let release = Regeneration::of(&args.snapshot)?;
    if let (true, Some(out)) = (args.resume, &args.out)
        && let Some((manifest, compared)) = release.compare_complete(out)?
    {
        return answer(args, &Answered { manifest: &manifest, compared: &compared, minted: false }, console);
    }
    let calls = release.calls_per_level();
    if calls > args.max_work {
        let place = args.snapshot.in_message();
        console.document(&json!({ "identical": false, "differences": [], "exceeded": calls }))?;
        console.say(format_args!(
            "{place}: NOT regenerated: its recipe allows {calls} forward-model calls for one level, but \
             --max-work is {}; raise it if you trust the recipe",
            args.max_work
        ));
        return Ok(false);
    }
    let plan = release.plan(&corpus)?.with_players(&marks::Players)?;
    let open = if args.resume { Draft::resume } else { Draft::create };
    let draft = args.out.as_deref().map(open).transpose()?;
    let store: Box<dyn JobStore> = match &draft {
        Some(draft) => {
            let digest = plan.digest()?;
            Box::new(JobFolder::open(&draft.jobs(), digest)?)
        }
        None => Box::new(Memory::default()),
    };
    let (hint, told) = match &args.out {
        Some(out) => {
            let resumed = args.resumed(out);
            (
                format!("interrupted; continue with: {resumed}"),
                format!("if interrupted, continue with: {resumed}"),
            )
        }
        None => (
            "interrupted; nothing is kept without --out".to_owned(),
            "if interrupted, this must start over: --resume requires --out".to_owned(),
        ),
    };
    interrupt::watch(|| (), hint);
    let left = jobs_left(&plan, plan.jobs(), &*store)?;
    let (cost, _) = forecast(&plan, &left, &corpus);
    if cost.median >= LONG {
        console.remark(told);
    }
    console.remark(format_args!("minting it again takes {}", forecast_words(cost)));
    let bars = ProgressBars::new(console);
    make_jobs(&plan, plan.jobs(), &*store, &bars)?;
    let mut also = |path: &str, content: &[u8]| match &draft {
        Some(draft) => draft.write(path, content),
        None => Ok(()),
    };
    let regenerated = release.compare(&plan, &*store, embedded::lockfile(), &mut also)?;
    bars.clear();
    interrupt::defer();
    let Regenerated { minted, compared } = regenerated;
    if let Some(draft) = draft {
        minted.publish(draft, str::to_owned)?;
    }
    answer(args, &Answered { manifest: &minted.manifest, compared: &compared, minted: true }, console)
}

/// A regenerated release, compared with the original.
struct Answered<'a> {
    manifest: &'a Manifest,
    compared: &'a Compared,
    /// `false` if the new snapshot was already written by an earlier run.
    minted: bool,
}

fn answer(args: &Args, Answered { manifest, compared, minted }: &Answered<'_>, console: &Console) -> Answer {
    let Compared { differences, has_files, other_lockfile, .. } = compared;
    let (root, identical) = (manifest.root, differences.is_empty());
    let out = args.out.as_ref().map(|out| out.in_message().to_string());
    let mut document = json!({ "identical": identical, "differences": differences, "root": root, "files_compared": has_files });
    if let Some(out) = &out {
        document["out"] = json!(out);
        document["complete"] = json!(!minted);
    }
    console.document(&document)?;
    if let (false, Some(out)) = (minted, &out) {
        console.say(format_args!("already complete: {out}; nothing was minted"));
    }
    for difference in differences {
        console.say(difference);
    }
    if *other_lockfile {
        console.remark(
            "note: minted with a different Cargo.lock than the original; only its digest in the manifest \
             differs",
        );
    }
    let files = count(manifest.files().count(), "file");
    match (identical, has_files) {
        (true, true) => console.say(format_args!("identical: the manifest and {files}, root {root}")),
        (true, false) => console.say(format_args!(
            "{} has no files to compare with; the root of the regenerated release is {root}, the same as the \
             manifest's",
            args.snapshot.in_message()
        )),
        (false, _) => console.say(format_args!("NOT identical; files that differ: {}", differences.len())),
    }
    if let (true, Some(out)) = (minted, &out) {
        console.say(format_args!("the regenerated release is in {out}"));
    }
    Ok(identical)
}
