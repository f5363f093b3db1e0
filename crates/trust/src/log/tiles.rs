//! A log's files in the layout of C2SP `tlog-tiles`, which any web server can serve.
//!
//! `checkpoint` contains the newest signed state. `tile/entries/N` contains 256 entries, each preceded by its
//! length in two bytes. `tile/L/N` contains 256 hashes of level L. The last tile of each kind may be partial,
//! in which case `N.p/W` contains W items.

use super::tree::{self, Hash};

/// The number of entries or hashes in a full tile.
pub const WIDTH: u64 = 256;
/// The maximum size of an entry, in bytes.
pub const MAX_ENTRY: usize = 65535;

/// A log file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    /// The file's path, relative to the log's folder.
    pub(super) path: String,
    /// The file's content.
    pub(super) bytes: Vec<u8>,
}

/// Returns a tile's path. `level` is `entries` or a number.
fn path(level: &str, number: u64, width: u64) -> String {
    let mut text = format!("{:03}", number % 1000);
    let mut rest = number / 1000;
    while rest > 0 {
        text = format!("x{:03}/{text}", rest % 1000);
        rest /= 1000;
    }
    match width {
        WIDTH => format!("tile/{level}/{text}"),
        _ => format!("tile/{level}/{text}.p/{width}"),
    }
}

/// Returns the numbers and widths of the tiles for `count` items, starting with tile `first`.
fn widths(count: u64, first: u64) -> impl Iterator<Item = (u64, u64)> {
    (first..count.div_ceil(WIDTH)).map(move |number| (number, (count - number * WIDTH).min(WIDTH)))
}

/// Returns the paths to the entry files in a log of the given size, each with its number of entries.
pub(super) fn entry_files(size: u64) -> Vec<(String, u64)> {
    widths(size, 0).map(|(number, width)| (path("entries", number, width), width)).collect()
}

/// Returns the files to write when a log grows from its first `old` entries to all of `entries`.
pub(super) fn files(entries: &[Vec<u8>], leaves: &[Hash], old: u64) -> Vec<Tile> {
    let mut files = Vec::new();
    let of = |number: u64, width: u64| (number * WIDTH) as usize..(number * WIDTH + width) as usize;
    for (number, width) in widths(entries.len() as u64, old / WIDTH) {
        let mut bytes = Vec::new();
        for entry in &entries[of(number, width)] {
            let length = u16::try_from(entry.len()).expect("entries are bounded");
            bytes.extend_from_slice(&length.to_be_bytes());
            bytes.extend_from_slice(entry);
        }
        files.push(Tile { path: path("entries", number, width), bytes });
    }
    let (mut level, mut hashes, mut old) = (0, leaves.to_vec(), old);
    while !hashes.is_empty() {
        for (number, width) in widths(hashes.len() as u64, old / WIDTH) {
            let bytes = hashes[of(number, width)].concat();
            files.push(Tile { path: path(&level.to_string(), number, width), bytes });
        }
        hashes = hashes.chunks_exact(WIDTH as usize).map(tree::root).collect();
        old /= WIDTH;
        level += 1;
    }
    files
}

/// Returns the folders for all partial tiles that a log with these entries may have contained. Each folder comes with
/// the parts (encoded entries, or hashes) that its tile may contain, in the log's order.
pub(super) fn parts(entries: &[Vec<u8>], leaves: &[Hash]) -> Vec<(String, Vec<Vec<u8>>)> {
    let mut found = Vec::new();
    let mut add = |level: &str, parts: Vec<Vec<u8>>| {
        for (number, parts) in parts.chunks(WIDTH as usize).enumerate() {
            let of_one = path(level, number as u64, 1);
            let place = of_one.strip_suffix("/1").expect("a partial tile").to_owned();
            found.push((place, parts.to_vec()));
        }
    };
    let with_length = |entry: &Vec<u8>| {
        let length = u16::try_from(entry.len()).expect("entries are bounded");
        [&length.to_be_bytes()[..], entry].concat()
    };
    add("entries", entries.iter().map(with_length).collect());
    let (mut level, mut hashes) = (0, leaves.to_vec());
    while !hashes.is_empty() {
        add(&level.to_string(), hashes.iter().map(|hash| hash.to_vec()).collect());
        hashes = hashes.chunks_exact(WIDTH as usize).map(tree::root).collect();
        level += 1;
    }
    found
}

/// Splits an entry file into its entries. Returns `None` if the file does not contain exactly `width`
/// entries.
pub(super) fn split(bytes: &[u8], width: u64) -> Option<Vec<Vec<u8>>> {
    let mut entries = Vec::new();
    let mut rest = bytes;
    for _ in 0..width {
        let (length, after) = rest.split_first_chunk::<2>()?;
        let (entry, after) = after.split_at_checked(u16::from_be_bytes(*length).into())?;
        entries.push(entry.to_vec());
        rest = after;
    }
    rest.is_empty().then_some(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_those_of_the_specification() {
        assert_eq!(path("0", 1_234_067, 256), "tile/0/x001/x234/067");
        assert_eq!(path("entries", 0, 5), "tile/entries/000.p/5");
        assert_eq!(path("1", 1000, 256), "tile/1/x001/000");
    }

    /// A log that grows in steps has exactly the same files as a log written in one step.
    #[test]
    fn growth_writes_what_is_missing() {
        let entries: Vec<Vec<u8>> = (0..600_u32).map(|n| n.to_be_bytes().to_vec()).collect();
        let leaves: Vec<Hash> = entries.iter().map(|entry| tree::leaf(entry)).collect();
        let paths =
            |old: u64| files(&entries, &leaves, old).into_iter().map(|file| file.path).collect::<Vec<_>>();
        let all = [
            "tile/entries/000",
            "tile/entries/001",
            "tile/entries/002.p/88",
            "tile/0/000",
            "tile/0/001",
            "tile/0/002.p/88",
            "tile/1/000.p/2",
        ];
        assert_eq!(paths(0), all);
        assert_eq!(paths(599), ["tile/entries/002.p/88", "tile/0/002.p/88", "tile/1/000.p/2"]);
        assert_eq!(paths(256).len(), 5);
        let read: Vec<Vec<u8>> = entry_files(600)
            .iter()
            .flat_map(|(name, width)| {
                let file =
                    files(&entries, &leaves, 0).into_iter().find(|file| file.path == *name).expect("there");
                split(&file.bytes, *width).expect("whole")
            })
            .collect();
        assert_eq!(read, entries);
        assert_eq!(split(&[0, 1, 7], 2), None);
        assert_eq!(split(&[0, 2, 7], 1), None);
        assert_eq!(split(&[0, 1, 7, 0], 1), None);
    }
}
