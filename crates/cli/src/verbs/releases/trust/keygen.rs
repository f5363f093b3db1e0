//! `arcade trust keygen`: generates a new key pair.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::trusted::{open_secret, password};
use crate::protected;
use base::MessagePath;
use disk::Access;
use serde_json::json;
use std::path::{Path, PathBuf};
use trust::{PublicKey, generate};

/// Makes a pair of Ed25519 keys in minisign's file format: NAME.key, which only its owner can read, and NAME.pub.
///
/// The secret key is encrypted with a password, for which you are prompted on the terminal. If NAME.key exists and NAME.pub does
/// not, the public key is written again. No key is ever overwritten. See `arcade docs trust` for how to sign.
///
/// Example: arcade trust keygen ada
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The name of the files, without `.key` and `.pub`
    #[arg(value_name = "NAME")]
    name: PathBuf,
    /// Do not encrypt the secret key, so that anyone who can read the file can sign
    #[arg(long, conflicts_with = "password_file")]
    no_password: bool,
    /// Read the password from the first line of this file instead of the terminal
    #[arg(long, value_name = "FILE")]
    password_file: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let named = |end: &str| {
        let mut name = args.name.clone().into_os_string();
        name.push(end);
        PathBuf::from(name)
    };
    let (secret, public) = (named(".key"), named(".pub"));
    protected::check(&secret)?;
    if public.exists() {
        bail!(
            "`{}` already exists, and keys are never overwritten: choose another name",
            public.in_message()
        );
    }
    if secret.exists() {
        let key = open_secret(&secret, args.password_file.as_deref())?.public();
        write(&public, key.to_file().as_bytes(), Access::Shared)?;
        return answer(&key, &secret, &public, console);
    }
    let password = match args.no_password {
        true => None,
        false => Some(new_password(args.password_file.as_deref())?),
    };
    let new = generate(password.as_deref())?;
    // Write the secret key first, because the public key can be derived from it again.
    write(&secret, new.secret_file.as_bytes(), Access::Private)?;
    write(&public, new.public.to_file().as_bytes(), Access::Shared)?;
    answer(&new.public, &secret, &public, console)
}

/// Reads a new password from the file, or prompts for it twice.
fn new_password(file: Option<&Path>) -> Result<String, Failure> {
    let first = password("Password of the new key: ", file)?;
    if first.is_empty() {
        bail!("the password is empty: choose one, or use --no-password for an unencrypted key");
    }
    if file.is_none() && password("Repeat the password: ", None)? != first {
        bail!("the two passwords differ: try again");
    }
    Ok(first)
}

fn write(path: &Path, bytes: &[u8], access: Access) -> Result<(), Failure> {
    let folder = disk::create_folder(path.parent().unwrap_or(Path::new("")));
    folder.and_then(|()| disk::write(path, bytes, access)).map_err(|error| Failure::write(path, error))
}

fn answer(key: &PublicKey, secret: &Path, public: &Path, console: &Console) -> Answer {
    let (secret, public) = (secret.in_message().to_string(), public.in_message().to_string());
    console
        .document(&json!({ "id": key.id(), "key": key.to_base64(), "public": public, "secret": secret }))?;
    console.say(format_args!("key {}\npublish {public}: {}", key.id(), key.to_base64()));
    console.say(format_args!("keep {secret} private, and keep a backup of it"));
    Ok(true)
}
