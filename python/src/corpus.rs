//! The games of the corpus, which the extension carries.

use include_dir::{Dir, include_dir};
use pyo3::prelude::*;

static CORPORA: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../corpora");

/// A game: its name, text, levels and card.
type CorpusGame = (String, String, Vec<String>, String);

/// Returns the games of the corpus by name: each with its name, its text, its levels and the text of its CARD.toml.
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
