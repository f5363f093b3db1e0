//! A game specified by the user, and its levels.

use crate::diagnostics::Named;
use crate::failure::Failure;
use crate::input::text::{folder_of, is_game, read_text, sorted_entries};
use crate::{console, paths};
use base::MessagePath;
use engine::{Game, Level, MAX_LEVEL_TEXT, layout};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// An unparsed game with its accompanying levels.
#[derive(Clone, Debug)]
pub(crate) struct GameInput {
    /// The game's text, and its name in messages.
    pub(crate) source: Named,
    pub(crate) title: String,
    /// The game's file, or `None` for a corpus game.
    pub(crate) path: Option<PathBuf>,
    pub(super) levels: Vec<LevelInput>,
    /// The levels specified by the user. If empty, all levels are used.
    pub(super) asked: Vec<LevelInput>,
    /// Set once the user has been informed of the files that were not recognised as levels.
    pub(super) told: Arc<OnceLock<()>>,
}

#[derive(Clone, Debug)]
pub(super) struct LevelInput {
    /// The number in the file name: `lvl3.txt` is level 3.
    pub(super) number: Option<usize>,
    pub(super) place: LevelPlace,
}

#[derive(Clone, Debug)]
pub(super) enum LevelPlace {
    File(PathBuf),
    Text(Named),
}

impl LevelInput {
    pub(super) fn file(path: PathBuf) -> LevelInput {
        let number = path.file_name().and_then(|name| layout::level_number(name.to_str()?));
        LevelInput { number, place: LevelPlace::File(path) }
    }

    fn read(&self) -> Result<Named, Failure> {
        match &self.place {
            LevelPlace::File(path) => {
                let (name, text) = (path.in_message().to_string(), read_text(path, MAX_LEVEL_TEXT)?);
                if is_game(&text) {
                    let help =
                        "this is a game, not a level; a level consists of rows of LevelMapping characters";
                    bail!("{}: {help}", name.in_message());
                }
                Ok(Named { name, text })
            }
            LevelPlace::Text(named) => Ok(named.clone()),
        }
    }
}

impl GameInput {
    /// Compiles the game. `as_reference` enables the reference engine's recovery from faults.
    pub(crate) fn compile(&self, as_reference: bool) -> Result<Game, Failure> {
        let load = if as_reference { Game::from_source_as_reference } else { Game::from_source };
        load(&self.source.text).map_err(|problems| crate::diagnostics::failure(&self.source, &problems.0))
    }

    /// Returns the files of the game and its levels.
    pub(crate) fn files(&self) -> Vec<&Path> {
        let levels = self.levels.iter().chain(&self.asked).filter_map(|level| match &level.place {
            LevelPlace::File(path) => Some(path.as_path()),
            LevelPlace::Text(_) => None,
        });
        self.path.as_deref().into_iter().chain(levels).collect()
    }

    /// Returns the number of levels that accompany the game.
    pub(crate) fn count(&self) -> usize {
        self.levels.len()
    }

    /// Returns the levels that the user passed instead of the game or, if there are none, the levels that
    /// accompany the game.
    pub(crate) fn levels(&self) -> Result<Vec<Named>, Failure> {
        self.tell_strays();
        self.wanted().iter().map(LevelInput::read).collect()
    }

    /// Warns, at most once, about files and folders beside the game that look like levels but are ignored.
    /// Does nothing if the user specified levels.
    fn tell_strays(&self) {
        let Some(path) = self.path.as_deref().filter(|_| self.asked.is_empty()) else { return };
        let own = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let Ok(entries) = sorted_entries(folder_of(path)) else { return };
        if self.told.set(()).is_err() {
            return;
        }
        let named = |path: &PathBuf| Some((path.file_name()?.to_str()?.to_owned(), path.is_dir()));
        let (folders, files): (Vec<_>, Vec<_>) =
            entries.iter().filter_map(named).partition(|(_, is_folder)| *is_folder);
        let files: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        let all = || files.iter().copied().chain(folders.iter().map(|(name, _)| name.as_str()));
        let misnamed = layout::misnamed(own, all());
        for (file, wanted) in misnamed.into_iter().filter(|(name, _)| files.contains(&name.as_str())) {
            let shown = path.with_file_name(file);
            console::warn(format_args!(
                "`{}` is ignored, because levels of this game are named like `{wanted}`",
                shown.in_message()
            ));
        }
        let levels = layout::levels(own, all());
        for (folder, _) in &folders {
            if levels.iter().any(|(_, name)| name == folder) {
                let shown = path.with_file_name(folder);
                console::warn(format_args!(
                    "`{}` is ignored, because it is a folder: a level is a text file",
                    shown.in_message()
                ));
            }
        }
    }

    /// Returns [`levels`](Self::levels) with the numbers in their names. If a number is missing or
    /// duplicated, numbers the levels by position instead.
    pub(crate) fn numbered_levels(&self) -> Result<Vec<(usize, Named)>, Failure> {
        self.tell_strays();
        let numbers: BTreeSet<usize> = self.wanted().iter().filter_map(|level| level.number).collect();
        let are_numbered = numbers.len() == self.wanted().len();
        let number = |(at, level): (usize, &LevelInput)| {
            Ok((level.number.filter(|_| are_numbered).unwrap_or(at), level.read()?))
        };
        self.wanted().iter().enumerate().map(number).collect()
    }

    /// Returns the level passed instead of the game, if any, followed by the levels passed after it. Returns
    /// all levels if the user passed none.
    pub(crate) fn named_levels(&self, names: &[String]) -> Result<Vec<Named>, Failure> {
        if names.is_empty() {
            return self.levels();
        }
        let named = names.iter().map(|name| self.find_level(name)).collect::<Result<Vec<_>, _>>()?;
        self.asked.iter().chain(&named).map(LevelInput::read).collect()
    }

    /// Returns the parsed [`levels`](Self::levels).
    pub(crate) fn checked_levels(&self, game: &Game) -> Result<Vec<Level>, Failure> {
        self.levels()?.iter().map(|named| named.level(game)).collect()
    }

    /// Returns the level that the user passed instead of the game, if any.
    pub(crate) fn asked(&self) -> Result<Option<Named>, Failure> {
        self.asked.first().map(LevelInput::read).transpose()
    }

    fn wanted(&self) -> &[LevelInput] {
        if self.asked.is_empty() { &self.levels } else { &self.asked }
    }

    /// Returns the level specified by the user: a file, or the number of a level that accompanies the game.
    pub(crate) fn level(&self, name: &str) -> Result<Named, Failure> {
        self.find_level(name)?.read()
    }

    pub(super) fn find_level(&self, name: &str) -> Result<LevelInput, Failure> {
        let path = Path::new(name);
        if let Some(found) = paths::metadata(path)? {
            if found.is_dir() {
                bail!(
                    "{name}: this is a folder; pass a level file, or the number of one of the game's levels"
                );
            }
            return Ok(LevelInput::file(path.to_owned()));
        }
        let number = name.strip_prefix("lvl").unwrap_or(name).trim_end_matches(".txt").parse::<usize>();
        let wanted = number.ok().or_else(|| layout::level_number(name));
        match self.levels.iter().find(|level| wanted.is_some() && level.number == wanted) {
            Some(level) => Ok(level.clone()),
            None if number_like(name) => {
                self.tell_strays();
                let title = &self.title;
                let numbers: Vec<usize> = self.levels.iter().filter_map(|level| level.number).collect();
                let there = match &numbers[..] {
                    [] => "no levels of its own".to_owned(),
                    [one] => format!("only level {one}"),
                    [first, .., last] if last - first + 1 == numbers.len() => {
                        format!("levels {first} to {last}")
                    }
                    _ => {
                        let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
                        format!("levels {}", numbers.join(", "))
                    }
                };
                Err(malformed!("`{name}` is not a level of {title}, which has {there}"))
            }
            None => Err(malformed!("{}: there is no such file; check the path", name.in_message())),
        }
    }
}

pub(super) fn number_like(name: &str) -> bool {
    name.strip_prefix("lvl").unwrap_or(name).chars().all(|c| c.is_ascii_digit())
}

/// Creates the input for the game in a file. Its levels are among `names`, the names of the files beside it.
pub(super) fn of_source(path: &Path, text: String, title: String, names: &[String]) -> GameInput {
    let own = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let levels = layout::levels(own, names.iter().map(String::as_str));
    let level = |(_, name): (usize, String)| LevelInput::file(path.with_file_name(name));
    GameInput {
        source: Named { name: path.in_message().to_string(), text },
        title,
        path: Some(path.to_owned()),
        levels: levels.into_iter().map(level).collect(),
        asked: Vec::new(),
        told: Arc::default(),
    }
}
