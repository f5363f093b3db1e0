//! `arcade verify`: checks that a snapshot is what it claims to be.

mod item;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::trusted::{self, TrustArgs, digest};
use crate::protected;
use base::Digest;
use base::MessagePath;
use base::count;
use serde::Serialize;
use serde_json::json;
use snapshots::chain::{Chain, Link, follow};
use snapshots::mint::SHARD_FILE;
use snapshots::{Bounds, MANIFEST_FILE, Manifest, SnapshotError, Verification, Witnesses, verify_within};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use trust::Signed;

/// Checks a snapshot: paths, sizes, digests, root; then parses every game and level and replays every witness.
///
/// Without --root, this shows only that the snapshot is internally consistent; only the published root shows that it
/// is the published one. If the witnesses need a version of arcade with different semantics, they cannot be replayed
/// here, and the answer is no unless --accept-unreplayed is given. Replays may take 2147483648 units of work plus
/// 2097152 per level, which is ten to sixty seconds on one core; --max-work sets a different limit
/// (`arcade docs limits`).
///
/// With --key, the root must be signed by that key, or by enough keys of that set, as with `arcade trust sign`
/// (`arcade docs trust`).
///
/// With --chain, follows the roots back through the earlier releases. With --item and --write-proof, writes a small file that
/// proves one file or one game. With --item, --proof and --root, checks such a proof against the file or the game's folder alone.
///
/// Exit status 0: sound. 1: not sound (with every problem listed), not replayed, or not checked because the bound is
/// too small. 2: not a snapshot.
///
/// Example: arcade verify releases/starter
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The snapshot's folder or .tar.zst; with --proof, the item's file or the game's folder
    #[arg(value_name = "SNAPSHOT", value_parser = crate::paths::release_parser())]
    snapshot: PathBuf,
    /// Snapshots, or folders of snapshots, to search for earlier releases
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with = "proof")]
    chain: Vec<PathBuf>,
    /// A file of the snapshot, such as games/x/lvl0.txt, or a game's folder name for all of its files
    #[arg(long, value_name = "ID")]
    item: Option<String>,
    /// Write the proof that the item is in the snapshot
    #[arg(long, value_name = "FILE", requires = "item", conflicts_with = "proof")]
    write_proof: Option<PathBuf>,
    /// Check this proof for the item, without the rest of the snapshot
    #[arg(long, value_name = "FILE", requires = "item", requires = "root")]
    proof: Option<PathBuf>,
    /// The published root that the snapshot must have
    #[arg(long, value_name = "DIGEST", value_parser = digest)]
    root: Option<Digest>,
    #[command(flatten)]
    trust: TrustArgs,
    /// Accept a snapshot with different semantics as sound, although its witnesses were not replayed
    #[arg(long)]
    accept_unreplayed: bool,
    /// Maximum number of units of work for all replays together, instead of the default above
    #[arg(long, value_name = "UNITS", value_parser = clap::value_parser!(u64).range(1..))]
    max_work: Option<u64>,
}

#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    verification: &'a Verification,
    /// `true` if the root was compared with a root from another source.
    root_compared: bool,
    /// The result of checking the signatures, or `None` if they were not checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    signed: Option<&'a Signed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    chain: Option<&'a Chain>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if let (Some(id), Some(proof), Some(root)) = (&args.item, &args.proof, &args.root) {
        return item::check(&args.snapshot, id, proof, root, console);
    }
    if args.item.is_some() && args.write_proof.is_none() {
        bail!(
            "--item needs --write-proof FILE, to write its proof, or --proof FILE and --root DIGEST, to check one"
        );
    }
    args.write_proof.as_deref().map_or(Ok(()), protected::check)?;
    let bounds = args.max_work.map_or(Bounds::RELEASE, |work| Bounds { work, work_per_level: 0 });
    let mut verification = match verify_within(&args.snapshot, &bounds) {
        // A manifest or an archive exists but is damaged, so this is an answer, not a failure.
        Err(
            error @ (SnapshotError::Syntax { .. }
            | SnapshotError::Manifest { .. }
            | SnapshotError::Archive { .. }
            | SnapshotError::Link { .. }
            | SnapshotError::ReleaseKind { .. }
            | SnapshotError::TooLarge { .. }),
        ) => return damaged(error, &args.snapshot, console),
        verification => verification?,
    };
    if let Some(root) = args.root.filter(|root| *root != verification.root) {
        let problem = format!("{MANIFEST_FILE}: the root is {}, not {root}", verification.root);
        verification.problems.push(problem);
    }
    let signed = args.trust.judge_release(&args.snapshot, &verification)?;
    verification.problems.extend(signed.iter().flat_map(|signed| signed.problems.clone()));
    let chain = match args.chain.as_slice() {
        [] => None,
        folders => Some(follow(Link::of(&verification.manifest, &args.snapshot), folders)?),
    };
    let broken = chain.as_ref().map_or(0, |chain| chain.problems.len());
    let unreplayed = matches!(verification.witnesses, Witnesses::NotReplayed { .. });
    let sound = verification.problems.is_empty() && broken == 0 && (args.accept_unreplayed || !unreplayed);
    let written = match (&args.write_proof, &args.item) {
        (Some(file), Some(id)) if sound => Some(item::write(&verification.manifest, id, file)?),
        _ => None,
    };
    let root_compared = args.root.is_some();
    let document = Document {
        verification: &verification,
        root_compared,
        signed: signed.as_ref(),
        chain: chain.as_ref(),
    };
    console.document(&document)?;
    say(&verification, args, signed.as_ref(), console);
    if let Some(chain) = &chain {
        say_chain(chain, &args.chain, console);
    }
    if let Some(written) = written {
        console.say(written);
    } else if args.write_proof.is_some() {
        console.say("no proof was written");
    }
    Ok(sound)
}

fn say(verification: &Verification, args: &Args, signed: Option<&Signed>, console: &Console) {
    let Verification {
        name, root, files, games, levels, witnesses, exceeded, papers, ignored, problems, ..
    } = verification;
    let (files, games, levels) = (count(*files, "file"), count(*games, "game"), count(*levels, "level"));
    for problem in problems {
        console.say(one_line(problem));
    }
    if let (Some(bound), [_]) = (exceeded, &problems[..]) {
        return console.say(format_args!(
            "{name}: not checked: the bound of {bound} units of work is too small for its witnesses; raise \
             it with --max-work"
        ));
    }
    if !problems.is_empty() {
        return console.say(format_args!("{name}: does NOT verify; problems: {}", problems.len()));
    }
    match witnesses {
        Witnesses::Replayed(count) => console.say(format_args!(
            "{name}: verified; the manifest and {files}, {games}, {levels}, {count} witnesses \
             replayed to a win{}",
            match verification.is_secret {
                true => "; seed, siblings and second wins withheld until the release is revealed",
                false => "",
            }
        )),
        Witnesses::Held => console.say(format_args!(
            "{name}: verified; the manifest and {files}, {games}, {levels}, witnesses withheld until \
             the release is revealed"
        )),
        Witnesses::NotReplayed { semantics } => {
            let newer = if *semantics > engine::SEMANTICS {
                "a newer version of arcade, with"
            } else {
                "a version of arcade with"
            };
            console.say(format_args!("{name}: the manifest and {files}, {games}, {levels}"));
            console.say(format_args!(
                "integrity: ok, witnesses: not replayed (needs {newer} semantics {semantics}; this version has {})",
                engine::SEMANTICS
            ));
            console.say(match args.accept_unreplayed {
                true => format!("{name}: accepted without replaying its witnesses"),
                false => format!(
                    "{name}: NOT verified: nothing shows that its levels can be won; use the version of arcade that minted it, or \
                     pass --accept-unreplayed to accept it without replays"
                ),
            });
        }
    }
    console.say(match (args.root, signed) {
        (Some(_), _) => format!("root {root}, as given"),
        (None, Some(_)) => format!("root {root}"),
        (None, None) => format!(
            "root {root}\nThe folder is consistent. To check that it is the published release, pass --root DIGEST or \
             --key FILE."
        ),
    });
    if let Some(signed) = signed {
        console.say(trusted::sentence(signed));
    }
    if *papers > 0 {
        console.say(format_args!("papers: {}, not covered by the root", count(*papers, "file")));
    }
    if !ignored.is_empty() {
        console.say(format_args!("ignored: {}", ignored.join(", ")));
    }
}

fn say_chain(chain: &Chain, folders: &[PathBuf], console: &Console) {
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
        console.say(format_args!("  {name:<width$}  {root}  {}", place.in_message()));
    }
    if chain.others > 0 {
        let places: Vec<String> = folders.iter().map(|folder| format!("`{}`", folder.in_message())).collect();
        let (others, belong) =
            (count(chain.others, "other release"), if chain.others == 1 { "belongs" } else { "belong" });
        console.say(format_args!("  {others} in {} {belong} to no part of this chain", places.join(", ")));
    }
}

fn damaged(error: SnapshotError, snapshot: &Path, console: &Console) -> Answer {
    let place = if matches!(error, SnapshotError::Archive { .. }) { "" } else { "MANIFEST.json: " };
    let problem = format!("{place}{:#}", anyhow::Error::from(error));
    console.document(&json!({ "problems": [problem] }))?;
    console.say(one_line(&problem));
    console.say(format_args!("{}: does NOT verify", snapshot.in_message()));
    Ok(false)
}

/// Formats a problem on one line. A problem may quote untrusted text, which must not be mistaken for a line
/// of arcade's own output.
fn one_line(problem: &str) -> String {
    problem.replace('\n', "\\n")
}

/// Prints a note if a snapshot's witnesses have not been replayed, for subcommands that use snapshots without
/// verifying them.
pub(crate) fn remark_unreplayed(manifest: &Manifest, console: &Console) {
    if manifest.semantics != engine::SEMANTICS {
        console.remark(format_args!(
            "note: the witnesses of {} were not replayed: they need a version of arcade with semantics {}, and this version has {}",
            manifest.name,
            manifest.semantics,
            engine::SEMANTICS
        ));
    }
}

/// Converts the error. A nonexistent folder or a folder without a snapshot is a malformed question, and a
/// disk failure is an environment failure.
impl From<SnapshotError> for Failure {
    fn from(error: SnapshotError) -> Failure {
        match error {
            SnapshotError::Io { action: "examine" | "list" | "open" | "read", ref path, ref source }
                if matches!(source.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
            {
                absent(path)
            }
            SnapshotError::Io { .. } => Failure::Environment(error.into()),
            SnapshotError::NotASnapshot(path) | SnapshotError::NotAFolder(path) => no_snapshot(&path),
            _ => Failure::Malformed(error.into()),
        }
    }
}

fn absent(path: &Path) -> Failure {
    let shown = path.in_message();
    Failure::malformed(match path.exists() {
        true => format!(
            "`{shown}` is not a folder: pass a folder; unpack an archive first, for example with tar -xf"
        ),
        false => format!("`{shown}` does not exist: check the path"),
    })
}

/// Returns a failure that states what was found instead of a snapshot, and explains what a snapshot is.
fn no_snapshot(path: &Path) -> Failure {
    let shown = path.in_message();
    let ends = |end: &str| path.extension().is_some_and(|found| found == end);
    let what = match fs::metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => "does not exist: check the path",
        Err(_) => "cannot be opened: check its permissions",
        Ok(found) if found.is_dir() && path.join("game.vgdl").exists() => {
            "is a game's folder: check it with `arcade validate`"
        }
        Ok(found) if found.is_dir() && path.join(SHARD_FILE).exists() => {
            "is a shard of a snapshot: join the shards with `arcade merge`"
        }
        Ok(found) if found.is_dir() => "is a folder without MANIFEST.json",
        Ok(found) if !found.is_file() => "is neither a file nor a folder",
        Ok(_) if path.file_name().is_some_and(|name| name == MANIFEST_FILE) => {
            "is a manifest: pass the folder that contains it"
        }
        Ok(_) if ends("vgdl") || ends("txt") => "is a text file: check a game with `arcade validate`",
        Ok(_) if ends("toml") => "may be a recipe: mint it with `arcade release`",
        Ok(_) => "is a file, but not a snapshot archive",
    };
    malformed!(
        "`{shown}` {what}; a snapshot is a folder that contains MANIFEST.json, or the .tar.zst that \
         `arcade export` makes from it"
    )
}
