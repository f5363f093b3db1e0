//! The files of a game: read within limits, written whole.

use crate::refusal::Refusal;
use crate::workspace::NamedText;
use engine::{MAX_LEVEL_TEXT, MAX_SOURCE};
use report::files;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use tempfile::Builder;

/// The most levels of a game that are read.
const MAX_LEVELS: usize = 1000;
/// The most bytes of all levels of a game.
const MAX_ALL_LEVELS: usize = 4 << 20;

/// Returns the number in the name of a level's file: `lvl3.txt` is level 3. Each number has one name.
pub(crate) fn level_number(name: &str) -> Option<usize> {
    let digits = name.strip_prefix("lvl")?.strip_suffix(".txt")?;
    let number: usize = digits.parse().ok()?;
    (number < MAX_LEVELS && number.to_string() == digits).then_some(number)
}

/// Returns the numbers of the levels in a folder, in order.
pub(crate) fn level_numbers(folder: &Path) -> Result<Vec<usize>, Refusal> {
    let listed = fs::read_dir(folder).map_err(|error| unreadable(folder, &error))?;
    let mut numbers: Vec<usize> =
        listed.flatten().filter_map(|entry| level_number(entry.file_name().to_str()?)).collect();
    numbers.sort_unstable();
    Ok(numbers)
}

/// Returns the levels in a folder, in order.
pub(crate) fn levels(folder: &Path) -> Result<Vec<NamedText>, Refusal> {
    let mut left = MAX_ALL_LEVELS;
    let read = |number| {
        let name = format!("lvl{number}.txt");
        let text = read_text(&folder.join(&name), MAX_LEVEL_TEXT)?;
        left = left.checked_sub(text.len()).ok_or_else(|| {
            Refusal::bad(format_args!(
                "the levels of this game have more than {MAX_ALL_LEVELS} bytes together"
            ))
            .help("move some of them to another folder")
        })?;
        Ok(NamedText { name, text })
    };
    level_numbers(folder)?.into_iter().map(read).collect()
}

/// Reads the text of a game.
pub(crate) fn read_source(file: &Path) -> Result<String, Refusal> {
    read_text(file, MAX_SOURCE)
}

fn read_text(file: &Path, limit: usize) -> Result<String, Refusal> {
    let name = shown(file);
    let bytes = files::read(file, limit as u64).map_err(|error| unreadable(file, &error))?;
    let bytes = bytes.ok_or_else(|| Refusal::bad(format_args!("{name} is larger than {limit} bytes")))?;
    String::from_utf8(bytes)
        .map_err(|_| Refusal::bad(format_args!("{name} is no text")).help("save it as UTF-8"))
}

/// Returns the content of a file; `None` if there is no such file.
pub(crate) fn content(file: &Path) -> Result<Option<String>, Refusal> {
    match fs::symlink_metadata(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(unreadable(file, &error)),
        // A link would be replaced by a file, and what it points at would stay as it was.
        Ok(found) if !found.is_file() => {
            Err(Refusal::forbidden(format_args!("{} is not a plain file", shown(file)))
                .help("replace it by a file to change it here"))
        }
        Ok(_) => read_text(file, MAX_LEVEL_TEXT.max(MAX_SOURCE)).map(Some),
    }
}

/// Refuses a folder that is a link: what is written there would change a folder elsewhere.
pub(crate) fn check_folder(folder: &Path) -> Result<(), Refusal> {
    match fs::symlink_metadata(folder) {
        Ok(found) if found.is_symlink() => {
            Err(Refusal::forbidden(format_args!("{} is a link to another folder", shown(folder)))
                .help("open that folder itself to change the game"))
        }
        _ => Ok(()),
    }
}

/// Writes a file: it is complete, or unchanged. The beginning and end of the temporary name are those that `arcade clean` knows.
pub(crate) fn write(file: &Path, text: &str) -> Result<(), Refusal> {
    let written = || {
        let folder = file.parent().unwrap_or(Path::new("."));
        let mut builder = Builder::new();
        builder.prefix(".arcade-").suffix(".partial");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut fresh = builder.tempfile_in(folder)?;
        fresh.write_all(text.as_bytes())?;
        if let Ok(before) = fs::metadata(file) {
            fresh.as_file().set_permissions(before.permissions())?;
        }
        fresh.as_file().sync_all()?;
        fresh.persist(file).map_err(|failed| failed.error)?;
        Ok(())
    };
    written().map_err(|error: io::Error| {
        Refusal::failed(format_args!("cannot write {}: {}", shown(file), error.kind()))
            .help("check the folder and the space on the disk")
    })
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
        ErrorKind::NotFound => Refusal::missing(format_args!("{} is gone", shown(path))),
        ErrorKind::InvalidInput | ErrorKind::IsADirectory => {
            Refusal::bad(format_args!("{} is not a file", shown(path))).help("replace it by a file")
        }
        kind => Refusal::failed(format_args!("cannot read {}: {kind}", shown(path))),
    }
}

/// Returns the last part of a path: pages see no folders of the machine.
fn shown(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::level_number;

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
