//! Folders with signed documents: statements and key sets. Signers write the documents, and readers check
//! them without trusting the folder.

use crate::error::TrustError;
use crate::key::{MAX_KEY_FILE, PublicKey, SecretKey};
use crate::key_set::{KeySet, NamedKey};
use crate::statement::Statement;
use base::Digest;
use base::MessagePath;
use disk::{Access, Disk};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// The maximum number of files to read from a folder.
const MAX_FILES: usize = 1000;
/// The maximum size of a document, in bytes.
const MAX_DOCUMENT: u64 = 1 << 16;
/// The file name suffix of signature files.
const SIGNATURE_END: &str = ".minisig";

/// A root of trust, which the user must obtain from a source other than the signed documents.
#[derive(Clone, Debug)]
pub enum Anchor {
    /// A single key, which must sign every release.
    Key(PublicKey),
    /// A key set, which later sets can replace.
    Set(Box<KeySet>),
}

impl Anchor {
    /// Parses an anchor, which is a trusted public key or a trusted key set.
    ///
    /// # Errors
    /// Returns an error if the bytes are neither a public key nor a key set.
    pub fn parse(bytes: &[u8], place: &str) -> Result<Anchor, TrustError> {
        const NEXT_STEP: &str =
            "pass the NAME.pub from `arcade trust keygen`, or the keys-N.json from `arcade trust keys`";
        if bytes.starts_with(b"{") {
            let set = KeySet::parse(bytes, place).map_err(|error| match error {
                TrustError::Document { place, fault } => {
                    TrustError::Document { place, fault: format!("{fault}; {NEXT_STEP}") }
                }
                other => other,
            });
            return Ok(Anchor::Set(Box::new(set?)));
        }
        let text = std::str::from_utf8(bytes).unwrap_or_default();
        match PublicKey::parse(text) {
            Ok(key) => Ok(Anchor::Key(key)),
            Err(_) => Err(TrustError::document(
                place,
                format!("is neither a minisign public key nor a set of keys: {NEXT_STEP}"),
            )),
        }
    }
}

/// The result of checking a root's signatures.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Signed {
    /// The names of the signing keys, or the identifier if the anchor is a single key.
    pub signers: Vec<String>,
    /// The number of keys that must sign.
    pub threshold: u32,
    /// The version number of the newest trusted key set, if the anchor is a set.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keys: Option<u32>,
    /// The source code commit, as stated in the signed statement; `None` if it states none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// The digest of `Cargo.lock`, as stated in the signed statement; `None` without such a statement. No root covers
    /// `Cargo.lock`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lockfile: Option<Digest>,
    /// The reasons why the root is not signed as required; empty if it is.
    pub problems: Vec<String>,
}

/// The signed documents in a folder.
#[derive(Clone, Debug, Default)]
pub struct Signatures {
    /// The key sets, by file name. If a set cannot be read, the error is stored instead.
    sets: BTreeMap<String, Result<KeySet, String>>,
    /// The statements, by file name. If a statement cannot be read, the error is stored instead.
    statements: BTreeMap<String, Result<Statement, String>>,
    /// The signatures, by the name of the signed file.
    signatures: BTreeMap<String, Vec<String>>,
}

impl Signatures {
    /// Reads the signed documents in a folder. Ignores other files.
    ///
    /// # Errors
    /// Returns an error if the folder or a document cannot be read.
    pub fn read(folder: &Path) -> Result<Signatures, TrustError> {
        let mut found = Signatures::default();
        let mut names = BTreeSet::new();
        for entry in fs::read_dir(folder).map_err(TrustError::io("list", folder))? {
            let entry = entry.map_err(TrustError::io("list", folder))?;
            let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
            let Some(name) = entry.file_name().to_str().map(str::to_owned) else { continue };
            let document = name.strip_suffix(SIGNATURE_END).unwrap_or(&name);
            if is_file && (document.starts_with("keys-") || document.starts_with("root-")) {
                names.insert(name);
            }
            if names.len() > MAX_FILES {
                return Err(TrustError::document(folder.in_message().to_string(), "has too many files"));
            }
        }
        for name in names {
            let path = folder.join(&name);
            let bytes = read_bounded(&path, MAX_DOCUMENT)?;
            if let Some(signed) = name.strip_suffix(SIGNATURE_END) {
                // Signature files are named NAME.json.IDENTIFIER.minisig, or NAME.json.minisig as minisign
                // does.
                let end = signed.find(".json").map_or(signed.len(), |at| at + ".json".len());
                let text = String::from_utf8_lossy(&bytes).into_owned();
                found.signatures.entry(signed[..end].to_owned()).or_default().push(text);
            } else if name.starts_with("keys-") {
                let set = KeySet::parse(&bytes, &name).map_err(|error| error.to_string());
                found.sets.insert(name, set);
            } else {
                let statement = Statement::parse(&bytes, &name).map_err(|error| error.to_string());
                found.statements.insert(name, statement);
            }
        }
        Ok(found)
    }

    /// Returns the files for all key sets up to the number `newest`, with their signatures. The order is safe
    /// for copying, because each set comes after its signatures.
    ///
    /// # Errors
    /// Returns an error if the folder or a file cannot be read.
    pub fn files_of_sets(folder: &Path, newest: u32) -> Result<Vec<(String, Vec<u8>)>, TrustError> {
        let mut names = BTreeSet::new();
        for entry in fs::read_dir(folder).map_err(TrustError::io("list", folder))? {
            let entry = entry.map_err(TrustError::io("list", folder))?;
            let Some(name) = entry.file_name().to_str().map(str::to_owned) else { continue };
            let number = name
                .strip_prefix("keys-")
                .and_then(|rest| rest.split_once(".json"))
                .map(|(number, _)| number);
            if let Some(number) =
                number.and_then(|number| number.parse::<u32>().ok()).filter(|n| *n <= newest)
            {
                names.insert((number, !name.ends_with(SIGNATURE_END), name));
            }
        }
        // The signatures of a set come before the set, because `false` sorts before `true`.
        let read = |(_, _, name): (u32, bool, String)| {
            Ok((name.clone(), read_bounded(&folder.join(&name), MAX_DOCUMENT)?))
        };
        names.into_iter().map(read).collect()
    }

    /// Returns the signatures for the document with the given file name.
    pub fn of(&self, file: &str) -> &[String] {
        self.signatures.get(file).map_or(&[], Vec::as_slice)
    }

    /// Returns the key set with the given number; `None` if there is no such set. The set must not be trusted as it is,
    /// because anyone may have written it.
    pub fn set(&self, version: u32) -> Option<&KeySet> {
        self.sets.get(&format!("keys-{version}.json")).and_then(|set| set.as_ref().ok())
    }

    /// Returns the newest set in the chain of valid sets that starts with a trusted set (the anchor). Adds the reason
    /// why the chain ends to `problems`, if the next set exists but is invalid.
    fn newest(&self, anchor: &KeySet, problems: &mut Vec<String>) -> KeySet {
        let mut newest = anchor.clone();
        // The loop terminates, because each set has a higher number than the previous set, and a separate
        // file.
        while let Some(next) = self.sets.get(&format!("keys-{}.json", newest.version.saturating_add(1))) {
            match next {
                Ok(next) => match newest.admits(next, self.of(&next.file())) {
                    Ok(()) => newest = next.clone(),
                    Err(reasons) => {
                        problems.extend(reasons);
                        break;
                    }
                },
                Err(fault) => {
                    problems.push(fault.clone());
                    break;
                }
            }
        }
        newest
    }

    /// Returns the set with the given number and digest, if it is an ancestor of the trusted set `newest`.
    fn ancestor(&self, newest: &KeySet, version: u32, digest: Digest) -> Option<KeySet> {
        let mut set = newest.clone();
        while set.version > version {
            let (previous, stated) = (self.set(set.version - 1)?, set.previous?);
            if previous.digest().ok()? != stated {
                return None;
            }
            set = previous.clone();
        }
        (set.version == version && set.digest().ok()? == digest).then_some(set)
    }

    /// Checks that a release's root is signed as the given anchor (a trusted key or key set) requires.
    pub fn judge(&self, release: &str, root: &Digest, anchor: &Anchor) -> Signed {
        let mut faults = Vec::new();
        let mut best: Option<Signed> = None;
        for (file, statement) in &self.statements {
            let statement = match statement {
                Ok(statement) => statement,
                Err(fault) => {
                    faults.push(fault.clone());
                    continue;
                }
            };
            if statement.root != *root || statement.release != release {
                let (name, other) = (&statement.release, statement.root);
                faults.push(format!(
                    "{file}: the statement is about a different release, `{name}` with root {other}"
                ));
                continue;
            }
            let signed = self.judge_statement(file, statement, anchor);
            if signed.problems.is_empty() {
                return signed;
            }
            best = best.or(Some(signed));
        }
        best.unwrap_or_else(|| {
            let mut problems = vec![format!("no signed statement says that `{release}` has the root {root}")];
            problems.extend(faults);
            Signed { problems, ..Signed::default() }
        })
    }

    /// Returns the digest of a statement about the given root, or `None` if no statement exists. Among
    /// several statements, the one with the most signatures is used.
    ///
    /// # Errors
    /// Never returns an error, because a statement is plain data.
    pub fn statement_of(&self, root: &Digest) -> Result<Option<Digest>, TrustError> {
        let about = |(file, statement): (&String, &Result<Statement, String>)| {
            let statement = statement.as_ref().ok().filter(|statement| statement.root == *root)?;
            Some((self.of(file).len(), statement.clone()))
        };
        let most = self.statements.iter().filter_map(about).max_by_key(|(count, _)| *count);
        most.map(|(_, statement)| Ok(Digest::of(&statement.to_bytes()?))).transpose()
    }

    /// Checks a single statement in the folder, like [`Signatures::judge`].
    pub fn judge_file(&self, file: &str, anchor: &Anchor) -> Signed {
        match self.statements.get(file) {
            Some(Ok(statement)) => self.judge_statement(file, statement, anchor),
            Some(Err(fault)) => Signed { problems: vec![fault.clone()], ..Signed::default() },
            None => Signed {
                problems: vec![format!("{file}: the statement does not exist")],
                ..Signed::default()
            },
        }
    }

    fn judge_statement(&self, file: &str, statement: &Statement, anchor: &Anchor) -> Signed {
        let commit = statement.provenance.commit.clone();
        let lockfile = Some(statement.provenance.lockfile);
        let refuse = |problems: Vec<String>, newest: Option<&KeySet>| {
            let (keys, commit) = (newest.map(|set| set.version), commit.clone());
            Signed { problems, keys, commit, lockfile, ..Signed::default() }
        };
        let Ok(message) = statement.to_bytes() else {
            return refuse(vec![format!("{file}: the statement is not in canonical form")], None);
        };
        let mut problems = Vec::new();
        let (set, newest) = match anchor {
            Anchor::Key(key) => {
                let alone = single(key);
                // If a set contains the key, the set determines who may replace the key.
                let sets = self.sets.values().filter_map(|set| set.as_ref().ok());
                let with = sets.filter(|set| set.keys.iter().any(|named| named.key == key.to_base64()));
                let newest = with.min_by_key(|set| set.version).map(|set| self.newest(set, &mut problems));
                (alone, newest)
            }
            Anchor::Set(anchor) => {
                let newest = self.newest(anchor, &mut problems);
                let Some(keys) = statement.keys else {
                    problems.push(format!(
                        "{file}: the statement does not specify a set of keys, so it may be outdated"
                    ));
                    return refuse(problems, Some(&newest));
                };
                let Some(set) = self.ancestor(&newest, keys.version, keys.digest) else {
                    problems.push(format!(
                        "{file}: the statement specifies the set of keys {} with digest {}, which is not \
                         connected to the set that you trust, {} ({})",
                        keys.version,
                        keys.digest,
                        anchor.version,
                        anchor.digest().map_or_else(|_| String::new(), |digest| digest.to_string())
                    ));
                    return refuse(problems, Some(&newest));
                };
                // The threshold of an earlier set may have been lower, and its keys may be retired.
                let found = newest.signers(&message, self.of(file));
                if (found.names.len() as u32) < newest.threshold {
                    problems.push(format!(
                        "{file}: signed by {} of the newest set of keys ({}), but {} must sign: sign it again \
                         under that set",
                        found.listed(),
                        newest.version,
                        newest.threshold
                    ));
                }
                (set, Some(newest))
            }
        };
        let (counting, gone) = match &newest {
            Some(newest) => set.unrevoked(newest),
            None => (set.clone(), Vec::new()),
        };
        let signers = counting.signers(&message, self.of(file));
        if let (Anchor::Key(key), true) = (anchor, signers.names.is_empty()) {
            let others: Vec<String> =
                self.of(file).iter().filter_map(|text| crate::key::signer_of(text)).collect();
            let others = match others.as_slice() {
                [] => "there is no signature next to the statement".to_owned(),
                ids => format!("the signatures next to the statement are by {}", ids.join(", ")),
            };
            problems.push(format!(
                "{file}: not signed by the key {}; {others}{}{}",
                key.id(),
                signers.excuse(),
                gone.iter().map(|gone| format!("; {gone}")).collect::<String>()
            ));
        } else if (signers.names.len() as u32) < set.threshold {
            problems.push(format!(
                "{file}: signed by {}, but {} of {} must sign{}{}",
                signers.listed(),
                set.threshold,
                set.keys.iter().map(|key| key.name.as_str()).collect::<Vec<_>>().join(", "),
                signers.excuse(),
                gone.iter().map(|gone| format!("; {gone}")).collect::<String>()
            ));
        }
        let keys = newest.map(|newest| newest.version);
        Signed { signers: signers.names, threshold: set.threshold, keys, commit, lockfile, problems }
    }
}

/// Returns a set that contains a single key, whose identifier serves as its name.
fn single(key: &PublicKey) -> KeySet {
    let keys = vec![NamedKey { name: key.id(), key: key.to_base64() }];
    KeySet { format: 1, version: 1, threshold: 1, keys, revoked: Vec::new(), previous: None }
}

/// Signs a document with each of the keys, and writes the document and its signatures to a folder. Returns
/// the names of the written files.
///
/// The signatures are written before the document. A document that exists therefore has all signatures from
/// the run that wrote it. Existing valid signatures are kept.
///
/// # Errors
/// Returns an error if a file system operation fails, or if the system provides no random bytes.
pub fn sign_into(
    folder: &Path,
    file: &str,
    document: &[u8],
    comment: &str,
    secrets: &[SecretKey],
    disk: &Disk,
) -> Result<Vec<String>, TrustError> {
    let mut written = Vec::new();
    for secret in secrets {
        let public = secret.public();
        let name = format!("{file}.{}{SIGNATURE_END}", public.id());
        let path = folder.join(&name);
        let holds = read_bounded(&path, MAX_KEY_FILE)
            .is_ok_and(|found| public.verify(document, &String::from_utf8_lossy(&found)).is_ok());
        if holds {
            continue;
        }
        let signature = secret.sign(document, comment)?;
        write_document(&path, signature.as_bytes(), disk)?;
        written.push(name);
    }
    let path = folder.join(file);
    if read_bounded(&path, MAX_DOCUMENT).is_ok_and(|found| found == document) {
        return Ok(written);
    }
    write_document(&path, document, disk)?;
    written.push(file.to_owned());
    Ok(written)
}

/// Writes a file atomically. Creates the file's folder if it does not exist.
pub(crate) fn write_document(path: &Path, bytes: &[u8], disk: &Disk) -> Result<(), TrustError> {
    let written = disk.create_folder(path.parent().unwrap_or(Path::new("")));
    written.and_then(|()| disk.write(path, bytes, Access::Shared)).map_err(TrustError::io("write", path))
}

/// Reads a file of at most `limit` bytes.
///
/// # Errors
/// Returns an error if the file cannot be read, or is larger than the limit.
pub fn read_bounded(path: &Path, limit: u64) -> Result<Vec<u8>, TrustError> {
    let shown = || path.in_message().to_string();
    match disk::read(path, limit) {
        Ok(Some(bytes)) => Ok(bytes),
        Ok(None) => Err(TrustError::document(
            shown(),
            format!("is larger than {limit} bytes, the limit for such a file: check the path"),
        )),
        Err(error) if error.kind() == ErrorKind::IsADirectory => {
            Err(TrustError::document(shown(), "is a folder: pass a file in it"))
        }
        Err(error) if error.kind() == ErrorKind::InvalidInput => {
            Err(TrustError::document(shown(), "is not a file: check the path"))
        }
        Err(error) => Err(TrustError::io("read", path)(error)),
    }
}
