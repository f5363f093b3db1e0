//! Checks that a command's program exists before it is started, so that a misspelt name is reported before a
//! results folder is created.

use base::MessagePath;
use itertools::Itertools;
use std::ffi::OsStr;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// The file extensions of scripts that an interpreter takes as its first argument.
const SCRIPTS: [&str; 9] = ["py", "sh", "js", "mjs", "ts", "rb", "pl", "lua", "jl"];

/// Checks that the program in the first word exists. If the second word looks like a script, checks that the
/// script exists too.
pub(super) fn find(words: &[String]) -> Result<(), String> {
    let path = std::env::var_os("PATH");
    find_in(words, path.as_deref(), Path::new(""))
}

/// Checks the program and the script. Relative folders in `path` are resolved against `here`.
fn find_in(words: &[String], path: Option<&OsStr>, here: &Path) -> Result<(), String> {
    let program = words.first().expect("a command has a first word");
    match program.contains(std::path::is_separator) {
        true => check(program, &here.join(program), true)?,
        // Without `PATH`, the locations of programs depend on the system.
        false => path.map_or(Ok(()), |path| in_path(program, path, here))?,
    }
    match words.get(1) {
        Some(script) if is_script(script) => check(script, &here.join(script), false),
        _ => Ok(()),
    }
}

/// Returns `true` if a word looks like a script, such as `agent.py`, rather than a flag or an assignment.
fn is_script(word: &str) -> bool {
    let ending = Path::new(word).extension().and_then(OsStr::to_str);
    ending.is_some_and(|ending| SCRIPTS.contains(&ending)) && !word.starts_with('-') && !word.contains('=')
}

fn check(word: &str, path: &Path, is_program: bool) -> Result<(), String> {
    let found = match path.metadata() {
        Ok(found) => found,
        Err(error) if error.kind() == std::io::ErrorKind::PermissionDenied => {
            return Err(format!("`{word}` cannot be accessed; check the permissions of its folder"));
        }
        Err(_) => {
            let folder = path.parent().unwrap_or(Path::new(""));
            let names = names(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
            let wrong = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let near = engine::nearest(&wrong, names.iter().map(String::as_str)).map(|near| {
                let shown = Path::new(word).with_file_name(near);
                format!("; did you mean `{}`?", shown.in_message())
            });
            return Err(format!("there is no file `{word}`{}", near.unwrap_or_default()));
        }
    };
    if found.is_dir() {
        return Err(format!("`{word}` is a folder, not a program"));
    }
    match is_program && found.permissions().mode() & 0o111 == 0 {
        true => Err(format!("`{word}` is not executable; run `chmod +x {word}`")),
        false => Ok(()),
    }
}

fn in_path(program: &str, path: &OsStr, here: &Path) -> Result<(), String> {
    let folders: Vec<PathBuf> = std::env::split_paths(path).map(|folder| here.join(folder)).collect();
    let is_program = |path: &PathBuf| {
        path.metadata().is_ok_and(|found| found.is_file() && found.permissions().mode() & 0o111 != 0)
    };
    if folders.iter().any(|folder| is_program(&folder.join(program))) {
        return Ok(());
    }
    if here.join(program).is_file() {
        return Err(format!(
            "there is no program `{program}` in PATH; write `./{program}` for the file in this folder"
        ));
    }
    let programs = |folder: &PathBuf| {
        let names = names(folder).into_iter();
        names.filter(|name| is_program(&folder.join(name))).collect::<Vec<String>>()
    };
    let names: Vec<String> = folders.iter().flat_map(programs).collect();
    let near = engine::nearest(program, names.iter().map(String::as_str));
    let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    Err(format!("there is no program `{program}` in PATH{near}"))
}

/// Returns the sorted names in a folder, or an empty list if the folder cannot be read.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().into_string().ok()).sorted().collect_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn missing_programs_are_reported_with_a_suggestion() {
        let home = tempfile::tempdir().unwrap();
        let bin = home.path().join("bin");
        fs::create_dir(&bin).unwrap();
        for (name, mode) in
            [("bin/python3", 0o755), ("bin/notes", 0o644), ("agent.py", 0o644), ("run.sh", 0o755)]
        {
            let path = home.path().join(name);
            fs::write(&path, "").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
        }
        let check = |command: &str, expect: Option<&str>| {
            let words: Vec<String> = command.split(' ').map(str::to_owned).collect();
            let found = find_in(&words, Some(bin.as_os_str()), home.path()).err();
            assert_eq!(found.as_deref(), expect, "{command}");
        };
        check("python3 agent.py --fast", None);
        check("python3 -u agnet.py", None);
        check("python3 X=1.py", None);
        check("./run.sh", None);
        check("pyhton3 agent.py", Some("there is no program `pyhton3` in PATH; did you mean `python3`?"));
        check("python3 agnet.py", Some("there is no file `agnet.py`; did you mean `agent.py`?"));
        check("python3 other.py", Some("there is no file `other.py`"));
        check("./rum.sh", Some("there is no file `./rum.sh`; did you mean `./run.sh`?"));
        check("./agent.py", Some("`./agent.py` is not executable; run `chmod +x ./agent.py`"));
        check("./bin", Some("`./bin` is a folder, not a program"));
        check("notes", Some("there is no program `notes` in PATH"));
        check(
            "run.sh",
            Some("there is no program `run.sh` in PATH; write `./run.sh` for the file in this folder"),
        );
        check("xyzzy-none", Some("there is no program `xyzzy-none` in PATH"));
    }
}
