//! Helpers for the tests that span crates: the workspace root and files, and checks that must hold for any input
//! ([`robustness`]).
//!
//! The tests themselves are in `tests/tests/it/`. Its subfolder `tidy/` contains the house rules that can be
//! checked automatically.

extern crate infinite_arcade_base as base;
extern crate infinite_arcade_engine as engine;

pub mod any_game;
pub mod choices;
pub mod claims;
pub mod generated;
pub mod hostile;
pub mod isomorphic;
pub mod mutation;
#[cfg(doctest)]
mod readmes;
pub mod robustness;
pub mod sweep;
pub mod vocabulary;

use engine::{Game, Level};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Returns the workspace's root folder, which contains the virtual manifest.
///
/// # Panics
///
/// Panics if this crate is not in a workspace folder.
pub fn workspace_root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().expect("this crate lies one folder below the workspace root").to_path_buf()
}

/// Returns every file that belongs to the repository, relative to [`workspace_root`], sorted.
///
/// The following are excluded: top-level folders listed in `.gitignore`, such as `releases`; build output (any folder
/// with cargo's `CACHEDIR.TAG`, and `target`); unfinished releases (`*.partial`); links; and hidden folders except
/// `.cargo` and `.ci`.
///
/// # Panics
///
/// Panics if a folder cannot be read.
pub fn workspace_files() -> Vec<PathBuf> {
    files_below(&workspace_root())
}

fn files_below(root: &Path) -> Vec<PathBuf> {
    let ignored = fs::read_to_string(root.join(".gitignore")).unwrap_or_default();
    let ignored: Vec<&Path> =
        ignored.lines().filter_map(|line| line.strip_prefix('/')).map(Path::new).collect();
    let mut files = Vec::new();
    collect(root, Path::new(""), &ignored, &mut files);
    files.sort();
    files
}

/// Returns every `.rs` file of the workspace's crates with its text, relative to [`workspace_root`], sorted by path.
///
/// A crate is a folder below the root that contains a `Cargo.toml`. Build output is excluded.
///
/// # Panics
///
/// Panics if a file cannot be read or is not UTF-8.
pub fn rust_files() -> Vec<(PathBuf, String)> {
    let root = workspace_root();
    let in_crate = |file: &Path| {
        file.ancestors()
            .any(|folder| folder != Path::new("") && root.join(folder).join("Cargo.toml").is_file())
    };
    workspace_files()
        .into_iter()
        .filter(|file| file.extension().is_some_and(|extension| extension == "rs") && in_crate(file))
        .map(|file| {
            let text = read(&file);
            (file, text)
        })
        .collect()
}

/// Returns the folder with the reference's public games, which are test data outside the repository. If the
/// folder is missing, prints a message and returns `None`.
pub fn public_games() -> Option<PathBuf> {
    let games = workspace_root().join("../shared/gvgai/games");
    let found = games.is_dir();
    if !found {
        let _ = writeln!(io::stderr(), "SKIPPED: no games in {}", games.display());
    }
    found.then_some(games)
}

/// Loads the games in a folder's subfolders, with their levels, as the reference does. Games are sorted by
/// name. Games that fail to load are skipped.
pub fn games(folder: &Path) -> Vec<(String, Game, Vec<Level>)> {
    let mut folders: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let load = |folder: &PathBuf| {
        let read = |file: &str| fs::read_to_string(folder.join(file)).ok();
        let game = Game::from_source_as_reference(&read("game.vgdl").or_else(|| read("game.txt"))?).ok()?;
        let texts = (0..5).map_while(|number| read(&format!("lvl{number}.txt")));
        let levels: Vec<Level> = texts.filter_map(|text| game.level(&text).ok()).collect();
        Some((folder.file_name()?.to_string_lossy().into_owned(), game, levels))
    };
    folders.iter().filter_map(load).filter(|(.., levels)| !levels.is_empty()).collect()
}

/// Returns the text of a repository file, given its path relative to [`workspace_root`].
///
/// # Panics
///
/// Panics if the file is missing, cannot be read or is not UTF-8.
pub fn read(file: impl AsRef<Path>) -> String {
    let file = file.as_ref();
    match fs::read_to_string(workspace_root().join(file)) {
        Ok(text) => text,
        Err(error) => panic!("{}: {error}", file.display()),
    }
}

/// Adds every file below `folder` (relative to `root`) to `files`, in no particular order.
fn collect(root: &Path, folder: &Path, ignored: &[&Path], files: &mut Vec<PathBuf>) {
    let here = root.join(folder);
    let entries = fs::read_dir(&here).unwrap_or_else(|error| panic!("{}: {error}", here.display()));
    for entry in entries {
        let entry = entry.unwrap_or_else(|error| panic!("{}: {error}", here.display()));
        let path = folder.join(entry.file_name());
        let kind = entry.file_type().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        if kind.is_dir() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            let hidden = name.starts_with('.') && name != ".cargo" && name != ".ci";
            let built = name == "target" || entry.path().join("CACHEDIR.TAG").exists();
            let left_out = ignored.contains(&path.as_path());
            if !hidden && !built && !left_out && !name.ends_with(".partial") {
                collect(root, &path, ignored, files);
            }
        } else if kind.is_file() {
            files.push(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Minted releases and results do not belong to the repository, so tests ignore them.
    #[test]
    fn ignored_folders_of_the_root_are_left_out() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join(".gitignore"), "/target\n*.partial\n/releases\n").unwrap();
        for file in
            ["docs/page.md", "docs/releases/page.md", "releases/starter/README.md", "half.partial/README.md"]
        {
            let path = root.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let found = files_below(root.path());
        assert_eq!(found, [".gitignore", "docs/page.md", "docs/releases/page.md"].map(PathBuf::from));
    }
}
