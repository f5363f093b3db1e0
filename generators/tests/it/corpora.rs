//! Games in folders: the corpus games and, if available, public games.

use engine::{Game, Level};
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the folders of the corpus games, sorted.
pub(crate) fn own() -> Vec<PathBuf> {
    folders("../corpora")
}

/// Returns the folders of public games, sorted. If they are missing, prints a message and returns an empty
/// list.
pub(crate) fn public() -> Vec<PathBuf> {
    folders("../../shared/gvgai/games")
}

#[allow(clippy::print_stderr, reason = "a skipped test says so")]
fn folders(path: &str) -> Vec<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let Ok(entries) = fs::read_dir(&path) else {
        eprintln!("SKIPPED: there is no folder {}", path.display());
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    folders.sort();
    folders
}

pub(crate) fn name_of(folder: &Path) -> String {
    folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Returns the text of the game in a folder; `None` if there is no game.
pub(crate) fn source_in(folder: &Path) -> Option<String> {
    ["game.vgdl", "game.txt"].iter().find_map(|name| fs::read_to_string(folder.join(name)).ok())
}

/// Returns the game in a folder; `None` if the engine cannot play it.
pub(crate) fn game_in(folder: &Path) -> Option<Game> {
    Game::from_source(&source_in(folder)?).ok()
}

/// Returns a corpus game.
pub(crate) fn own_game(name: &str) -> Game {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpora").join(name);
    game_in(&folder).unwrap_or_else(|| panic!("there is no game in {}", folder.display()))
}

/// Returns the texts of the levels in a game's folder.
pub(crate) fn level_texts_in(folder: &Path) -> Vec<String> {
    (0..).map_while(|number| fs::read_to_string(folder.join(format!("lvl{number}.txt"))).ok()).collect()
}

/// Returns the levels in a game's folder that the engine can read.
pub(crate) fn levels_in(folder: &Path, game: &Game) -> Vec<Level> {
    level_texts_in(folder).iter().filter_map(|text| game.level(text).ok()).collect()
}
