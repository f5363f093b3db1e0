//! `arcade trust sign`: signs a statement about a release's root.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::trusted::{SecretArgs, anchor, signatures_of, warn_of_readers};
use crate::protected;
use base::MessagePath;
use disk::{Access, Disk};
use serde_json::json;
use snapshots::integrity_of;
use std::path::PathBuf;
use trust::{Anchor, KeySet, KeysInForce, Provenance, Signatures, Statement, sign_into};

/// Signs the root of a release, for `arcade verify --key`.
///
/// It signs a statement: the name and root of the release, the set of keys in force, and the software's version, lock
/// file and commit. The statement is stored in papers/signatures, beside one minisign file per key, and the root does
/// not cover it. Other holders sign the same statement on their machines. The release is not replayed, so verify it
/// first.
///
/// Exit status 0: signed by enough keys. 1: more keys must sign. 2: not a snapshot, or not a sound one.
///
/// Example: arcade trust sign releases/2027-01 --secret ada.key --keys trust/keys-1.json
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The snapshot's folder or .tar.zst
    #[arg(value_name = "SNAPSHOT", value_parser = crate::paths::release_parser())]
    snapshot: PathBuf,
    #[command(flatten)]
    secrets: SecretArgs,
    /// The set of keys in force (keys-N.json), which is copied beside the statement together with the earlier
    /// sets
    #[arg(long, value_name = "FILE")]
    keys: Option<PathBuf>,
    /// The commit of the sources [default: as recorded in this build]
    #[arg(long, value_name = "COMMIT")]
    commit: Option<String>,
    /// The folder with the signatures [default: `papers/signatures` in the snapshot, `NAME.signatures` beside an
    /// archive]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.secrets.secret.is_empty() {
        bail!("pass the signing keys with --secret FILE...; `arcade trust keygen NAME` makes one");
    }
    let folder = args.out.clone().unwrap_or_else(|| signatures_of(&args.snapshot));
    protected::check(&folder.join("x"))?;
    let integrity = integrity_of(&args.snapshot)?;
    if let Some(problem) = integrity.problems.first() {
        bail!("the snapshot does not verify, so nothing was signed: {problem}");
    }
    let manifest = integrity.manifest;
    let set = args.keys.as_deref().map(|file| match anchor(file)? {
        Anchor::Set(set) => Ok(*set),
        Anchor::Key(_) => Err(malformed!(
            "`{}` is a public key, but --keys takes a set of keys: pass keys-N.json, which `arcade trust \
             keys` makes",
            file.in_message()
        )),
    });
    let set = set.transpose()?;
    args.secrets.secret.iter().for_each(|file| warn_of_readers(file, console));
    let secrets = args.secrets.open()?;
    for secret in &secrets {
        let (id, key) = (secret.public().id(), secret.public().to_base64());
        if set.as_ref().is_some_and(|set| !set.keys.iter().any(|named| named.key == key)) {
            bail!(
                "the key {id} is not in the set, so its signature would not count: sign with a different key"
            );
        }
    }
    let keys =
        set.as_ref().map(|set| Ok::<_, Failure>(KeysInForce { version: set.version, digest: set.digest()? }));
    let provenance = Provenance {
        version: manifest.version.clone(),
        generation: manifest.generation,
        semantics: manifest.semantics,
        lockfile: manifest.lockfile,
        commit: args.commit.clone().or_else(|| option_env!("ARCADE_COMMIT").map(str::to_owned)),
    };
    let statement = Statement::new(manifest.name.clone(), manifest.root, keys.transpose()?, provenance);
    if let (Some(set), Some(file)) = (&set, &args.keys) {
        copy_sets(args, set, file)?;
    }
    let (file, bytes) = (statement.file()?, statement.to_bytes()?);
    let written = sign_into(&folder, &file, &bytes, &statement.comment(), &secrets, &Disk::new())?;
    let anchor = match set {
        Some(set) => Anchor::Set(Box::new(set)),
        None => Anchor::Key(secrets[0].public()),
    };
    let signed = Signatures::read(&folder)?.judge_file(&file, &anchor);
    let place = folder.in_message().to_string();
    console.document(&json!({
        "release": manifest.name, "root": manifest.root, "folder": place, "statement": file, "written": written,
        "signed": signed,
    }))?;
    console.say(format_args!("{}: root {}\n{place}/{file}", manifest.name, manifest.root));
    match signed.problems.as_slice() {
        [] => console.say(crate::input::trusted::sentence(&signed)),
        problems => {
            problems.iter().for_each(|problem| console.say(problem));
            console.say("more keys must sign: pass the folder on to their holders, who run the same command");
        }
    }
    Ok(signed.problems.is_empty())
}

/// Copies a key set, with the earlier sets and their signatures, to the folder of the statement.
fn copy_sets(args: &Args, set: &KeySet, file: &std::path::Path) -> Result<(), Failure> {
    let folder = args.out.clone().unwrap_or_else(|| signatures_of(&args.snapshot));
    let from = file.parent().unwrap_or(std::path::Path::new(""));
    let from = if from.as_os_str().is_empty() { std::path::Path::new(".") } else { from };
    disk::create_folder(&folder).map_err(|error| Failure::write(&folder, error))?;
    for (name, bytes) in Signatures::files_of_sets(from, set.version)? {
        let path = folder.join(name);
        disk::write(&path, &bytes, Access::Shared).map_err(|error| Failure::write(&path, error))?;
    }
    Ok(())
}
