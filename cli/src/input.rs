//! Games and levels as the user names them: files, folders, names of the corpus.

use crate::embedded;
use crate::failure::Failure;
use crate::paths;
use engine::{Game, Level, MAX_LEVEL_TEXT, MAX_SOURCE};
use report::files;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A text and its name for the user.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) text: String,
}

impl Named {
    /// Checks the text as a level of a game.
    pub(crate) fn level(&self, game: &Game) -> Result<Level, Failure> {
        game.level(&self.text).map_err(|problems| crate::diagnostics::failure(self, &problems.0))
    }
}

/// A game with the levels that come with it, not yet parsed.
#[derive(Clone, Debug)]
pub(crate) struct GameInput {
    /// The game's text, under the name that messages use.
    pub(crate) source: Named,
    pub(crate) title: String,
    /// The file of the game; none for a game of the corpus.
    pub(crate) path: Option<PathBuf>,
    levels: Vec<LevelInput>,
}

#[derive(Clone, Debug)]
enum LevelInput {
    File(PathBuf),
    Text(Named),
}

impl LevelInput {
    /// Returns the number in its name: `lvl3.txt` is level 3.
    fn number(&self) -> Option<usize> {
        let name = match self {
            LevelInput::File(path) => path.file_name()?.to_str()?,
            LevelInput::Text(named) => named.name.rsplit('/').next()?,
        };
        name.strip_prefix("lvl")?.strip_suffix(".txt")?.parse().ok()
    }

    fn read(&self) -> Result<Named, Failure> {
        match self {
            LevelInput::File(path) => {
                let (name, text) = (path.display().to_string(), read_text(path, MAX_LEVEL_TEXT)?);
                if is_game(&text) {
                    let help =
                        "this is a game, not a level; a level is rows of the characters of the LevelMapping";
                    bail!("{name}: {help}");
                }
                Ok(Named { name, text })
            }
            LevelInput::Text(named) => Ok(named.clone()),
        }
    }
}

impl GameInput {
    /// Compiles the game; `as_reference` enables the reference's recovery from faults.
    pub(crate) fn compile(&self, as_reference: bool) -> Result<Game, Failure> {
        let load = if as_reference { Game::from_source_as_reference } else { Game::from_source };
        load(&self.source.text).map_err(|problems| crate::diagnostics::failure(&self.source, &problems.0))
    }

    /// Returns the number of levels that come with the game.
    pub(crate) fn count(&self) -> usize {
        self.levels.len()
    }

    /// Returns the levels that come with the game.
    pub(crate) fn levels(&self) -> Result<Vec<Named>, Failure> {
        self.levels.iter().map(LevelInput::read).collect()
    }

    /// Returns the levels that come with the game, checked.
    pub(crate) fn checked_levels(&self, game: &Game) -> Result<Vec<Level>, Failure> {
        self.levels()?.iter().map(|named| named.level(game)).collect()
    }

    /// Returns a level as the user names it: a file, or the number of one that comes with the game.
    pub(crate) fn level(&self, name: &str) -> Result<Named, Failure> {
        let path = Path::new(name);
        if paths::metadata(path)?.is_some() {
            return LevelInput::File(path.to_owned()).read();
        }
        let number = name.strip_prefix("lvl").unwrap_or(name).trim_end_matches(".txt").parse::<usize>();
        let wanted = number.ok();
        match self.levels.iter().find(|level| wanted.is_some() && level.number() == wanted) {
            Some(level) => level.read(),
            None if number_like(name) => {
                let title = &self.title;
                let numbers: Vec<usize> = self.levels.iter().filter_map(LevelInput::number).collect();
                let there = match &numbers[..] {
                    [] => "no levels of its own".to_owned(),
                    [one] => format!("level {one} only"),
                    [first, .., last] if last - first + 1 == numbers.len() => {
                        format!("levels {first} to {last}")
                    }
                    _ => {
                        let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
                        format!("levels {}", numbers.join(", "))
                    }
                };
                Err(malformed!("{title} has {there}: no `{name}`"))
            }
            None => Err(malformed!("{name}: there is no such file")),
        }
    }
}

fn number_like(name: &str) -> bool {
    name.strip_prefix("lvl").unwrap_or(name).chars().all(|c| c.is_ascii_digit())
}

/// Finds a game: a .vgdl or .txt file, a folder with game.vgdl or game.txt, or the name of a corpus game.
pub(crate) fn game(name: &str) -> Result<GameInput, Failure> {
    let path = Path::new(name);
    let found = paths::metadata(path)?;
    if found.as_ref().is_some_and(|found| found.is_dir()) {
        return game_in(path)?.ok_or_else(|| no_game_in(path));
    }
    if found.is_some() {
        let text = read_text(path, MAX_SOURCE)?;
        if is_level(&text) {
            bail!("{name}: this is a level, not a game; name its game first: arcade validate GAME {name}");
        }
        let whole_folder = path.file_stem().is_some_and(|stem| stem == "game");
        let folder = path.parent().unwrap_or(Path::new("."));
        let levels = if whole_folder { level_files(folder)? } else { Vec::new() };
        return Ok(GameInput {
            source: Named { name: name.to_owned(), text },
            title: name.to_owned(),
            path: Some(path.to_owned()),
            levels,
        });
    }
    let corpus = embedded::corpus()?;
    let Some(found) = corpus.find(name) else {
        let near = engine::nearest(name, corpus.games.iter().map(|game| game.name.as_str()));
        let near = near.map(|near| format!("the corpus game `{near}`"));
        let help = match near.or_else(|| nearest_sibling(path).map(|near| format!("`{near}`"))) {
            Some(near) => format!("there is no such file, folder or corpus game; did you mean {near}?"),
            None => "there is no such file, folder or corpus game".to_owned(),
        };
        bail!("{name}: {help}");
    };
    let level = |(number, text): (usize, &String)| {
        LevelInput::Text(Named { name: format!("{name}/lvl{number}.txt"), text: text.clone() })
    };
    Ok(GameInput {
        source: Named { name: format!("{name}/game.vgdl"), text: found.source.clone() },
        title: name.to_owned(),
        path: None,
        levels: found.levels.iter().enumerate().map(level).collect(),
    })
}

/// The word for all corpus games, if there is no folder of that name.
pub(crate) const CORPUS: &str = "corpus";

/// Finds games: those that [`game`] finds, all games in a folder of such folders, and `corpus` for all games of the
/// corpus.
pub(crate) fn games(name: &str) -> Result<Vec<GameInput>, Failure> {
    let path = Path::new(name);
    let found = paths::metadata(path)?;
    if name == CORPUS && found.is_none() {
        return embedded::corpus()?.games.iter().map(|known| game(&known.name)).collect();
    }
    if !found.is_some_and(|found| found.is_dir()) {
        return Ok(vec![game(name)?]);
    }
    if let Some(game) = game_in(path)? {
        return Ok(vec![game]);
    }
    let mut games = Vec::new();
    for folder in sorted_entries(path)? {
        if paths::metadata(&folder)?.is_some_and(|found| found.is_dir()) {
            games.extend(game_in(&folder)?);
        }
    }
    if games.is_empty() {
        return Err(no_game_in(path));
    }
    Ok(games)
}

/// Advice for a folder without a game: it may be a release, whose games are in subfolders.
fn no_game_in(folder: &Path) -> Failure {
    let name = folder.display();
    let below = folder.join("games");
    let games = sorted_entries(&below).unwrap_or_default();
    match games.iter().find(|game| game.join("game.vgdl").is_file()) {
        Some(first) => malformed!(
            "{name}: this folder contains no game, but {} does: name that folder to use all its games, or one game, such as {}",
            below.display(),
            first.display()
        ),
        None => malformed!("{name}: no game.vgdl or game.txt in this folder"),
    }
}

/// Finds the path in the same folder whose name is closest to this one's, for typing errors.
fn nearest_sibling(path: &Path) -> Option<String> {
    let folder = path.parent()?;
    let wanted = path.file_name()?.to_string_lossy();
    let here = if folder == Path::new("") { Path::new(".") } else { folder };
    let there = sorted_entries(here).ok()?;
    let names: Vec<_> = there.iter().filter_map(|path| path.file_name()?.to_str()).collect();
    let near = engine::nearest(&wanted, names)?;
    Some(folder.join(near).display().to_string())
}

/// Returns `true` if a text looks like a level: rows of characters of one width, without anything that a game has.
fn is_level(text: &str) -> bool {
    let rows: Vec<&str> = text.lines().map(str::trim_end).collect();
    let width = |row: &&str| row.chars().count();
    let widest = rows.iter().map(width).max().unwrap_or_default();
    // Rows of one width, ignoring blanks at their ends; a single word may be anything.
    let full = rows.iter().filter(|row| width(row) == widest).count();
    let is_vgdl = |row: &&str| {
        let words =
            ["BasicGame", "GameSpace", "SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"];
        row.contains(" > ") || words.iter().any(|word| row.trim().starts_with(word))
    };
    rows.len() > 1 && widest > 1 && 2 * full >= rows.len() && !rows.iter().any(is_vgdl)
}

/// Returns `true` if a text is certainly a game: it has two of the sections, each on a line of its own.
fn is_game(text: &str) -> bool {
    let sections = ["SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"];
    text.lines().filter(|line| sections.contains(&line.trim())).count() > 1
}

fn game_in(folder: &Path) -> Result<Option<GameInput>, Failure> {
    let Some(path) = first_file(folder, ["game.vgdl", "game.txt"])? else { return Ok(None) };
    let text = read_text(&path, MAX_SOURCE)?;
    if is_level(&text) {
        let name = path.display();
        bail!("{name}: this is a level, not a game; put the game here, and the level beside it as lvl0.txt");
    }
    let title =
        folder.file_name().map_or_else(|| folder.display().to_string(), |n| n.to_string_lossy().into_owned());
    let source = Named { name: path.display().to_string(), text };
    Ok(Some(GameInput { source, title, path: Some(path), levels: level_files(folder)? }))
}

/// Returns the first of these files that the folder has.
pub(crate) fn first_file(folder: &Path, names: [&str; 2]) -> Result<Option<PathBuf>, Failure> {
    for name in names {
        let path = folder.join(name);
        if paths::metadata(&path)?.is_some() {
            return Ok(Some(path));
        }
    }
    Ok(None)
}

fn level_files(folder: &Path) -> Result<Vec<LevelInput>, Failure> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let mut files: Vec<LevelInput> = sorted_entries(folder)?.into_iter().map(LevelInput::File).collect();
    files.retain(|file| file.number().is_some());
    files.sort_by_key(LevelInput::number);
    Ok(files)
}

/// Returns the entries of a folder, sorted by name.
pub(crate) fn sorted_entries(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => {
            malformed!("{}: there is no such folder", folder.display())
        }
        _ => Failure::read(folder, error),
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        paths.push(entry.map_err(failed)?.path());
    }
    paths.sort();
    Ok(paths)
}

/// The first bytes of a release's archive.
pub(crate) const ZSTD: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Reads a text file of at most `limit` bytes; of a larger file no more is read.
pub(crate) fn read_text(path: &Path, limit: usize) -> Result<String, Failure> {
    let name = path.display();
    let file = files::open(path).map_err(|error| Failure::read(path, error))?;
    let mut bytes = Vec::new();
    let read = file.take(limit as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| Failure::read(path, error))?;
    if bytes.starts_with(&ZSTD) {
        bail!(
            "{name}: this is an archive, not a text file; unpack it (tar -xf {name}), and name a file or folder in it"
        );
    }
    if bytes.len() > limit {
        bail!("{name}: larger than {limit} bytes, the limit for such a file");
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let help = "save it as UTF-8";
        malformed!("{name}: not a text file (byte {at} is not UTF-8, in line {line}); {help}")
    })
}

#[cfg(test)]
mod tests {
    use super::is_level;

    #[test]
    fn levels_and_games_are_distinguished() {
        for level in ["wwww\nw.Aw\nwwww\n", "A g\nw\nwww\nwww", "w w\r\nwAw\r\n"] {
            assert!(is_level(level), "{level}");
        }
        for other in
            ["", "\n", "BasicGame\n", "BasicGame\n  SpriteSet\n    a > Door\n", "ELF", "a > b\nc > d\n"]
        {
            assert!(!is_level(other), "{other}");
        }
    }
}
