//! The opened games: the corpus, games in folders, a release, or the games in evaluation results.

use crate::files::{self, NamedText};
use crate::refusal::Refusal;
use engine::Episode;
use serde::Serialize;
use serde_json::Value;
use snapshots::released::Released;
use std::path::PathBuf;
use std::sync::{Arc, PoisonError, RwLock};

/// The kind of a workspace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The games embedded in the program.
    Corpus,
    /// The games in folders.
    Games,
    /// The games in a release.
    Snapshot,
    /// The games in the results of an evaluation.
    Results,
}

/// The location of a game's files.
#[derive(Clone, Debug)]
pub enum Place {
    /// The files are in memory and cannot be changed.
    Texts {
        /// The game file.
        source: NamedText,
        /// The levels, sorted by number.
        levels: Vec<NamedText>,
    },
    /// The files are in a folder, with the levels beside the game. The levels are named `lvl0.txt`,
    /// `lvl1.txt` and so on, or `NAME_lvl0.txt` and so on if the game is `NAME.txt`.
    Folder {
        /// The folder with the files.
        folder: PathBuf,
        /// The name of the game file in the folder.
        source: String,
        /// `true` if the game may be edited.
        writable: bool,
    },
    /// The game is a single file without levels.
    File {
        /// The game file.
        file: PathBuf,
        /// `true` if the file may be edited.
        writable: bool,
    },
}

/// A recorded win of a level.
#[derive(Clone, Debug)]
pub struct WitnessEntry {
    /// The name of the recording, such as `lvl0`.
    pub name: String,
    /// The level's index.
    pub level: usize,
    /// The winning episode.
    pub episode: Episode,
}

/// A game in a workspace.
#[derive(Clone, Debug)]
pub struct GameEntry {
    /// The ID under which the page requests the game, unique in the workspace.
    pub id: String,
    /// The title to display.
    pub title: String,
    /// The location of the files.
    pub place: Place,
    /// The card, which describes the game. In a release, it also contains the results from the game's judges.
    pub card: Option<Value>,
    /// A sentence about the game.
    pub summary: String,
    /// The recorded wins of the game's levels.
    pub witnesses: Vec<WitnessEntry>,
}

/// The opened games, and their data.
#[derive(Debug)]
pub struct Workspace {
    /// The kind of the workspace.
    pub kind: Kind,
    /// The name to display.
    pub name: String,
    /// The folder for copies of games.
    pub copies: PathBuf,
    /// The release's path.
    pub root: Option<PathBuf>,
    /// The folders with results, one per player.
    pub results: Vec<PathBuf>,
    /// The release, if one is open and its verification has succeeded.
    pub released: Option<Arc<Released>>,
    /// The release with which to compare the opened release, and its path.
    pub against: Option<(PathBuf, Arc<Released>)>,
    /// Additional paths in which to search for the predecessors of the opened release. Each path is a release or a
    /// folder of releases.
    pub chain: Vec<PathBuf>,
    games: RwLock<Vec<Arc<GameEntry>>>,
}

impl Workspace {
    /// Creates a workspace with the given games. If several games have the same ID, a number is appended.
    pub fn new(kind: Kind, name: impl Into<String>, copies: PathBuf, games: Vec<GameEntry>) -> Workspace {
        let workspace = Workspace {
            kind,
            name: name.into(),
            copies,
            root: None,
            results: Vec::new(),
            released: None,
            against: None,
            chain: Vec::new(),
            games: RwLock::default(),
        };
        for game in games {
            workspace.add(game);
        }
        workspace
    }

    /// Adds a game and returns its ID.
    pub(crate) fn add(&self, mut game: GameEntry) -> String {
        let mut games = self.games.write().unwrap_or_else(PoisonError::into_inner);
        let taken = |id: &str| games.iter().any(|known| known.id == id);
        let id = match taken(&game.id) {
            false => game.id.clone(),
            true => {
                let numbered = (2..).map(|number| format!("{}-{number}", game.id));
                numbered.into_iter().find(|id| !taken(id)).unwrap_or_default()
            }
        };
        game.id.clone_from(&id);
        games.push(Arc::new(game));
        id
    }

    /// Returns the games, in the order in which the page lists them.
    pub(crate) fn games(&self) -> Vec<Arc<GameEntry>> {
        self.games.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Returns the game with this ID.
    pub(crate) fn game(&self, id: &str) -> Result<Arc<GameEntry>, Refusal> {
        let found = self.games().into_iter().find(|game| game.id == id);
        found.ok_or_else(|| Refusal::missing("there is no such game here").help("load the page again"))
    }
}

impl GameEntry {
    /// Returns `true` if the game's files may be edited.
    pub(crate) fn is_writable(&self) -> bool {
        match self.place {
            Place::Texts { .. } => false,
            Place::Folder { writable, .. } | Place::File { writable, .. } => writable,
        }
    }

    /// Returns the current texts of the game and its levels.
    pub(crate) fn read(&self) -> Result<(NamedText, Vec<NamedText>), Refusal> {
        match &self.place {
            Place::Texts { source, levels } => Ok((source.clone(), levels.clone())),
            Place::Folder { folder, source, .. } => {
                let text = files::read_source(&folder.join(source))?;
                Ok((NamedText { name: source.clone(), text }, files::levels(folder, source)?))
            }
            Place::File { file, .. } => {
                let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
                Ok((NamedText { name, text: files::read_source(file)? }, Vec::new()))
            }
        }
    }

    /// Returns the number of levels in the game, without reading the level files.
    pub(crate) fn count(&self) -> usize {
        match &self.place {
            Place::Texts { levels, .. } => levels.len(),
            Place::Folder { folder, source, .. } => {
                files::level_files(folder, source).map_or(0, |levels| levels.len())
            }
            Place::File { .. } => 0,
        }
    }

    /// Returns the path of a file by its name. The file is the game itself or one of its levels.
    pub(crate) fn path_of(&self, name: &str) -> Result<PathBuf, Refusal> {
        let unknown = |help: &str| Refusal::missing("the game has no file with this name").help(help);
        match &self.place {
            Place::Texts { .. } => {
                Err(Refusal::forbidden("this game cannot be changed").help("copy it first"))
            }
            Place::Folder { writable: false, .. } | Place::File { writable: false, .. } => {
                Err(Refusal::forbidden("this game cannot be changed").help("copy it first"))
            }
            Place::Folder { folder, source, .. } if name == source => {
                files::check_folder(folder)?;
                Ok(folder.join(name))
            }
            Place::Folder { folder, source, .. } => match files::level_number(name) {
                Some(number) => {
                    files::check_folder(folder)?;
                    files::level_path(folder, source, number)
                }
                None => Err(unknown(&format!("the game's files are {source} and lvl0.txt, lvl1.txt …"))),
            },
            Place::File { file, .. } if file.file_name().is_some_and(|own| own == name) => Ok(file.clone()),
            Place::File { .. } => Err(unknown(
                "levels cannot be added to a game in a single file; move the file into a folder as game.vgdl",
            )),
        }
    }
}
