//! A release as a single `.tar.zst` file that can be mailed, attached to papers, or identified by a single digest.
//!
//! The same folder always produces the same file, because every detail is fixed:
//!
//! - `<name>/MANIFEST.json` is the first entry, so that a reader knows what to expect. The items follow in the
//!   manifest's order. In a revealed release, the lists of withheld files come next, followed by the listed files,
//!   sorted.
//! - Each entry is a regular file with a ustar header: mode 0644; owner, group and time 0; no owner names. Folders
//!   and extensions do not occur. Two blocks of zeros end the tar archive.
//! - The tar archive is compressed into one zstd frame with a content size, a checksum and no dictionary. A skippable
//!   frame with the BLAKE3 hash of the compressed bytes follows, to detect accidental damage.
//!
//! [`Archive::open`] accepts exactly this form. Everything else that tar can express (links, devices, sparse
//! files, extended headers, duplicate names, other owners) differs from the expected header and is reported.
//! The digest covers the *uncompressed* bytes, because different versions of zstd may compress them
//! differently.
//!
//! Any `tar` unpacks such a file into one folder, named after the release.

mod entry;
mod frame;

use base::MessagePath;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use crate::contents::disclose::{LIST_LIMIT, disclose};
use crate::contents::integrity::{Integrity, check_integrity, manifest_problems};
use crate::contents::unfinished::refuse_unfinished;
use crate::contents::untracked::Untracked;
use crate::draft::Draft;
use crate::error::SnapshotError;
use crate::format::folder;
use crate::format::layout::HELD;
use crate::format::manifest::item::{Item, ReleaseKind};
use crate::format::manifest::withheld::HeldPart;
use crate::format::manifest::{MANIFEST_FILE, MANIFEST_LIMIT, Manifest};
use crate::format::problem::{Flaw, Problem};
use base::Digest;
use entry::{BLOCK, END, padding};
use frame::{FrameReader, FrameWriter, Unreadable};

pub use frame::is_archive;

/// The suffix of an archive's file name.
pub const ARCHIVE_END: &str = ".tar.zst";

/// The maximum unpacked size of an archive, in bytes: 512 MiB, because an archive is read into memory. Larger
/// releases must be distributed as folders.
pub const MAX_UNPACKED: u64 = 512 << 20;
/// The unpacked size that is allowed regardless of the packed size, in bytes: 16 MiB.
pub const FREE_UNPACKED: u64 = 16 << 20;
/// The maximum ratio of unpacked to packed bytes beyond [`FREE_UNPACKED`]. Releases stay below 30.
pub const MAX_RATIO: u64 = 200;

/// The result of [`pack`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Packed {
    /// The packed release's root.
    pub root: Digest,
    /// The digest of the uncompressed bytes.
    pub digest: Digest,
    /// The number of uncompressed bytes.
    pub unpacked: u64,
    /// The size of the file, in bytes.
    pub size: u64,
    /// The number of papers (documents such as the licence) stored with the release. Papers are not packed.
    pub papers: usize,
}

/// Packs the release folder `root` into the file `out`, which must not exist yet. The same release produces the same
/// uncompressed bytes on every machine.
///
/// `out` appears only when it is complete. Until then, the data is stored in the folder of a [`Draft`],
/// `<out>.partial`. A stale folder of that name is replaced.
///
/// Cost: two passes over the files, and enough memory for one file.
///
/// # Errors
/// Returns an error if the folder is not a release or differs from its manifest. Also returns an error if the release
/// exceeds the archive limits ([`MAX_UNPACKED`], [`MAX_RATIO`]) or has a path that tar cannot represent, if `out`
/// exists, or if a file system operation fails.
pub fn pack(root: &Path, out: &Path) -> Result<Packed, SnapshotError> {
    refuse_unfinished(root)?;
    let integrity = check_integrity(root)?;
    integrity.require_sound(root)?;
    let (manifest, papers) = (integrity.manifest, integrity.beside.papers.len());
    if fs::symlink_metadata(out).is_ok() {
        return Err(SnapshotError::Taken(out.to_path_buf()));
    }
    let draft = Draft::create(out)?;
    let (mut file, partial) = draft.single()?;
    let packed = pack_into(root, &manifest, &mut file, &partial)?;
    drop(file);
    draft.commit_single()?;
    Ok(Packed { papers, ..packed })
}

fn pack_into(
    root: &Path,
    manifest: &Manifest,
    file: &mut File,
    partial: &Path,
) -> Result<Packed, SnapshotError> {
    let is_held = |item: &&Item| item.path.starts_with(HELD) && !folder::join(root, &item.path).exists();
    if manifest.is_hiding()
        || manifest.kind == ReleaseKind::Sealed && manifest.items.iter().any(|item| is_held(&item))
    {
        return Err(SnapshotError::HeldBack(root.to_path_buf()));
    }
    let bytes = manifest.to_bytes()?;
    let top = Item::of(MANIFEST_FILE, &bytes);
    let files = || [&top].into_iter().chain(manifest.in_archive_order());
    let unpacked = entry::total(files());
    let too_large = |limit| SnapshotError::TooLarge { path: root.to_path_buf(), limit };
    if unpacked > MAX_UNPACKED {
        return Err(too_large(MAX_UNPACKED));
    }
    let io = |source| SnapshotError::io("write", partial)(source);
    let mut writer = FrameWriter::begin(file, unpacked).map_err(io)?;
    let mut hasher = blake3::Hasher::new();
    let mut put = |bytes: &[u8]| {
        hasher.update(bytes);
        writer.write(bytes).map_err(io)
    };
    for item in files() {
        let header = entry::header(&manifest.name, item)
            .ok_or_else(|| SnapshotError::Untarable(format!("{}/{}", manifest.name, item.path)))?;
        let content = match item.path == MANIFEST_FILE {
            true => bytes.clone(),
            false => folder::read(root, &item.path, item.size)?,
        };
        if Digest::of(&content) != item.digest {
            return Err(SnapshotError::Changed(folder::join(root, &item.path)));
        }
        put(&header)?;
        put(&content)?;
        put(&[0; BLOCK][..padding(item.size)])?;
    }
    put(&[0; END])?;
    writer.seal().map_err(io)?;
    file.sync_all().map_err(io)?;
    let size = file.metadata().map_err(io)?.len();
    if unpacked > most(size) {
        return Err(too_large(most(size)));
    }
    Ok(Packed {
        root: manifest.root,
        digest: Digest::from_bytes(*hasher.finalize().as_bytes()),
        unpacked,
        size,
        papers: 0,
    })
}

/// Returns the maximum unpacked size of an archive of `size` bytes.
fn most(size: u64) -> u64 {
    FREE_UNPACKED.saturating_add(size.saturating_mul(MAX_RATIO)).min(MAX_UNPACKED)
}

/// The result of reading an archive: its manifest, its files, and all problems found.
#[derive(Debug, Clone)]
pub struct Archive {
    /// The manifest, and the problems as [`check_integrity`] reports them. Reading stops at the first fault in the
    /// structure of the archive itself.
    pub integrity: Integrity,
    /// The digest of the uncompressed bytes that were read. A sound archive is read completely.
    pub digest: Digest,
    /// The number of uncompressed bytes read.
    pub unpacked: u64,
    manifest_bytes: Vec<u8>,
    files: BTreeMap<String, Vec<u8>>,
}

impl Archive {
    /// Reads an untrusted archive. Nothing is unpacked to disk. Before anything is decompressed, the amount to read
    /// is limited in proportion to the file's size ([`MAX_RATIO`]).
    ///
    /// Cost: one pass, and memory for the content, up to [`MAX_UNPACKED`] plus a window of 8 MiB.
    ///
    /// # Errors
    /// Returns an error if the file is not a zstd file: [`NotASnapshot`](SnapshotError::NotASnapshot), or
    /// [`Archive`](SnapshotError::Archive) if the file is named like an archive. Also returns an error if the archive
    /// is damaged before the end of the manifest ([`Archive`](SnapshotError::Archive)), if the manifest is
    /// inconsistent, or if the file cannot be read.
    pub fn open(path: &Path) -> Result<Archive, SnapshotError> {
        Archive::read(path, true)
    }

    /// Checks an archive like [`Archive::open`], without keeping its files in memory.
    ///
    /// Cost: one pass, and memory for the manifest and one file.
    ///
    /// # Errors
    /// See [`Archive::open`].
    pub fn check(path: &Path) -> Result<Integrity, SnapshotError> {
        Archive::read(path, false).map(|archive| archive.integrity)
    }

    /// Reads an archive. If `keep` is set, also stores the content of its files.
    fn read(path: &Path, keep: bool) -> Result<Archive, SnapshotError> {
        let io = |source| SnapshotError::io("read", path)(source);
        let broken = |message: String| SnapshotError::Archive { path: path.to_path_buf(), message };
        // This is checked before opening, because opening a pipe would wait for its other end.
        let found = fs::metadata(path).map_err(SnapshotError::io("examine", path))?;
        if !found.is_file() {
            return Err(SnapshotError::ReleaseKind { path: path.to_path_buf(), expected: "file" });
        }
        if !is_archive(path)? {
            return Err(match is_called_archive(path) {
                true => broken(
                    "the file does not begin with an archive header: fetch the archive again".to_owned(),
                ),
                false => SnapshotError::NotASnapshot(path.to_path_buf()),
            });
        }
        let file = File::open(path).map_err(io)?;
        let unreadable = |error, place: &str| match error {
            Unreadable::Io(source) => io(source),
            Unreadable::Damaged(message) => broken(format!("{place}{message}")),
        };
        let mut reader = FrameReader::open(file, most(found.len())).map_err(|error| unreadable(error, ""))?;
        let (name, manifest_bytes) =
            read_manifest(&mut reader).map_err(|error| unreadable(error, &format!("{MANIFEST_FILE}: ")))?;
        let place = PathBuf::from(format!("{}: {MANIFEST_FILE}", path.in_message()));
        let mut manifest = Manifest::parse(&manifest_bytes).map_err(|error| error.in_manifest(&place))?;
        let mut problems = manifest_problems(&manifest, &manifest_bytes)?;
        if name != manifest.name {
            let what = format!(
                "the folder is called `{}`, but the release is called `{}`",
                name.escape_debug(),
                manifest.name
            );
            problems.push(Problem { path: MANIFEST_FILE.into(), flaw: Flaw::NotAsPacked(what) });
        }
        let mut files = BTreeMap::new();
        let take = |path: &str, content| {
            if keep {
                files.insert(path.to_owned(), content);
            }
        };
        match read_items(&mut reader, &mut manifest, take, &mut problems) {
            Ok(()) => {}
            Err(Stop::Problem(problem)) if problem.path == WHOLE => {
                let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                problems.push(Problem { path: file, ..problem });
            }
            Err(Stop::Problem(problem)) => problems.push(problem),
            Err(Stop::Io(source)) => return Err(io(source)),
        }
        problems.sort_unstable();
        let (digest, unpacked) = reader.digest();
        Ok(Archive {
            integrity: Integrity { manifest, problems, beside: Untracked::default() },
            digest,
            unpacked,
            manifest_bytes,
            files,
        })
    }

    /// Returns the content of the item at `path`; `None` if the item does not exist or the archive ends before it.
    pub fn file(&self, path: &str) -> Option<&[u8]> {
        self.files.get(path).map(Vec::as_slice)
    }

    /// Writes the release to the folder `out`, which must be absent or empty. Afterwards, the folder is
    /// either complete or absent.
    ///
    /// # Errors
    /// Returns an error if the archive is unsound, `out` is occupied, or a file system operation fails.
    pub fn unpack(&self, out: &Path) -> Result<(), SnapshotError> {
        self.integrity.require_sound(out)?;
        let draft = Draft::create(out)?;
        for (path, content) in &self.files {
            draft.write(path, content)?;
        }
        draft.write(MANIFEST_FILE, &self.manifest_bytes)?;
        draft.commit()
    }
}

/// Returns `true` if a path has the suffix of an archive. The suffix says nothing about the content.
pub(crate) fn is_called_archive(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(ARCHIVE_END))
}

/// Returns `true` if the regular file at `path` is not a release archive, not even a damaged one. Such a file does not
/// end with a hash of its content, and its first entry is not a manifest. If the first entry cannot be decompressed,
/// the file must also lack the frame header of an archive.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub(crate) fn is_foreign(path: &Path) -> Result<bool, SnapshotError> {
    if frame::is_sealed(path)? {
        return Ok(false);
    }
    let Some(block) = frame::first_block(path)? else { return Ok(!frame::begins_as_packed(path)?) };
    let first = entry::path_and_size(&block).map(|(path, _)| path).unwrap_or_default();
    Ok(first != MANIFEST_FILE && !first.ends_with(&format!("/{MANIFEST_FILE}")))
}

/// Reads the top folder's name and the manifest's bytes.
fn read_manifest(reader: &mut FrameReader) -> Result<(String, Vec<u8>), Unreadable> {
    let block = reader.block()?.ok_or_else(|| Unreadable::Damaged("the archive is empty".to_owned()))?;
    let (path, size) = entry::path_and_size(&block).map_err(Unreadable::Damaged)?;
    let name = path.strip_suffix(MANIFEST_FILE).and_then(|folder| folder.strip_suffix('/'));
    let name = name.filter(|name| !name.contains('/') && crate::check_path(name).is_ok());
    let name = name.ok_or_else(|| {
        Unreadable::Damaged(format!(
            "the manifest must come first, but the first entry is `{}`",
            path.escape_debug()
        ))
    })?;
    if size > MANIFEST_LIMIT {
        return Err(Unreadable::Damaged(format!("the manifest is larger than {MANIFEST_LIMIT} bytes")));
    }
    let expected = Item { path: MANIFEST_FILE.into(), size, digest: Digest::of(b"") };
    if entry::header(name, &expected).as_ref() != Some(&block) {
        return Err(Unreadable::Damaged(entry::describe_difference(&block)));
    }
    Ok((name.to_owned(), reader.file(size)?))
}

/// The placeholder path for a problem with the archive as a whole, replaced later by the archive's name.
const WHOLE: &str = ".";

/// A reason to stop reading early.
enum Stop {
    Problem(Problem),
    Io(std::io::Error),
}

fn read_items(
    reader: &mut FrameReader,
    manifest: &mut Manifest,
    mut take: impl FnMut(&str, Vec<u8>),
    problems: &mut Vec<Problem>,
) -> Result<(), Stop> {
    read_listed(reader, manifest, manifest.items.iter(), &mut take, problems)?;
    if manifest.withheld.is_some() {
        for part in HeldPart::ALL {
            let (list, content) = read_list(reader, manifest, part)?;
            if let Err(flaw) = disclose(manifest, part, &content) {
                return Err(Stop::Problem(Problem { path: list, flaw }));
            }
            take(&list, content);
        }
        read_listed(reader, manifest, manifest.withheld_files(), &mut take, problems)?;
    }
    for _ in 0..END / BLOCK {
        match reader.block().map_err(stop(WHOLE))? {
            None => return Err(at(WHOLE, Flaw::NotAsPacked("the archive is truncated".into()))),
            Some(block) if block.iter().any(|byte| *byte != 0) => {
                return Err(Stop::Problem(entry::diagnose(&block, manifest, None)));
            }
            Some(_) => {}
        }
    }
    reader.finish().map_err(stop(WHOLE))
}

fn at(path: &str, flaw: Flaw) -> Stop {
    Stop::Problem(Problem { path: path.to_owned(), flaw })
}

/// Returns a closure for `map_err` that converts an [`Unreadable`] at `path` into the reason to stop.
fn stop(path: &str) -> impl FnOnce(Unreadable) -> Stop {
    let path = path.to_owned();
    move |unreadable| match unreadable {
        Unreadable::Io(source) => Stop::Io(source),
        Unreadable::Damaged(what) => Stop::Problem(Problem { path, flaw: Flaw::NotAsPacked(what) }),
    }
}

/// Reads the list of the files in one withheld part. The entry's header states the size of the list.
fn read_list(
    reader: &mut FrameReader,
    manifest: &Manifest,
    part: HeldPart,
) -> Result<(String, Vec<u8>), Stop> {
    let path = part.list();
    let block = match reader.block().map_err(stop(path))? {
        Some(block) if block.iter().any(|byte| *byte != 0) => block,
        _ => return Err(at(path, Flaw::Missing)),
    };
    let size = entry::path_and_size(&block).map_or(0, |(_, size)| size);
    let item = Item { path: path.to_owned(), size: size.min(LIST_LIMIT), digest: Digest::of(b"") };
    if entry::header(&manifest.name, &item).as_ref() != Some(&block) {
        return Err(Stop::Problem(entry::diagnose(&block, manifest, Some(&item))));
    }
    let content = reader.file(item.size).map_err(stop(path))?;
    Ok((item.path, content))
}

/// Reads the files listed in the manifest.
fn read_listed<'a>(
    reader: &mut FrameReader,
    manifest: &Manifest,
    items: impl Iterator<Item = &'a Item>,
    take: &mut impl FnMut(&str, Vec<u8>),
    problems: &mut Vec<Problem>,
) -> Result<(), Stop> {
    for item in items {
        let path = item.path.as_str();
        let block = match reader.block().map_err(stop(path))? {
            Some(block) if block.iter().any(|byte| *byte != 0) => block,
            _ => return Err(at(path, Flaw::Missing)),
        };
        let Some(expected) = entry::header(&manifest.name, item) else {
            return Err(at(path, Flaw::NotAsPacked("the path is too long for an archive".into())));
        };
        if block != expected {
            return Err(Stop::Problem(entry::diagnose(&block, manifest, Some(item))));
        }
        let content = reader.file(item.size).map_err(stop(path))?;
        let found = Digest::of(&content);
        if found != item.digest {
            let flaw = Flaw::Altered { found, stated: item.digest };
            problems.push(Problem { path: path.to_owned(), flaw });
        }
        take(path, content);
    }
    Ok(())
}
