//! `arcade verify`: is this snapshot what it claims to be?

mod item;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use engine::Digest;
use serde::Serialize;
use serde_json::json;
use snapshots::chain::{Chain, Link, follow};
use snapshots::{MANIFEST_FILE, SnapshotError, Verification, Witnesses, verify};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Checks a snapshot: paths, sizes, digests, root; then parses every game and level and replays every witness.
///
/// With --chain, follows the roots back through the releases before it. With --item and --write-proof, writes a small
/// file that proves one file or one game; with --item, --proof and --root, checks such a proof against the file or the
/// game's folder alone.
///
/// Exit status 0: sound. 1: not, with every problem named. 2: not a snapshot.
///
/// Example: arcade verify releases/starter
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The snapshot's folder or .tar.zst; with --proof, the item's file or the game's folder
    #[arg(value_name = "SNAPSHOT")]
    snapshot: PathBuf,
    /// Snapshots, or folders of snapshots, among which those before this one are looked for
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with = "proof")]
    chain: Vec<PathBuf>,
    /// A file of the snapshot, such as games/x/lvl0.txt, or a game's folder name for all of its files
    #[arg(long, value_name = "ID")]
    item: Option<String>,
    /// Writes the proof that the item is in the snapshot
    #[arg(long, value_name = "FILE", requires = "item", conflicts_with = "proof")]
    write_proof: Option<PathBuf>,
    /// Checks this proof for the item, without the rest of the snapshot
    #[arg(long, value_name = "FILE", requires = "item", requires = "root")]
    proof: Option<PathBuf>,
    /// The root that was published, to compare with
    #[arg(long, value_name = "DIGEST")]
    root: Option<Digest>,
}

/// The answer for programs.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    verification: &'a Verification,
    #[serde(skip_serializing_if = "Option::is_none")]
    chain: Option<&'a Chain>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if let (Some(id), Some(proof), Some(root)) = (&args.item, &args.proof, &args.root) {
        return item::check(&args.snapshot, id, proof, root, console);
    }
    if args.item.is_some() && args.write_proof.is_none() {
        return Err(Failure::malformed(
            "--item needs --write-proof FILE, to write its proof, or --proof FILE and --root DIGEST, to check one",
        ));
    }
    let mut verification = match verify(&args.snapshot) {
        Ok(verification) => verification,
        Err(error) => match damage(&error) {
            true => return damaged(error, &args.snapshot, console),
            false => return Err(failure(error)),
        },
    };
    if let Some(root) = args.root.filter(|root| *root != verification.root) {
        let problem = format!("{MANIFEST_FILE}: the root is {}, not {root}", verification.root);
        verification.problems.push(problem);
    }
    let chain = match args.chain.as_slice() {
        [] => None,
        folders => Some(follow(Link::of(&verification.manifest, &args.snapshot), folders).map_err(failure)?),
    };
    let broken = chain.as_ref().map_or(0, |chain| chain.problems.len());
    let sound = verification.problems.is_empty() && broken == 0;
    let written = match (&args.write_proof, &args.item) {
        (Some(file), Some(id)) if sound => Some(item::write(&verification.manifest, id, file)?),
        _ => None,
    };
    console.document(&Document { verification: &verification, chain: chain.as_ref() })?;
    say(&verification, console);
    if let Some(chain) = &chain {
        say_chain(chain, console);
    }
    if let Some(written) = written {
        console.say(written);
    } else if args.write_proof.is_some() {
        console.say("no proof was written");
    }
    Ok(sound)
}

fn say(verification: &Verification, console: &Console) {
    let Verification { name, root, files, games, levels, witnesses, papers, ignored, problems, .. } =
        verification;
    for problem in problems {
        console.say(one_line(problem));
    }
    if !problems.is_empty() {
        return console.say(format_args!("{name}: does NOT verify; problems: {}", problems.len()));
    }
    match witnesses {
        Witnesses::Replayed(count) => console.say(format_args!(
            "{name}: verified; the manifest and {files} files, {games} games, {levels} levels, {count} witnesses \
             replayed to a win"
        )),
        Witnesses::Held => console.say(format_args!(
            "{name}: verified; the manifest and {files} files, {games} games, {levels} levels, witnesses held back until \
             the release is revealed"
        )),
        Witnesses::NotReplayed { semantics } => {
            console.say(format_args!("{name}: the manifest and {files} files, {games} games, {levels} levels"));
            console.say(format_args!(
                "integrity: ok, witnesses: not replayed (needs an arcade of semantics {semantics}; this one has {})",
                engine::SEMANTICS
            ));
        }
    }
    console.say(format_args!("root {root}"));
    if *papers > 0 {
        console.say(format_args!("papers: {papers} files, not covered by the root"));
    }
    if !ignored.is_empty() {
        console.say(format_args!("ignored: {}", ignored.join(", ")));
    }
}

fn say_chain(chain: &Chain, console: &Console) {
    for problem in &chain.problems {
        console.say(one_line(problem));
    }
    let [newest, before @ ..] = chain.releases.as_slice() else { return };
    console.say(match (chain.problems.is_empty(), before.len()) {
        (false, _) => format!("chain: NOT sound; problems: {}", chain.problems.len()),
        (true, 0) => format!("chain: `{}` is the first release", newest.name),
        (true, count) => format!("chain: sound; `{}` and {count} before it, back to the first", newest.name),
    });
    let width = chain.releases.iter().map(|link| link.name.len()).max().unwrap_or(0);
    for Link { name, root, place, .. } in &chain.releases {
        console.say(format_args!("  {name:<width$}  {root}  {}", place.display()));
    }
    if chain.others > 0 {
        console.say(format_args!("  not of this chain: {} more that were given", chain.others));
    }
}

/// Whether there is a manifest or an archive, and it is damaged: that is an answer.
fn damage(error: &SnapshotError) -> bool {
    matches!(
        error,
        SnapshotError::Syntax { .. }
            | SnapshotError::Manifest { .. }
            | SnapshotError::Archive { .. }
            | SnapshotError::Link { .. }
            | SnapshotError::Kind { .. }
            | SnapshotError::TooLarge { .. }
    )
}

fn damaged(error: SnapshotError, snapshot: &Path, console: &Console) -> Answer {
    let place = if matches!(error, SnapshotError::Archive { .. }) { "" } else { "MANIFEST.json: " };
    let problem = format!("{place}{:#}", anyhow::Error::from(error));
    console.document(&json!({ "problems": [problem] }))?;
    console.say(one_line(&problem));
    console.say(format_args!("{}: does NOT verify", snapshot.display()));
    Ok(false)
}

/// A problem may quote what a stranger wrote, which must not look like a line of our own.
fn one_line(problem: &str) -> String {
    problem.replace('\n', "\\n")
}

/// A folder that is no snapshot, or is not there, is a malformed question; a disk that fails is not.
pub(crate) fn failure(error: SnapshotError) -> Failure {
    match error {
        SnapshotError::Io { action: "examine" | "list" | "open" | "read", ref path, ref source }
            if matches!(source.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
        {
            absent(path)
        }
        SnapshotError::Io { .. } => Failure::Surroundings(error.into()),
        _ => Failure::Malformed(error.into()),
    }
}

fn absent(path: &Path) -> Failure {
    let shown = path.display();
    Failure::malformed(match path.exists() {
        true => format!("`{shown}` is not a folder: name one; an archive is unpacked first, as with tar -xf"),
        false => format!("`{shown}` does not exist: check the path"),
    })
}
