//! The corpus games embedded in the extension, and functions that interpret the file names of other games.

use include_dir::{Dir, include_dir};
use pyo3::prelude::*;

static CORPORA: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../corpora");

/// A game's name, rules, levels and card.
type CorpusGame = (String, String, Vec<String>, String);

/// Returns the corpus games, each as its name, its rules, its levels and the text of its CARD.toml.
#[pyfunction]
pub(crate) fn corpus() -> Vec<CorpusGame> {
    let mut games = Vec::new();
    for folder in CORPORA.dirs() {
        let name = folder.path().to_string_lossy().into_owned();
        let text = |file: &str| folder.get_file(folder.path().join(file))?.contents_utf8();
        let (Some(source), Some(card)) = (text("game.vgdl"), text("CARD.toml")) else { continue };
        let levels = (0..).map_while(|number| text(&format!("lvl{number}.txt"))).map(str::to_owned).collect();
        games.push((name, source.to_owned(), levels, card.to_owned()));
    }
    games.sort();
    games
}

/// The name of a game file, and the game's levels with their numbers.
type GameFiles = (String, Vec<(usize, String)>);

/// Finds games in a folder, given the folder's file names.
#[pyfunction]
pub(crate) fn games_of_files(names: Vec<String>) -> Vec<GameFiles> {
    let games = engine::layout::games(names.iter().map(String::as_str));
    games.into_iter().map(|game| (game.source, game.levels)).collect()
}

/// Returns a game's levels and their numbers, given the file names in its folder.
#[pyfunction]
pub(crate) fn levels_of_files(source: &str, names: Vec<String>) -> Vec<(usize, String)> {
    engine::layout::levels(source, names.iter().map(String::as_str))
}

/// Returns the name of the game file to which a level belongs, given the file names in the level's folder.
/// Returns `None` if `level` is not the name of a level file.
#[pyfunction]
pub(crate) fn game_of_level(level: &str, names: Vec<String>) -> Option<String> {
    engine::layout::level_number(level)?;
    engine::layout::game_of(level, names.iter().map(String::as_str))
}
