//! Archive entries: the only header that a release file may have, and the diagnostics for any other header.

use crate::format::manifest::item::Item;
use crate::format::manifest::{MANIFEST_FILE, Manifest};
use crate::format::path::check_path;
use crate::format::problem::{Flaw, Problem};
use tar::{EntryType, Header};

/// The size of a block, in bytes. A header takes one block, and content is padded to whole blocks.
pub(super) const BLOCK: usize = 512;
/// The number of zero bytes at the end of an archive.
pub(super) const END: usize = 2 * BLOCK;

/// Returns the header of `item` in the release called `name`, or `None` if the path is too long for a header.
pub(super) fn header(name: &str, item: &Item) -> Option<[u8; BLOCK]> {
    let mut header = Header::new_ustar();
    header.set_path(format!("{name}/{}", item.path)).ok()?;
    header.set_size(item.size);
    header.set_mode(0o644);
    header.set_uid(0);
    header.set_gid(0);
    header.set_mtime(0);
    header.set_entry_type(EntryType::Regular);
    header.set_cksum();
    Some(*header.as_bytes())
}

/// Returns the number of zero bytes that follow `size` bytes of content.
pub(super) fn padding(size: u64) -> usize {
    let rest = (size % BLOCK as u64) as usize;
    if rest == 0 { 0 } else { BLOCK - rest }
}

/// Returns the uncompressed size of an archive of the given files, in bytes.
pub(super) fn total<'a>(items: impl Iterator<Item = &'a Item>) -> u64 {
    let sizes = items.map(|item| BLOCK as u64 + item.size + padding(item.size) as u64);
    sizes.sum::<u64>() + END as u64
}

/// Parses the path and the size from a header.
pub(super) fn path_and_size(block: &[u8; BLOCK]) -> Result<(String, u64), String> {
    let header = Header::from_byte_slice(block);
    let size = header.size().map_err(|_| "the tar header is damaged".to_owned())?;
    Ok((path(header), size))
}

/// Diagnoses a header that differs from the header of `expected`, or any header if no further item is
/// expected. The problem is reported under the entry's own path if that path is usable.
pub(super) fn diagnose(block: &[u8; BLOCK], manifest: &Manifest, expected: Option<&Item>) -> Problem {
    let header = Header::from_byte_slice(block);
    let full = path(header);
    let inner = full.strip_prefix(&manifest.name).and_then(|rest| rest.strip_prefix('/'));
    let due = expected.map_or(".", |item| item.path.as_str());
    let found = inner.unwrap_or(&full);
    let here = |flaw| Problem { path: found.to_owned(), flaw };
    let there = |flaw| Problem { path: due.to_owned(), flaw };
    if !has_valid_checksum(header) {
        return there(Flaw::NotAsPacked("the tar header here is damaged".into()));
    }
    match header.entry_type() {
        EntryType::Symlink => return here(Flaw::Link),
        EntryType::Char | EntryType::Block | EntryType::Fifo => return here(Flaw::Special),
        EntryType::Regular => {}
        _ => return there(Flaw::NotAsPacked(describe_difference(block))),
    }
    if let Err(problem) = check_path(found) {
        return here(Flaw::Name(problem));
    }
    if inner.is_none() {
        return here(Flaw::NotAsPacked(format!("the entry is not in the folder `{}`", manifest.name)));
    }
    if Some(found) == expected.map(|item| item.path.as_str()) {
        return match (header.size(), expected) {
            (Ok(size), Some(item)) if size != item.size => {
                here(Flaw::Size { found: size, stated: item.size })
            }
            _ => here(Flaw::NotAsPacked(describe_difference(block))),
        };
    }
    let listed = found == MANIFEST_FILE || manifest.files().any(|item| item.path == found);
    let passed = expected.is_none_or(|item| found == MANIFEST_FILE || found < item.path.as_str());
    match (listed, passed) {
        (false, _) => here(Flaw::Extra),
        (true, true) => here(Flaw::NotAsPacked("the entry occurs twice in the archive".into())),
        (true, false) => {
            here(Flaw::NotAsPacked(format!("the entry is out of order: `{due}` was expected here")))
        }
    }
}

/// Describes how a header differs from one written by [`header`].
pub(super) fn describe_difference(block: &[u8; BLOCK]) -> String {
    let header = Header::from_byte_slice(block);
    let kind = header.entry_type();
    let what = match kind {
        EntryType::Regular => "the tar header has an unexpected owner, mode, time or format",
        EntryType::Link => "a hard link",
        EntryType::Symlink => "a symbolic link",
        EntryType::Directory => "a folder, although archives list only files",
        EntryType::Char | EntryType::Block | EntryType::Fifo => "a device or pipe",
        EntryType::GNUSparse => "a sparse file",
        EntryType::GNULongName | EntryType::GNULongLink => "a GNU extension for long names",
        EntryType::XHeader | EntryType::XGlobalHeader => "a pax extension header",
        EntryType::Continuous => "a contiguous file",
        other => return format!("a tar entry of unknown kind {:#04x}", other.as_byte()),
    };
    let link = header.link_name_bytes().map(|target| String::from_utf8_lossy(&target).into_owned());
    match link {
        Some(target) => format!("{what} to `{}`", target.escape_debug()),
        None => what.to_owned(),
    }
}

/// Returns the path in a header, with invalid UTF-8 replaced.
fn path(header: &Header) -> String {
    String::from_utf8_lossy(&header.path_bytes()).into_owned()
}

/// Returns `true` if a header's checksum is correct.
fn has_valid_checksum(header: &Header) -> bool {
    let mut copy = header.clone();
    copy.set_cksum();
    header.cksum().ok().is_some_and(|stated| copy.cksum().ok() == Some(stated))
}
