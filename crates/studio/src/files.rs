//! A game's files, which are read within limits and written as a whole.

use crate::refusal::Refusal;
use disk::Access;
use engine::{MAX_LEVEL_TEXT, MAX_SOURCE};
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// A game file: its name and its content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedText {
    /// The name, without a folder.
    pub name: String,
    /// The file's content.
    pub text: String,
}

/// The maximum number of levels to read per game.
const MAX_LEVELS: usize = 1000;
/// The maximum total size of a game's levels, in bytes.
const MAX_ALL_LEVELS: usize = 4 << 20;

/// Returns the number of the level with the given name on pages. For example, `lvl3.txt` is level 3. Each number has
/// exactly one such name, whatever the level's file is called.
pub(crate) fn level_number(name: &str) -> Option<usize> {
    let digits = name.strip_prefix("lvl")?.strip_suffix(".txt")?;
    let number: usize = digits.parse().ok()?;
    (number < MAX_LEVELS && number.to_string() == digits).then_some(number)
}

/// Returns the levels of a game in a folder, sorted by number, each with its number and file name.
pub(crate) fn level_files(folder: &Path, source: &str) -> Result<Vec<(usize, String)>, Refusal> {
    let listed = fs::read_dir(folder).map_err(|error| unreadable(folder, &error))?;
    // As in all commands, a link stands for its target, and folders are not levels.
    let files = listed.flatten().filter(|entry| !entry.path().is_dir());
    let names: Vec<String> = files.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    let mut levels = engine::layout::levels(source, names.iter().map(String::as_str));
    levels.retain(|(number, _)| *number < MAX_LEVELS);
    levels.dedup_by_key(|(number, _)| *number);
    Ok(levels)
}

/// Returns the levels of a game in a folder, sorted by number, with their names on pages.
pub(crate) fn levels(folder: &Path, source: &str) -> Result<Vec<NamedText>, Refusal> {
    let mut left = MAX_ALL_LEVELS;
    let read = |(number, file): (usize, String)| {
        let text = read_text(&folder.join(file), MAX_LEVEL_TEXT)?;
        left = left.checked_sub(text.len()).ok_or_else(|| {
            Refusal::bad(format_args!(
                "the levels of this game are larger than {MAX_ALL_LEVELS} bytes in total"
            ))
            .help("move some of them to another folder")
        })?;
        Ok(NamedText { name: format!("lvl{number}.txt"), text })
    };
    level_files(folder, source)?.into_iter().map(read).collect()
}

/// Returns the path of the game's level with this number. If there is no such file, returns the path for a
/// new file, named like the existing levels.
pub(crate) fn level_path(folder: &Path, source: &str, number: usize) -> Result<PathBuf, Refusal> {
    let levels = level_files(folder, source)?;
    if let Some((_, file)) = levels.iter().find(|(own, _)| *own == number) {
        return Ok(folder.join(file));
    }
    let is_plain = |name: &str| name.len() >= 3 && name.as_bytes()[..3].eq_ignore_ascii_case(b"lvl");
    let stem = Path::new(source).file_stem().unwrap_or_default().to_string_lossy();
    let plain = levels.last().map_or_else(|| stem.eq_ignore_ascii_case("game"), |(_, file)| is_plain(file));
    let prefix = if plain { String::new() } else { format!("{stem}_") };
    Ok(folder.join(format!("{prefix}lvl{number}.txt")))
}

/// Reads a game's text.
pub(crate) fn read_source(file: &Path) -> Result<String, Refusal> {
    read_text(file, MAX_SOURCE)
}

fn read_text(file: &Path, limit: usize) -> Result<String, Refusal> {
    let name = shown(file);
    let bytes = disk::read(file, limit as u64).map_err(|error| unreadable(file, &error))?;
    let bytes = bytes.ok_or_else(|| Refusal::bad(format_args!("{name} is larger than {limit} bytes")))?;
    String::from_utf8(bytes)
        .map_err(|_| Refusal::bad(format_args!("{name} is not a text file")).help("save it as UTF-8"))
}

/// Returns a file's content, or `None` if the file does not exist.
pub(crate) fn content(file: &Path) -> Result<Option<String>, Refusal> {
    match fs::symlink_metadata(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(unreadable(file, &error)),
        // Writing would replace the link with a file, without changing the link's target.
        Ok(found) if !found.is_file() => {
            Err(Refusal::forbidden(format_args!("{} is not a regular file", shown(file)))
                .help("replace the link or device with a regular file to change it here"))
        }
        Ok(_) => read_text(file, MAX_LEVEL_TEXT.max(MAX_SOURCE)).map(Some),
    }
}

/// Rejects a folder that is a link, because writing to it would change a different folder.
pub(crate) fn check_folder(folder: &Path) -> Result<(), Refusal> {
    match fs::symlink_metadata(folder) {
        Ok(found) if found.is_symlink() => {
            Err(Refusal::forbidden(format_args!("{} is a link to another folder", shown(folder)))
                .help("open the other folder to change the game"))
        }
        _ => Ok(()),
    }
}

/// Writes a file like [`put`], and returns an error response on failure.
pub(crate) fn write(file: &Path, text: &str) -> Result<(), Refusal> {
    put(file, text).map_err(|error| {
        Refusal::failed(format_args!("cannot write {}: {}", shown(file), error.kind()))
            .help("check the folder and the available disk space")
    })
}

/// Writes a file completely, or leaves it unchanged on failure.
pub(crate) fn put(file: &Path, text: &str) -> io::Result<()> {
    disk::write(file, text.as_bytes(), Access::Shared)
}

/// Removes a file.
pub(crate) fn remove(file: &Path) -> Result<(), Refusal> {
    fs::remove_file(file).map_err(|error| {
        Refusal::failed(format_args!("cannot remove {}: {}", shown(file), error.kind()))
            .help("check the folder")
    })
}

fn unreadable(path: &Path, error: &io::Error) -> Refusal {
    match error.kind() {
        ErrorKind::NotFound => Refusal::missing(format_args!("{} no longer exists", shown(path))),
        ErrorKind::InvalidInput | ErrorKind::IsADirectory => {
            Refusal::bad(format_args!("{} is not a file", shown(path))).help("replace it with a file")
        }
        kind => Refusal::failed(format_args!("cannot read {}: {kind}", shown(path))),
    }
}

/// Returns the last component of a path, because pages must not reveal local folders.
fn shown(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::{level_files, level_number, level_path};

    #[test]
    fn levels_keep_the_names_of_their_files() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        for name in
            ["zelda.txt", "zelda_lvl0.txt", "zelda_LVL2.TXT", "aliens.txt", "aliens_lvl0.txt", "pond.vgdl"]
        {
            std::fs::write(path.join(name), "w").unwrap();
        }
        let numbers: Vec<usize> =
            level_files(path, "zelda.txt").unwrap().into_iter().map(|(number, _)| number).collect();
        assert_eq!(numbers, [0, 2]);
        for (source, number, file) in [
            ("zelda.txt", 2, "zelda_LVL2.TXT"),
            ("zelda.txt", 3, "zelda_lvl3.txt"),
            ("pond.vgdl", 0, "pond_lvl0.txt"),
            ("game.vgdl", 7, "lvl7.txt"),
        ] {
            assert_eq!(level_path(path, source, number).unwrap(), path.join(file), "{source} {number}");
        }
    }

    /// Checks that, as on the command line, a link is read, and a folder is not a level.
    #[cfg(unix)]
    #[test]
    fn links_are_read_and_folders_are_no_levels() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        std::fs::write(path.join("elsewhere"), "w").unwrap();
        std::os::unix::fs::symlink("elsewhere", path.join("lvl0.txt")).unwrap();
        std::fs::create_dir(path.join("lvl1.txt")).unwrap();
        let levels = super::levels(path, "game.vgdl").unwrap();
        assert_eq!(levels.iter().map(|level| level.name.as_str()).collect::<Vec<_>>(), ["lvl0.txt"]);
    }

    #[test]
    fn each_level_has_one_name() {
        for (name, number) in [("lvl0.txt", 0), ("lvl12.txt", 12)] {
            assert_eq!(level_number(name), Some(number));
        }
        for name in [
            "lvl.txt",
            "lvl01.txt",
            "lvl+1.txt",
            "lvl-1.txt",
            "lvl1000.txt",
            "../lvl1.txt",
            "lvl1.txt/",
            "LVL1.txt",
            "lvl1.TXT",
        ] {
            assert_eq!(level_number(name), None, "{name}");
        }
    }
}
