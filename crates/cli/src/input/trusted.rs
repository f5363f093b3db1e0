//! Keys specified by the user, and the signature check for releases, which several subcommands share.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::paths;
use crate::shell;
use base::Digest;
use base::MessagePath;
use serde::Serialize;
use serde_json::json;
use snapshots::{MANIFEST_FILE, Verification};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;
use trust::{Anchor, MAX_KEY_FILE, SecretKey, Signatures, Signed, TrustError, is_encrypted, read_bounded};

/// The path to a release's signatures folder.
pub(crate) const SIGNATURES: &str = "papers/signatures";

/// The maximum size of a key set file, in bytes.
const MAX_ANCHOR: u64 = 1 << 16;

/// The key on which trust in a release's root is based.
#[derive(Clone, clap::Args)]
pub(crate) struct TrustArgs {
    /// The publisher's public key (NAME.pub) or set of keys (keys-N.json), from a source other than the release; the
    /// root must be signed with it
    #[arg(long, value_name = "FILE")]
    key: Option<PathBuf>,
    /// The folder with the signatures [default: `papers/signatures` in the snapshot, `NAME.signatures` beside an
    /// archive]
    #[arg(long, value_name = "DIR", requires = "key")]
    signatures: Option<PathBuf>,
}

impl TrustArgs {
    /// Returns `true` if no key was given.
    pub(crate) fn is_empty(&self) -> bool {
        self.key.is_none()
    }

    /// Reads the key, if any, so that an invalid key is reported before the work starts.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.key.as_deref().map_or(Ok(()), |file| anchor(file).map(drop))
    }

    /// Checks the signatures of a release and of its lock file. Returns `None` if no key was given.
    pub(crate) fn judge_release(&self, place: &Path, of: &Verification) -> Result<Option<Signed>, Failure> {
        let Some(mut signed) = self.judge(place, &of.name, &of.root)? else { return Ok(None) };
        let lockfile = of.manifest.lockfile;
        if signed.problems.is_empty() && signed.lockfile != Some(lockfile) {
            signed.problems.push(format!(
                "{MANIFEST_FILE}: its `lockfile` is {lockfile}, but the signed statement specifies a \
                 different one"
            ));
        }
        Ok(Some(signed))
    }

    /// Checks the signatures of a release's root. Returns `None` if no key was given.
    pub(crate) fn judge(&self, place: &Path, name: &str, root: &Digest) -> Result<Option<Signed>, Failure> {
        let Some(file) = &self.key else { return Ok(None) };
        let anchor = anchor(file)?;
        let folder = self.signatures.clone().unwrap_or_else(|| signatures_of(place));
        if !paths::metadata(&folder)?.is_some_and(|found| found.is_dir()) {
            let copy =
                if place.is_file() { "copy the release's papers/signatures to that folder, " } else { "" };
            let problem = format!(
                "there are no signatures at `{}`: {copy}sign the release with `arcade trust sign`, or pass \
                 a different folder with --signatures",
                folder.in_message()
            );
            return Ok(Some(Signed { problems: vec![problem], ..Signed::default() }));
        }
        let mut signed = Signatures::read(&folder)?.judge(name, root, &anchor);
        if let Anchor::Key(key) = &anchor {
            // People recognise a key by its file.
            let (id, file) = (key.id(), file.in_message());
            let named = |problem: &String| {
                problem.replace(&format!("the key {id}"), &format!("the key in {file} ({id})"))
            };
            signed.problems = signed.problems.iter().map(named).collect();
        }
        Ok(Some(signed))
    }
}

/// The expected root of a release, which the user knows from another source. Shared by subcommands that use
/// releases.
#[derive(clap::Args)]
pub(crate) struct OriginArgs {
    /// The published root of the snapshot; a different root is an error
    #[arg(long, value_name = "DIGEST", value_parser = digest)]
    root: Option<Digest>,
    #[command(flatten)]
    trust: TrustArgs,
}

/// The checks performed on a release's root, in the form in which they are recorded.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Origin {
    /// The release's root.
    pub(crate) root: Digest,
    /// `true` if the root was compared with a root from another source.
    pub(crate) root_compared: bool,
    /// The result of checking the signatures, or `None` if they were not checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) signed: Option<Signed>,
}

impl OriginArgs {
    /// Returns `true` if there is nothing to check.
    pub(crate) fn is_empty(&self) -> bool {
        self.root.is_none() && self.trust.key.is_none()
    }

    /// Checks a release's root. Returns the checks performed, or the problems found.
    pub(crate) fn check(
        &self,
        place: &Path,
        name: &str,
        root: Digest,
    ) -> Result<Result<Origin, Vec<String>>, Failure> {
        let mut problems = Vec::new();
        if let Some(asked) = self.root.filter(|asked| *asked != root) {
            problems.push(format!("`{}`: the root is {root}, not {asked}", place.in_message()));
        }
        let signed = self.trust.judge(place, name, &root)?;
        problems.extend(signed.iter().flat_map(|signed| signed.problems.clone()));
        let root_compared = self.root.is_some();
        Ok(if problems.is_empty() { Ok(Origin { root, root_compared, signed }) } else { Err(problems) })
    }
}

/// Reports the problems with a root as the subcommand's answer.
pub(crate) fn refuse(problems: &[String], console: &Console) -> Answer {
    console.document(&json!({ "problems": problems }))?;
    problems.iter().for_each(|problem| console.say(problem));
    console.say("nothing was done, because this is not the requested release");
    Ok(false)
}

/// Parses a user-supplied digest, in lower or upper case.
pub(crate) fn digest(text: &str) -> Result<Digest, String> {
    text.to_ascii_lowercase().parse::<Digest>().map_err(|error| error.to_string())
}

/// Returns the default path of a release's signatures.
pub(crate) fn signatures_of(release: &Path) -> PathBuf {
    if !release.is_file() {
        return paths::release(release.to_owned()).join(SIGNATURES);
    }
    let name = release.file_name().unwrap_or_default().to_string_lossy();
    let name = name.strip_suffix(".zst").unwrap_or(&name);
    release.with_file_name(format!("{}.signatures", name.strip_suffix(".tar").unwrap_or(name)))
}

/// Reads a public key or a key set.
pub(crate) fn anchor(file: &Path) -> Result<Anchor, Failure> {
    Ok(Anchor::parse(&read_bounded(file, MAX_ANCHOR)?, &file.in_message().to_string())?)
}

/// Returns the sentence that reports valid signatures.
pub(crate) fn sentence(signed: &Signed) -> String {
    let keys = signed.keys.map_or(String::new(), |version| format!("; newest set of keys: {version}"));
    let commit = signed.commit.as_ref().map_or(String::new(), |commit| format!("; sources: commit {commit}"));
    format!("signed by {} ({} needed{keys}){commit}", signed.signers.join(", "), signed.threshold)
}

/// The secret keys to sign with.
#[derive(clap::Args)]
pub(crate) struct SecretArgs {
    /// The secret keys to sign with (NAME.key)
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub(crate) secret: Vec<PathBuf>,
    /// Read the password of the secret keys from the first line of this file instead of the terminal
    #[arg(long, value_name = "FILE")]
    pub(crate) password_file: Option<PathBuf>,
}

impl SecretArgs {
    /// Opens the secret keys, prompting for the passwords of encrypted keys.
    pub(crate) fn open(&self) -> Result<Vec<SecretKey>, Failure> {
        self.secret.iter().map(|file| open_secret(file, self.password_file.as_deref())).collect()
    }
}

/// Warns about a secret file that other users on the machine can read.
pub(crate) fn warn_of_readers(file: &Path, console: &Console) {
    if disk::is_readable_by_others(file) {
        let place = shell::quoted(file);
        console.remark(format_args!(
            "warning: other users can read the secret in {place}; protect it with `chmod 600 {place}`"
        ));
    }
}

/// Opens a secret key, prompting for its password if the key is encrypted.
pub(crate) fn open_secret(file: &Path, password_file: Option<&Path>) -> Result<SecretKey, Failure> {
    let named = |error: TrustError| malformed!("`{}`: {error}", file.in_message());
    let text = read_bounded(file, MAX_KEY_FILE)?;
    let text = String::from_utf8_lossy(&text);
    let password = match is_encrypted(&text).map_err(named)? {
        true => Some(password(&format!("Password of {}: ", file.in_message()), password_file)?),
        false => None,
    };
    SecretKey::open(&text, password.as_deref()).map_err(named)
}

/// Reads a password: the first line of a file, or hidden input on the terminal.
pub(crate) fn password(prompt: &str, file: Option<&Path>) -> Result<String, Failure> {
    if let Some(file) = file {
        let Ok(text) = String::from_utf8(read_bounded(file, MAX_KEY_FILE)?) else {
            bail!("`{}` is not UTF-8: save the password as a UTF-8 text file", file.in_message());
        };
        return Ok(text.lines().next().unwrap_or_default().to_owned());
    }
    keep_echo();
    rpassword::prompt_password(prompt).map_err(|error| {
        if error.kind() == ErrorKind::Interrupted {
            // The signal is about to arrive, and ends the program unless it is ignored.
            std::thread::sleep(Duration::from_secs(2));
            return malformed!("no password was given: try again");
        }
        malformed!("there is no terminal to prompt for the password: use --password-file FILE")
    })
}

/// Ensures that the terminal echoes input again if Ctrl-C ends the program during a password prompt.
#[cfg(unix)]
fn keep_echo() {
    use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
    use std::sync::Once;
    static ONCE: Once = Once::new();
    let Ok(terminal) = std::fs::File::open("/dev/tty") else { return };
    let Ok(before) = tcgetattr(&terminal) else { return };
    ONCE.call_once(|| {
        let restore = move || {
            // The program is ending, so a failure is not reported.
            let _ = tcsetattr(&terminal, OptionalActions::Now, &before);
        };
        crate::interrupt::watch(restore, "interrupted: run the same command again to finish".to_owned());
    });
}

#[cfg(not(unix))]
fn keep_echo() {}

/// Converts the error. A missing or malformed file is a malformed question, and a disk failure is an
/// environment failure.
impl From<TrustError> for Failure {
    fn from(error: TrustError) -> Failure {
        match error {
            TrustError::Io { action: "read" | "list", ref path, ref source }
                if matches!(
                    source.kind(),
                    ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::IsADirectory
                ) =>
            {
                let shown = path.in_message();
                match source.kind() {
                    ErrorKind::IsADirectory => malformed!("`{shown}` is a folder: pass a file in it"),
                    _ => malformed!("`{shown}` does not exist: check the path"),
                }
            }
            TrustError::Io { action, ref path, ref source } if source.kind() == ErrorKind::NotADirectory => {
                malformed!(
                    "cannot {action} `{}`: there is a file where its folder should be; choose another folder",
                    path.in_message()
                )
            }
            TrustError::Io { .. } => Failure::Environment(error.into()),
            _ => Failure::Malformed(error.into()),
        }
    }
}
