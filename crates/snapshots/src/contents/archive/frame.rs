//! The container of an archive: one zstd frame, whose header bounds its size before decompression, and a seal, which is
//! a hash of the frame.
//!
//! Some bits of compressed data can be flipped without changing the content. To detect every flipped bit, the frame is
//! followed by a skippable frame (RFC 8878 §3.1.2) with the BLAKE3 hash of the preceding bytes. Every zstd reader
//! ignores the skippable frame.

use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::entry::{BLOCK, padding};
use crate::error::SnapshotError;
use base::Digest;

/// The first bytes of a zstd file (RFC 8878 §3.1.1).
const MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
/// The base-2 logarithm of the compressor's window size in bytes: 8 MiB, which every reader accepts.
const WINDOW_LOG: u8 = 23;
/// The compression level, which is high because an archive is compressed once but read often.
const LEVEL: i32 = 15;

/// Returns `true` if the regular file at `path` starts with the magic number of a zstd file, as archives do.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub fn is_archive(path: &Path) -> Result<bool, SnapshotError> {
    Ok(head(path)?.starts_with(&MAGIC))
}

/// Returns `true` if the regular file at `path` has the frame header written by [`pack`](super::pack).
///
/// # Errors
/// Returns an error if the file cannot be read.
pub(super) fn begins_as_packed(path: &Path) -> Result<bool, SnapshotError> {
    let head = head(path)?;
    Ok(head.starts_with(&MAGIC) && stated_size(&head).is_ok())
}

/// Reads the start of a file, up to the maximum length of a frame header: magic number, descriptor, window and size.
fn head(path: &Path) -> Result<Vec<u8>, SnapshotError> {
    let mut head = Vec::new();
    let read = File::open(path).and_then(|file| file.take(4 + 1 + 1 + 8).read_to_end(&mut head));
    read.map_err(SnapshotError::io("read", path))?;
    Ok(head)
}

/// The first bytes of the hash that follows the frame: the magic number of a skippable frame and its length, 32 bytes.
const SEAL: [u8; 8] = [0x50, 0x2a, 0x4d, 0x18, 32, 0, 0, 0];
/// The length of the hash that follows the frame, including its header, in bytes.
const SEAL_LENGTH: usize = SEAL.len() + 32;

/// Returns `true` if the regular file at `path` ends with a hash of its content (a seal), valid or not.
///
/// # Errors
/// Returns an error if the file cannot be read.
pub(super) fn is_sealed(path: &Path) -> Result<bool, SnapshotError> {
    let end = || -> io::Result<Vec<u8>> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(SEAL_LENGTH as u64)))?;
        let mut end = Vec::new();
        file.take(SEAL_LENGTH as u64).read_to_end(&mut end)?;
        Ok(end)
    };
    let end = end().map_err(SnapshotError::io("read", path))?;
    Ok(end.len() == SEAL_LENGTH && end.starts_with(&SEAL))
}

/// Decompresses the first block of the regular file at `path`, regardless of the tool that compressed the file;
/// `None` if the block cannot be decompressed.
///
/// # Errors
/// Returns an error if the file cannot be opened.
pub(super) fn first_block(path: &Path) -> Result<Option<[u8; BLOCK]>, SnapshotError> {
    let file = File::open(path).map_err(SnapshotError::io("read", path))?;
    let mut block = [0; BLOCK];
    let read = zstd::Decoder::new(file).and_then(|mut decoder| {
        decoder.window_log_max(u32::from(WINDOW_LOG))?;
        decoder.read_exact(&mut block)
    });
    Ok(read.is_ok().then_some(block))
}

/// A writer that compresses into a file.
pub(super) struct FrameWriter<'a> {
    encoder: zstd::Encoder<'static, Hashed<&'a mut File>>,
}

impl<'a> FrameWriter<'a> {
    /// Starts a frame for `size` bytes of content.
    pub(super) fn begin(file: &'a mut File, size: u64) -> io::Result<FrameWriter<'a>> {
        let mut encoder = zstd::Encoder::new(Hashed { inner: file, hasher: blake3::Hasher::new() }, LEVEL)?;
        encoder.window_log(u32::from(WINDOW_LOG))?;
        encoder.include_checksum(true)?;
        encoder.include_contentsize(true)?;
        encoder.set_pledged_src_size(Some(size))?;
        Ok(FrameWriter { encoder })
    }

    /// Compresses `bytes` into the frame.
    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.encoder.write_all(bytes)
    }

    /// Ends the frame and appends the hash of the preceding bytes.
    pub(super) fn seal(self) -> io::Result<()> {
        let Hashed { inner, hasher } = self.encoder.finish()?;
        inner.write_all(&SEAL)?;
        inner.write_all(hasher.finalize().as_bytes())
    }
}

/// A wrapper that hashes the bytes written to it or consumed from it.
struct Hashed<T> {
    inner: T,
    hasher: blake3::Hasher,
}

impl<T: Write> Write for Hashed<T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl Read for Hashed<BufReader<File>> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(bytes)?;
        self.hasher.update(&bytes[..read]);
        Ok(read)
    }
}

impl BufRead for Hashed<BufReader<File>> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.inner.fill_buf()
    }

    fn consume(&mut self, amount: usize) {
        self.hasher.update(&self.inner.buffer()[..amount]);
        self.inner.consume(amount);
    }
}

/// A reason why an archive cannot be read.
#[derive(Debug)]
pub(super) enum Unreadable {
    /// A file system operation failed.
    Io(io::Error),
    /// The archive does not have the form that [`pack`](super::pack) gives to archives.
    Damaged(String),
}

/// A reader of an archive's uncompressed bytes, up to the size stated in its frame.
pub(super) struct FrameReader {
    decoder: zstd::Decoder<'static, Hashed<BufReader<File>>>,
    hasher: blake3::Hasher,
    left: u64,
}

impl FrameReader {
    /// Reads the frame header, and rejects frames of more than `limit` bytes.
    pub(super) fn open(file: File, limit: u64) -> Result<FrameReader, Unreadable> {
        let mut file = Hashed { inner: BufReader::new(file), hasher: blake3::Hasher::new() };
        // The longest header has 4 + 1 + 1 + 8 bytes, and a freshly filled buffer holds at least that many, or the
        // whole file.
        let left = stated_size(file.fill_buf().map_err(Unreadable::Io)?).map_err(Unreadable::Damaged)?;
        if left > limit {
            return Err(Unreadable::Damaged(format!(
                "the archive would unpack to {left} bytes; the limit for a file of this size is {limit}"
            )));
        }
        let mut decoder = zstd::Decoder::with_buffer(file).map_err(Unreadable::Io)?.single_frame();
        decoder.window_log_max(u32::from(WINDOW_LOG)).map_err(Unreadable::Io)?;
        Ok(FrameReader { decoder, hasher: blake3::Hasher::new(), left })
    }

    /// Reads the next block; returns `None` at the end.
    pub(super) fn block(&mut self) -> Result<Option<[u8; BLOCK]>, Unreadable> {
        if self.left == 0 {
            return Ok(None);
        }
        let bytes = self.content(BLOCK as u64)?;
        Ok(Some(bytes.try_into().expect("the content has the requested length")))
    }

    /// Reads the next `size` bytes. Memory use grows with the bytes actually read, not with the stated size.
    pub(super) fn content(&mut self, size: u64) -> Result<Vec<u8>, Unreadable> {
        if size > self.left {
            return Err(Unreadable::Damaged("the archive is too short".into()));
        }
        let mut bytes = Vec::new();
        let read = (&mut self.decoder).take(size).read_to_end(&mut bytes).map_err(unreadable)?;
        if (read as u64) < size {
            return Err(Unreadable::Damaged("the archive is truncated here".into()));
        }
        self.left -= size;
        self.hasher.update(&bytes);
        Ok(bytes)
    }

    /// Reads a file of `size` bytes, and the zero padding of its last block.
    pub(super) fn file(&mut self, size: u64) -> Result<Vec<u8>, Unreadable> {
        let content = self.content(size)?;
        match self.content(padding(size) as u64)?.iter().all(|byte| *byte == 0) {
            true => Ok(content),
            false => Err(Unreadable::Damaged("the padding bytes are not zero".into())),
        }
    }

    /// Checks that the stated content, the frame and the file all end here.
    pub(super) fn finish(&mut self) -> Result<(), Unreadable> {
        let damaged = |what: &str| Err(Unreadable::Damaged(what.into()));
        if self.left > 0 || self.decoder.read(&mut [0]).map_err(unreadable)? > 0 {
            return damaged("there is extra data after the end of the archive");
        }
        // The decoder compares the checksum only here.
        self.decoder.finish_frame().map_err(unreadable)?;
        let file = self.decoder.get_mut();
        let compressed = *file.hasher.finalize().as_bytes();
        let mut seal = Vec::new();
        file.take(SEAL.len() as u64 + 33).read_to_end(&mut seal).map_err(Unreadable::Io)?;
        match seal.strip_prefix(&SEAL).map(|digest| (digest, digest.len())) {
            Some((digest, 32)) if digest == compressed => Ok(()),
            Some((_, 32)) => damaged("the compressed bytes do not match the seal"),
            Some((_, 33..)) => damaged("there are bytes after the seal"),
            _ => damaged("the seal is missing or damaged"),
        }
    }

    /// Returns the digest and the number of bytes read.
    pub(super) fn digest(&self) -> (Digest, u64) {
        (Digest::from_bytes(*self.hasher.finalize().as_bytes()), self.hasher.count())
    }
}

/// Converts an I/O error. An error without an OS error number means that the archive is damaged.
fn unreadable(error: io::Error) -> Unreadable {
    match (error.raw_os_error(), error.kind()) {
        (Some(_), _) => Unreadable::Io(error),
        (None, ErrorKind::UnexpectedEof) => Unreadable::Damaged("the archive is truncated here".into()),
        (None, _) => Unreadable::Damaged(format!("the compressed data is damaged here ({error})")),
    }
}

/// Parses the content size in a frame header (RFC 8878 §3.1.1.1). The header must have the form written by
/// [`FrameWriter::begin`].
fn stated_size(head: &[u8]) -> Result<u64, String> {
    let cut_off = || "the archive is truncated in its header".to_owned();
    let odd =
        |what: &str| Err(format!("the header of the compressed data differs from the packed form: {what}"));
    let descriptor = *head.get(MAGIC.len()).ok_or_else(cut_off)?;
    let (size_flag, one_segment) = (descriptor >> 6, descriptor & 0b10_0000 != 0);
    match descriptor & 0b1_1111 {
        0b0_0100 => {}
        bits if bits & 0b11 != 0 => return odd("a dictionary is required"),
        bits if bits & 0b100 == 0 => return odd("the checksum is missing"),
        _ => return odd("a reserved bit is set"),
    }
    let mut rest = &head[MAGIC.len() + 1..];
    if !one_segment {
        let window = *rest.first().ok_or_else(cut_off)?;
        if window != (WINDOW_LOG - 10) << 3 {
            return odd("the window is not 8 MiB");
        }
        rest = &rest[1..];
    }
    let length = match (size_flag, one_segment) {
        (0, false) => return odd("the size is not stated"),
        (0, true) => 1,
        (flag, _) => 1 << flag,
    };
    let mut bytes = [0; 8];
    bytes[..length].copy_from_slice(rest.get(..length).ok_or_else(cut_off)?);
    // Two-byte sizes are offset by 256, because one byte suffices for smaller sizes.
    let offset = if length == 2 { 256 } else { 0 };
    u64::from_le_bytes(bytes).checked_add(offset).ok_or_else(cut_off)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(after_magic: &[u8], expect: Result<u64, &str>) {
        let head = [&MAGIC, after_magic].concat();
        match (stated_size(&head), expect) {
            (Ok(found), Ok(expect)) => assert_eq!(found, expect),
            (Err(found), Err(expect)) => assert!(found.contains(expect), "{found}"),
            (found, expect) => panic!("{found:?}, expected {expect:?}"),
        }
    }

    #[test]
    fn heads() {
        check(&[0b0010_0100, 7], Ok(7));
        check(&[0b0110_0100, 0, 1], Ok(512));
        check(&[0b1010_0100, 0, 0, 1, 0], Ok(65536));
        check(&[0b1000_0100, 0x68, 0, 0, 0, 1], Ok(1 << 24));
        check(&[0b1110_0100, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff], Ok(u64::MAX));
        check(&[0b1000_0100, 0x69, 0, 0, 0, 1], Err("the window is not 8 MiB"));
        check(&[0b0000_0100, 0x68, 0], Err("the size is not stated"));
        check(&[0b0010_0000, 7], Err("the checksum is missing"));
        check(&[0b0010_0101, 0, 7], Err("dictionary"));
        check(&[0b0010_1100, 7], Err("reserved"));
        check(&[0b0011_0100, 7], Err("reserved"));
        check(&[0b1010_0100, 0, 0, 1], Err("truncated"));
        check(&[], Err("truncated"));
    }
}
