//! Templates for new games in a few genres, one per genre. Each template has a commented game and two levels.

use crate::files;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// A template for a new game.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    /// The genre, which is also the template's name.
    pub genre: &'static str,
    /// The player's task, as a sentence without a full stop.
    pub about: &'static str,
    /// The files with their names. The game comes last, so that a folder in which some levels are still
    /// missing is not a game.
    pub files: [(&'static str, &'static str); 3],
}

/// The name of the game file in a game's folder.
pub(crate) const GAME_FILE: &str = "game.vgdl";

macro_rules! template {
    ($genre:literal, $about:literal) => {
        Template {
            genre: $genre,
            about: $about,
            files: [
                ("lvl0.txt", include_str!(concat!("../templates/", $genre, "/lvl0.txt"))),
                ("lvl1.txt", include_str!(concat!("../templates/", $genre, "/lvl1.txt"))),
                (GAME_FILE, include_str!(concat!("../templates/", $genre, "/game.vgdl"))),
            ],
        }
    };
}

/// The templates, starting with the simplest.
pub const TEMPLATES: [Template; 5] = [
    template!("collect", "pick up every shell, and keep away from the gulls"),
    template!("crossing", "cross the river on boats, and visit every house"),
    template!("maze", "fetch the key, open the gate, and escape the cat"),
    template!("puzzle", "push logs until every leak is filled"),
    template!("shooter", "shoot the beetles before they have eaten all cabbages"),
];

impl Template {
    /// Returns the template for a genre; `None` for an unknown genre.
    pub fn of(genre: &str) -> Option<Template> {
        TEMPLATES.into_iter().find(|template| template.genre == genre)
    }

    /// Writes the game into a folder, which must be absent or empty. The parent folder must exist.
    ///
    /// # Errors
    ///
    /// Returns [`ErrorKind::AlreadyExists`] if the path is a file or a non-empty folder, and other I/O errors
    /// unchanged.
    pub fn begin(&self, folder: &Path) -> io::Result<()> {
        match fs::create_dir(folder) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                let is_empty = fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none());
                if !is_empty {
                    return Err(error);
                }
            }
            made => made?,
        }
        self.files.iter().try_for_each(|(name, text)| files::put(&folder.join(name), text))
    }
}
