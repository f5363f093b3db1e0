//! Texts and folders specified by the user.

use crate::failure::Failure;
use base::MessagePath;
use std::path::{Path, PathBuf};

/// The first bytes of a release archive.
pub(crate) const ZSTD: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Reads a UTF-8 text file of up to `limit` bytes. A larger file is an error, and is not read to its end.
pub(crate) fn read_text(path: &Path, limit: usize) -> Result<String, Failure> {
    let name = path.in_message();
    let read = disk::read_start(path, limit as u64 + 1);
    let bytes = read.map_err(|error| Failure::read(path, error))?;
    if bytes.starts_with(&ZSTD) {
        bail!(
            "{name}: this is an archive, not a text file; unpack it (tar -xf {name}), and pass a file or \
             folder from it"
        );
    }
    if bytes.len() > limit {
        bail!("{name}: larger than {limit} bytes, the limit for such a file");
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let help = "save it as UTF-8";
        malformed!("{name}: not a text file (byte {at}, in line {line}, is not UTF-8); {help}")
    })
}

/// Returns the folder that contains a file.
pub(super) fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().unwrap_or(Path::new("."));
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// Returns the names of the files in a folder.
pub(super) fn file_names(folder: &Path) -> Result<Vec<String>, Failure> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let named = sorted_entries(folder)?.into_iter().filter(|path| !path.is_dir());
    Ok(named.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect())
}

/// Returns a folder's entries, sorted by name.
pub(crate) fn sorted_entries(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => {
            malformed!("{}: there is no such folder; check the path", folder.in_message())
        }
        _ => Failure::read(folder, error),
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        paths.push(entry.map_err(failed)?.path());
    }
    paths.sort();
    Ok(paths)
}

/// Returns `true` if a text looks like a level: its rows have equal width, and it contains no text that
/// occurs only in games.
pub(super) fn is_level(text: &str) -> bool {
    let text = text.trim_start_matches('\u{feff}').trim_end_matches(['\n', '\r']).replace("\r\n", "\n");
    let rows: Vec<&str> = text.split(['\n', '\r']).map(str::trim_end).collect();
    let width = |row: &&str| row.chars().count();
    let widest = rows.iter().map(width).max().unwrap_or_default();
    // All rows must have the same width, ignoring trailing spaces. A single word could be anything.
    let full = rows.iter().filter(|row| width(row) == widest).count();
    let is_vgdl = |row: &&str| {
        let words =
            ["BasicGame", "GameSpace", "SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"];
        row.contains(" > ") || words.iter().any(|word| row.trim().starts_with(word))
    };
    rows.len() > 1 && widest > 1 && 2 * full >= rows.len() && !rows.iter().any(is_vgdl)
}

/// Returns `true` if a text is definitely a game: at least two section names are present, each on its own
/// line.
pub(super) fn is_game(text: &str) -> bool {
    let sections = ["SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"];
    text.split(['\n', '\r']).filter(|line| sections.contains(&line.trim())).count() > 1
}

#[cfg(test)]
mod tests {
    use super::is_level;

    #[test]
    fn levels_and_games_are_distinguished() {
        for level in ["wwww\nw.Aw\nwwww\n", "A g\nw\nwww\nwww", "w w\r\nwAw\r\n", "\u{feff}ww\rwA\rww"] {
            assert!(is_level(level), "{level}");
        }
        for other in
            ["", "\n", "BasicGame\n", "BasicGame\n  SpriteSet\n    a > Door\n", "ELF", "a > b\nc > d\n"]
        {
            assert!(!is_level(other), "{other}");
        }
    }
}
