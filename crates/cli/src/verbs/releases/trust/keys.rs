//! `arcade trust keys`: creates and shows a publisher's key sets. Each set after the first is signed with keys of the
//! previous set.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::trusted::{SecretArgs, warn_of_readers};
use crate::protected;
use base::MessagePath;
use disk::Disk;
use serde_json::json;
use std::path::{Path, PathBuf};
use trust::{KeySet, NamedKey, PublicKey, Signatures, read_bounded, sign_into};

/// Makes the next set of keys, keys-N.json, or shows the newest set.
///
/// A set states who may sign, how many of them must, and which keys no longer count. The first set is trusted as it is published.
/// Each later set must be signed by enough keys of the previous set and of its own, so that anyone who knows one set can follow
/// the others. Without --add, --revoke and --threshold, --secret adds signatures to the newest set.
///
/// Exit status 0: the newest set follows from the first. 1: it lacks signatures.
///
/// Example: arcade trust keys trust --add ada=ada.pub bo=bo.pub cy=cy.pub --threshold 2
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder that contains the sets
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// New keys, each with the name of its holder
    #[arg(long, value_name = "NAME=FILE", num_args = 1..)]
    add: Vec<String>,
    /// Keys to revoke, each with the reason
    #[arg(long, value_name = "NAME=REASON", num_args = 1..)]
    revoke: Vec<String>,
    /// The number of keys that must sign [default: as in the previous set]
    #[arg(long, value_name = "N")]
    threshold: Option<u32>,
    #[command(flatten)]
    secrets: SecretArgs,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    protected::check(&args.folder.join("keys-1.json"))?;
    let found = match args.folder.is_dir() {
        true => Signatures::read(&args.folder)?,
        false => Signatures::default(),
    };
    let newest = (1..).map_while(|version| found.set(version)).last();
    let pairs = |texts: &[String], what: &str| -> Result<Vec<(String, String)>, Failure> {
        let split = |text: &String| text.split_once('=').map(|(a, b)| (a.to_owned(), b.to_owned()));
        texts.iter().map(|text| split(text).ok_or_else(|| malformed!("`{text}` is not {what}"))).collect()
    };
    let mut add = Vec::new();
    for (name, file) in pairs(&args.add, "a key with the name of its holder: write NAME=FILE")? {
        let text = read_bounded(Path::new(&file), trust::MAX_KEY_FILE)?;
        let key = PublicKey::parse(&String::from_utf8_lossy(&text))
            .map_err(|error| malformed!("`{file}`: {error}"))?;
        add.push(NamedKey { name, key: key.to_base64() });
    }
    let revoke = pairs(&args.revoke, "a name with a reason: write NAME=REASON, such as ada=lost")?;
    let changes = !add.is_empty() || !revoke.is_empty() || args.threshold.is_some();
    let set = match (changes, newest) {
        (true, newest) => KeySet::next(newest, args.threshold, add, &revoke)?,
        (false, Some(newest)) => newest.clone(),
        (false, None) => {
            bail!(
                "`{}` has no keys-1.json: make the first set with --add NAME=FILE",
                args.folder.in_message()
            )
        }
    };
    args.secrets.secret.iter().for_each(|file| warn_of_readers(file, console));
    let secrets = args.secrets.open()?;
    if changes || !secrets.is_empty() {
        let comment = format!("keys {} {}", set.version, set.digest()?);
        sign_into(&args.folder, &set.file(), &set.to_bytes()?, &comment, &secrets, &Disk::new())?;
    }
    say(args, &set, console)
}

/// Shows a key set, and states whether each set from the second to this one is signed as the previous set requires.
fn say(args: &Args, set: &KeySet, console: &Console) -> Answer {
    let found = Signatures::read(&args.folder)?;
    let mut problems = Vec::new();
    for version in 2..=set.version {
        let (Some(before), Some(next)) = (found.set(version - 1), found.set(version)) else { continue };
        problems.extend(before.admits(next, found.of(&next.file())).err().into_iter().flatten());
    }
    let place = args.folder.join(set.file()).in_message().to_string();
    console.document(&json!({ "file": place, "digest": set.digest()?, "set": set, "problems": problems }))?;
    for problem in &problems {
        console.say(problem);
    }
    console.say(format_args!("{place}: {} of {} keys must sign", set.threshold, set.keys.len()));
    for NamedKey { name, key } in &set.keys {
        console.say(format_args!("  {name}  {}", key));
    }
    for revoked in &set.revoked {
        console.say(format_args!("  {}  {}  revoked: {}", revoked.name, revoked.key, revoked.reason));
    }
    match problems.is_empty() {
        true if set.version == 1 => console.say(format_args!(
            "publish this file where it cannot be changed unnoticed: readers start from this set; digest {}",
            set.digest()?
        )),
        true => console.say(format_args!("the set follows from keys-1.json; digest {}", set.digest()?)),
        false => console.say(format_args!(
            "readers do NOT follow this set yet: sign it with  arcade trust keys {} --secret FILE...",
            crate::shell::quoted(&args.folder)
        )),
    }
    Ok(problems.is_empty())
}
