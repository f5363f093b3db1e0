//! `arcade trust log append`: appends new entries to a log.

use super::{counted, line, row, rules};
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::trusted::{open_secret, signatures_of, warn_of_readers};
use crate::paths;
use crate::shell;
use crate::verbs::releases::release::{
    check_beacon, find_recipe, read_secret_file, secret_file, sign_command,
};
use base::Digest;
use base::MessagePath;
use disk::Disk;
use evaluation::scale::ScaleFile;
use serde_json::json;
use snapshots::{Manifest, Recipe, RecipeError, SECRET_FILE, follow, integrity_of};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use trust::log::{Entry, Log, Revealed, Round, append, verifier_key};
use trust::{Anchor, Drawn, KeySet, MAX_BEACON, Signatures, read_bounded};

/// Appends entries to a log, or starts one. Entries are appended in the order of the flags in this help.
///
/// An entry is rejected if it contradicts the log: a second commitment or root for the same name, a beacon that was
/// known before the commitment, a release that differs from the committed one. An entry is also rejected if a later one
/// would have to contradict it. A commitment needs --parent (the release before it) or --first. A release needs a
/// signature, or --unsigned. The files are complete before the new state is signed, so a power failure leaves the log
/// unchanged.
///
/// Example: arcade trust log append log --secret log.key --commitment 2027-02.toml --parent releases/2027-01
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log's folder
    #[arg(value_name = "LOG")]
    log: PathBuf,
    /// The secret key of the log
    #[arg(long, value_name = "FILE")]
    secret: PathBuf,
    /// Read the password of the secret key from the first line of this file instead of the terminal
    #[arg(long, value_name = "FILE")]
    password_file: Option<PathBuf>,
    /// The name of a new log, such as example.org/arcade
    #[arg(long, value_name = "NAME")]
    origin: Option<String>,
    /// Sets of keys (keys-N.json)
    #[arg(long, value_name = "FILE", num_args = 1..)]
    keys: Vec<PathBuf>,
    /// A recipe with a commitment, before its release is minted
    #[arg(long, value_name = "RECIPE")]
    commitment: Option<PathBuf>,
    /// The folder of the previous release, as passed to `arcade release --commit`
    #[arg(long, value_name = "DIR", requires = "commitment", value_parser = crate::paths::release_parser())]
    parent: Option<PathBuf>,
    /// The committed release has no parent, although the log has earlier releases
    #[arg(long, requires = "commitment", conflicts_with = "parent")]
    first: bool,
    /// Public randomness values, as JSON files
    #[arg(long, value_name = "FILE", num_args = 1..)]
    beacon: Vec<PathBuf>,
    /// Releases, as folders or archives
    #[arg(long, value_name = "SNAPSHOT", num_args = 1.., value_parser = crate::paths::release_parser())]
    release: Vec<PathBuf>,
    /// Append unsigned releases, whose entries do not refer to a signed statement
    #[arg(long, requires = "release")]
    unsigned: bool,
    /// Sealed releases that were revealed
    #[arg(long, value_name = "SNAPSHOT", num_args = 1..)]
    reveal: Vec<PathBuf>,
    /// The scale of a release (scale.json of `arcade study calibrate`), with the name of the release
    #[arg(long, value_name = "NAME=FILE", num_args = 1..)]
    calibration: Vec<String>,
    /// Results of players on a release in the log, in folders written by `arcade evaluate`; every episode is replayed
    #[arg(long, value_name = "RESULTS", num_args = 1..)]
    result: Vec<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.log.exists() && !args.log.is_dir() {
        bail!("`{}` is a file: choose a folder for the log", args.log.in_message());
    }
    let known = match Log::open(&args.log)? {
        Some(log) => log.entries()?,
        None => Vec::new(),
    };
    let mut new = Vec::new();
    for file in &args.keys {
        new.push(keys(file)?);
    }
    if let Some(recipe) = &args.commitment {
        new.push(commitment(recipe, args, &known, console)?);
    }
    for file in &args.beacon {
        let drawn = Drawn::parse(&read_bounded(file, MAX_BEACON)?, &file.in_message().to_string())?;
        new.push(drawn.entry());
    }
    for place in &args.release {
        let entry = release(sound(place)?, place)?;
        if matches!(entry, Entry::Root { statement: None, .. }) && !args.unsigned {
            bail!(
                "`{}` is not signed, and its entry could not be changed later: sign it first with `{}`, \
                 or append it without a signature with --unsigned",
                place.in_message(),
                sign_command(place)
            );
        }
        new.push(entry);
    }
    for place in &args.reveal {
        new.push(reveal(place)?);
    }
    let root_of = |name: &str, new: &[Entry]| {
        let found = known.iter().chain(new).find_map(|entry| match entry {
            Entry::Root { release, root, .. } if release == name => Some(*root),
            _ => None,
        });
        found.ok_or_else(|| malformed!("`{name}` is not in the log: append its root first, with --release"))
    };
    for text in &args.calibration {
        let Some((name, file)) = text.split_once('=') else {
            bail!("`{text}` does not specify a release's name and its scale: write NAME=FILE");
        };
        let root = root_of(name, &new)?;
        let scale = ScaleFile::read(Path::new(file))?;
        if !scale.months.iter().any(|month| month.snapshot == Some(root)) {
            bail!(
                "`{file}`: the scale has no release with the root of `{name}` ({root}); choose another scale"
            );
        }
        let content = read_bounded(Path::new(file), MAX_SCALE)?;
        new.push(Entry::Calibration { release: name.to_owned(), root, file: Digest::of(&content) });
    }
    for folder in &args.result {
        let all: Vec<Entry> = known.iter().chain(&new).cloned().collect();
        new.push(Entry::Result(row::of(folder, &all)?));
    }
    if new.is_empty() {
        bail!("specify something to append, such as --release releases/2027-01");
    }
    let all: Vec<Entry> = known.iter().chain(&new).cloned().collect();
    reachable(&all, &new)?;
    warn_of_readers(&args.secret, console);
    let secret = open_secret(&args.secret, args.password_file.as_deref())?;
    let log = append(&args.log, args.origin.as_deref(), &secret, &new, &rules, &Disk::new())?;
    let checkpoint = &log.checkpoint;
    console.document(&json!({
        "log": paths::in_json(&args.log), "origin": checkpoint.origin, "size": checkpoint.size, "appended": new,
    }))?;
    for (number, entry) in (checkpoint.size - new.len() as u64..).zip(&new) {
        console.say(format_args!("{number}  {}", line(entry, &all)));
    }
    console.say(format_args!(
        "{}: {}, signed by {}",
        checkpoint.origin,
        counted(checkpoint.size),
        secret.public().id()
    ));
    if checkpoint.size == new.len() as u64 {
        console.say(format_args!(
            "key for other tools: {}",
            verifier_key(&checkpoint.origin, &secret.public(), false)
        ));
    }
    Ok(true)
}

/// The maximum size of a scale, in bytes.
const MAX_SCALE: u64 = 1 << 28;

fn keys(file: &Path) -> Result<Entry, Failure> {
    match crate::input::trusted::anchor(file)? {
        Anchor::Set(set) => {
            followed(&set, file)?;
            Ok(Entry::Keys { version: set.version, digest: set.digest()?, previous: set.previous })
        }
        Anchor::Key(_) => Err(malformed!(
            "`{}` is a public key: a log records sets of keys, keys-N.json",
            file.in_message()
        )),
    }
}

/// Rejects a key set that does not yet follow from the sets known to the log's readers. If such a set were
/// later created anew with different keys, the log could not accept any further set.
fn followed(set: &KeySet, file: &Path) -> Result<(), Failure> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let found = Signatures::read(folder)?;
    let Some(before) = set.version.checked_sub(1).and_then(|version| found.set(version)) else {
        return Ok(());
    };
    let Err(problems) = before.admits(set, found.of(&set.file())) else { return Ok(()) };
    let [group, verb, flag] = ["trust", "keys", "--secret"].map(OsStr::new);
    bail!(
        "`{}`: readers do not follow this set of keys yet ({}); sign the set with `{} FILE...`, then append it",
        file.in_message(),
        problems.join("; "),
        shell::command([group, verb, folder.as_os_str(), flag])
    )
}

/// Rejects a commitment that follows a release missing from the log, because the committed release's root
/// could not be appended later.
fn reachable(all: &[Entry], new: &[Entry]) -> Result<(), Failure> {
    for entry in new {
        let Entry::Commitment { release, parent: Some(parent), .. } = entry else { continue };
        if !all.iter().any(|entry| matches!(entry, Entry::Root { root, .. } if root == parent)) {
            bail!(
                "`{release}` follows a release with root {parent}, which is not in the log, so its own root \
                 could not be appended later: append that release first, with --release"
            );
        }
    }
    Ok(())
}

/// Returns the entry for a commitment. A commitment cannot be withdrawn, and the root appended later must
/// match its parent, recipe and name. Therefore, this function checks everything that can be checked.
fn commitment(file: &Path, args: &Args, known: &[Entry], console: &Console) -> Result<Entry, Failure> {
    let mut recipe = find_recipe(file, Recipe::from_toml)?;
    if let Some(parent) = &args.parent {
        follow(&mut recipe, parent)?;
    }
    let Some(commitment) = recipe.commitment else {
        bail!(
            "{}: the recipe has no `commitment`: draw a secret with `arcade release RECIPE --commit`, and write the line \
             that this command prints into the recipe",
            file.in_message()
        );
    };
    check_beacon(&recipe)?;
    let earlier = known.iter().rev().find_map(|entry| match entry {
        Entry::Root { release, .. } | Entry::Commitment { release, .. } if *release != recipe.name => {
            Some(release)
        }
        _ => None,
    });
    if let (Some(earlier), None, false) = (earlier, recipe.parent, args.first) {
        bail!(
            "{}: the log already has `{earlier}`: pass the previous release with --parent DIR, as it was \
             passed to `arcade release --commit`, or pass --first if there is no previous release; after a \
             wrong choice, the new release could never be appended",
            file.in_message()
        );
    }
    let secret = secret_file(&recipe.name);
    let beside = file.with_file_name(&secret);
    match [secret.as_path(), &beside].into_iter().find_map(|place| read_secret_file(place).ok()) {
        Some(secret) if secret.commitment() == commitment => {
            if let Err(error @ RecipeError::OtherRecipe(_)) = recipe.root_seed(Some(&secret)) {
                bail!("{}: {error}", file.in_message());
            }
        }
        _ => console.remark(format_args!(
            "note: without the secret, `{}`, nothing shows that the recipe and the parent match the commitment",
            secret.in_message()
        )),
    }
    let beacon = recipe.beacon.as_ref().map(|part| Round { source: part.source.clone(), round: part.round });
    Ok(Entry::Commitment {
        release: recipe.name.clone(),
        commitment,
        recipe: recipe.committed(),
        parent: recipe.parent,
        beacon,
    })
}

/// Returns the entry for a release. The entry is the same for everyone who creates it, except for the
/// release's signed statement.
pub(super) fn release(manifest: Manifest, place: &Path) -> Result<Entry, Failure> {
    let folder = signatures_of(place);
    let statement = match folder.is_dir() {
        true => Signatures::read(&folder)?.statement_of(&manifest.root)?,
        false => None,
    };
    let beacon = manifest.recipe.get("beacon").and_then(|beacon| beacon.get("value"));
    let beacon = beacon.and_then(|value| value.as_str()).and_then(|value| value.parse().ok());
    Ok(Entry::Root {
        release: manifest.name,
        root: manifest.root,
        parent: manifest.parent,
        commitment: manifest.commitment,
        beacon,
        statement,
    })
}

/// Returns a release's manifest after checking that the release's files match it.
pub(super) fn sound(place: &Path) -> Result<Manifest, Failure> {
    let integrity = integrity_of(place)?;
    match integrity.problems.first() {
        None => Ok(integrity.manifest),
        Some(problem) => Err(malformed!("`{}` does not verify: {problem}", place.in_message())),
    }
}

fn reveal(place: &Path) -> Result<Entry, Failure> {
    let public = paths::release(place.to_owned());
    if public != place {
        let [verb, reveal, out] = ["release", "--reveal", "--out"].map(OsStr::new);
        let held = place.join("held");
        let join = shell::command([verb, public.as_os_str(), reveal, held.as_os_str(), out]);
        bail!(
            "`{}` contains a release that is not revealed: join its two parts with `{join} DIR`, and pass DIR",
            place.in_message()
        );
    }
    let manifest = sound(place)?;
    let file = place.join(SECRET_FILE);
    if !file.is_file() {
        bail!(
            "`{}` has no {SECRET_FILE}: pass the folder that `arcade release … --reveal` wrote",
            place.in_message()
        );
    }
    let secret = read_secret_file(&file)?;
    let Some(recipe) = secret.recipe else {
        bail!("{}: the secret does not specify a recipe", file.in_message())
    };
    Ok(Entry::Reveal(Revealed {
        release: manifest.name,
        root: manifest.root,
        seed: secret.seed,
        nonce: secret.nonce,
        recipe,
    }))
}
