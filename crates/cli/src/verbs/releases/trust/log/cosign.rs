//! `arcade trust log cosign`: signs a checkpoint as a witness.

use super::{checkpoint, counted, open, public_key};
use crate::console::Console;
use crate::failure::Answer;
use crate::input::trusted::{open_secret, warn_of_readers};
use base::MessagePath;
use disk::Disk;
use serde_json::json;
use std::path::PathBuf;
use trust::log::{check_name, verifier_key};

/// Signs the checkpoint of a log as a witness who has seen that it extends an earlier one.
///
/// A witness signs nothing that contradicts what it has signed before. So readers who trust the witness need not fear
/// that the log shows others a different history. The signature is in the C2SP tlog-cosignature format.
///
/// Example: arcade trust log cosign log --key log.pub --witness w.example --secret w.key --seen log.seen --time 1800000000
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log's folder
    #[arg(value_name = "LOG")]
    log: PathBuf,
    /// The public key of the log
    #[arg(long, value_name = "FILE")]
    key: PathBuf,
    /// The name of the witness
    #[arg(long, value_name = "NAME")]
    witness: String,
    /// The secret key of the witness
    #[arg(long, value_name = "FILE")]
    secret: PathBuf,
    /// Read the password of the secret key from the first line of this file instead of the terminal
    #[arg(long, value_name = "FILE")]
    password_file: Option<PathBuf>,
    /// The checkpoint that the witness signed last; required except for its first signature
    #[arg(long, value_name = "FILE")]
    seen: Option<PathBuf>,
    /// The time that the signature states, in seconds since 1970
    #[arg(long, value_name = "SECONDS")]
    time: u64,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    check_name(&args.witness)?;
    let key = public_key(&args.key)?;
    let log = open(&args.log)?;
    let mut problems = log.faults(&key);
    warn_of_readers(&args.secret, console);
    let secret = open_secret(&args.secret, args.password_file.as_deref())?;
    if let Some(file) = &args.seen {
        let seen = checkpoint(file)?;
        if seen.check(&key).is_err() || seen.witnessed(&args.witness, &secret.public()).is_none() {
            bail!(
                "`{}` is not signed by both the log and this witness: pass the checkpoint that the \
                 witness signed last",
                file.in_message()
            );
        }
        problems.extend(log.fork(&seen));
    }
    let sound = problems.is_empty();
    if sound {
        let mut signed = log.checkpoint.clone();
        signed.cosign(&args.witness, args.time, &secret);
        log.write_checkpoint(&signed, &Disk::new())?;
    }
    let verifier = verifier_key(&args.witness, &secret.public(), true);
    console.document(
        &json!({ "signed": sound, "size": log.checkpoint.size, "key": verifier, "problems": problems }),
    )?;
    problems.iter().for_each(|problem| console.say(problem));
    console.say(match sound {
        true => {
            format!("{}: {}, signed by {}", log.checkpoint.origin, counted(log.checkpoint.size), args.witness)
        }
        false => format!("{}: NOT signed", log.checkpoint.origin),
    });
    Ok(sound)
}
