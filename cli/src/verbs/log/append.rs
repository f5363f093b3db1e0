//! `arcade log append`: new entries.

use super::{counted, row, rules};
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::trusted::{open_secret, signatures_of, warn_of_readers};
use crate::verbs::release::{check_beacon, find_recipe, read_secret_file};
use engine::Digest;
use evaluation::scale::ScaleFile;
use serde_json::json;
use snapshots::{Manifest, Recipe, SECRET_FILE, follow, integrity_of};
use std::path::{Path, PathBuf};
use trust::log::{Entry, Log, Revealed, Round, append, verifier_key};
use trust::{Anchor, Disk, Drawn, MAX_BEACON, Signatures, read_bounded};

/// Appends entries to a log, or starts one: what is named here, in the order of the help.
///
/// Nothing is appended that contradicts what the log has: a second commitment or root of one name, a beacon that was
/// known before the commitment, a release that is not the one committed to. The files are complete before the new
/// state is signed, so a loss of power leaves the log as it was.
///
/// Example: arcade log append log --secret log.key --commitment 2027-02.toml --parent releases/2027-01
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log's folder
    #[arg(value_name = "LOG")]
    log: PathBuf,
    /// The secret key of the log
    #[arg(long, value_name = "FILE")]
    secret: PathBuf,
    /// The password of the secret key, on the first line of a file, instead of asking on the terminal
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
    /// The folder of the release before, if the recipe was committed to with one
    #[arg(long, value_name = "DIR", requires = "commitment")]
    parent: Option<PathBuf>,
    /// Values of public randomness, as JSON files
    #[arg(long, value_name = "FILE", num_args = 1..)]
    beacon: Vec<PathBuf>,
    /// Releases, in folders or archives
    #[arg(long, value_name = "SNAPSHOT", num_args = 1..)]
    release: Vec<PathBuf>,
    /// Sealed releases that were revealed
    #[arg(long, value_name = "SNAPSHOT", num_args = 1..)]
    reveal: Vec<PathBuf>,
    /// The scale of a release (scale.json of `arcade calibrate`), with the name of the release
    #[arg(long, value_name = "NAME=FILE", num_args = 1..)]
    calibration: Vec<String>,
    /// Results of players on a release of the log, as `arcade evaluate` writes them; every episode is replayed
    #[arg(long, value_name = "RESULTS", num_args = 1..)]
    result: Vec<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.log.exists() && !args.log.is_dir() {
        bail!("`{}` is a file: name a folder for the log", args.log.display());
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
        new.push(commitment(recipe, args.parent.as_deref())?);
    }
    for file in &args.beacon {
        let drawn = Drawn::parse(&read_bounded(file, MAX_BEACON)?, &file.display().to_string())?;
        new.push(drawn.entry());
    }
    for place in &args.release {
        new.push(release(sound(place)?, place)?);
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
            bail!("`{text}` is not a scale with the name of its release: write NAME=FILE");
        };
        let root = root_of(name, &new)?;
        let scale = ScaleFile::read(Path::new(file))?;
        if !scale.months.iter().any(|month| month.snapshot == Some(root)) {
            bail!("`{file}`: the scale has no release with the root of `{name}`, {root}: name another scale");
        }
        let content = read_bounded(Path::new(file), MAX_SCALE)?;
        new.push(Entry::Calibration { release: name.to_owned(), root, file: Digest::of(&content) });
    }
    for folder in &args.result {
        let all: Vec<Entry> = known.iter().chain(&new).cloned().collect();
        new.push(Entry::Result(row::of(folder, &all)?));
    }
    if new.is_empty() {
        bail!("name something to append, such as --release releases/2027-01");
    }
    warn_of_readers(&args.secret, console);
    let secret = open_secret(&args.secret, args.password_file.as_deref())?;
    let log = append(&args.log, args.origin.as_deref(), &secret, &new, &rules, &Disk::new())?;
    let checkpoint = &log.checkpoint;
    console.document(&json!({
        "log": args.log.display().to_string(), "origin": checkpoint.origin, "size": checkpoint.size, "appended": new,
    }))?;
    for (number, entry) in (checkpoint.size - new.len() as u64..).zip(&new) {
        console.say(format_args!("{number}  {}", entry.line()));
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

/// The greatest size of a scale, in bytes.
const MAX_SCALE: u64 = 1 << 28;

fn keys(file: &Path) -> Result<Entry, Failure> {
    match crate::trusted::anchor(file)? {
        Anchor::Set(set) => {
            Ok(Entry::Keys { version: set.version, digest: set.digest()?, previous: set.previous })
        }
        Anchor::Key(_) => {
            Err(malformed!("`{}` is a public key: a log states sets of them, keys-N.json", file.display()))
        }
    }
}

fn commitment(file: &Path, parent: Option<&Path>) -> Result<Entry, Failure> {
    let mut recipe = find_recipe(file, Recipe::from_toml)?;
    if let Some(parent) = parent {
        follow(&mut recipe, parent)?;
    }
    let Some(commitment) = recipe.commitment else {
        bail!(
            "{}: the recipe has no `commitment`: draw a secret with `arcade release RECIPE --commit`, and write the line \
             that it prints into the recipe",
            file.display()
        );
    };
    check_beacon(&recipe)?;
    let beacon = recipe.beacon.as_ref().map(|part| Round { source: part.source.clone(), round: part.round });
    Ok(Entry::Commitment {
        release: recipe.name.clone(),
        commitment,
        recipe: recipe.committed(),
        parent: recipe.parent,
        beacon,
    })
}

/// The entry of a release: the same whoever makes it, but for the statement about it.
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

/// The manifest of a release whose files are those that it lists.
pub(super) fn sound(place: &Path) -> Result<Manifest, Failure> {
    let integrity = integrity_of(place)?;
    match integrity.problems.first() {
        None => Ok(integrity.manifest),
        Some(problem) => Err(malformed!("`{}` does not verify: {problem}", place.display())),
    }
}

fn reveal(place: &Path) -> Result<Entry, Failure> {
    let manifest = sound(place)?;
    let file = place.join(SECRET_FILE);
    if !file.is_file() {
        bail!(
            "`{}` has no {SECRET_FILE}: name the folder that `arcade release … --reveal` wrote",
            place.display()
        );
    }
    let secret = read_secret_file(&file)?;
    let Some(recipe) = secret.recipe else { bail!("{}: the secret names no recipe", file.display()) };
    Ok(Entry::Reveal(Revealed {
        release: manifest.name,
        root: manifest.root,
        seed: secret.seed,
        nonce: secret.nonce,
        recipe,
    }))
}
