//! Games and levels that the user specifies: files, folders and names of corpus games.

use crate::failure::Failure;
use crate::{console, embedded, paths, shell};
use base::MessagePath;
use engine::{Game, Level, MAX_LEVEL_TEXT, MAX_SOURCE, dialect, layout};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A text and the name that messages use for it.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) text: String,
}

impl Named {
    /// Parses the text as a level of a game.
    pub(crate) fn level(&self, game: &Game) -> Result<Level, Failure> {
        game.level(&self.text).map_err(|problems| crate::diagnostics::failure(self, &problems.0))
    }
}

/// A game with the levels that come with it, not yet parsed.
#[derive(Clone, Debug)]
pub(crate) struct GameInput {
    /// The game's text, with the name that messages use for it.
    pub(crate) source: Named,
    pub(crate) title: String,
    /// The game's file, or `None` for a corpus game.
    pub(crate) path: Option<PathBuf>,
    levels: Vec<LevelInput>,
    /// The levels that the user specified, if any; otherwise all levels count.
    asked: Vec<LevelInput>,
    /// Set once the user has been told which files were not recognised as levels.
    told: Arc<OnceLock<()>>,
}

#[derive(Clone, Debug)]
struct LevelInput {
    /// The number in the file's name: `lvl3.txt` is level 3.
    number: Option<usize>,
    place: LevelPlace,
}

#[derive(Clone, Debug)]
enum LevelPlace {
    File(PathBuf),
    Text(Named),
}

impl LevelInput {
    fn file(path: PathBuf) -> LevelInput {
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
    /// Compiles the game; `as_reference` enables the reference engine's recovery from faults.
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

    /// Returns the number of levels that come with the game.
    pub(crate) fn count(&self) -> usize {
        self.levels.len()
    }

    /// Returns the levels that the user specified in place of the game, or else the levels that come with it.
    pub(crate) fn levels(&self) -> Result<Vec<Named>, Failure> {
        self.tell_strays();
        self.wanted().iter().map(LevelInput::read).collect()
    }

    /// Reports, once, which files and folders beside the game look like levels but are not. Reports nothing if the user specified
    /// levels.
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

    /// Returns [`levels`](Self::levels) with the numbers in their names, or with their positions if a number is missing or occurs
    /// twice.
    pub(crate) fn numbered_levels(&self) -> Result<Vec<(usize, Named)>, Failure> {
        self.tell_strays();
        let numbers: BTreeSet<usize> = self.wanted().iter().filter_map(|level| level.number).collect();
        let are_numbered = numbers.len() == self.wanted().len();
        let number = |(at, level): (usize, &LevelInput)| {
            Ok((level.number.filter(|_| are_numbered).unwrap_or(at), level.read()?))
        };
        self.wanted().iter().enumerate().map(number).collect()
    }

    /// Returns the level specified in place of the game and then the levels specified after it. If there are none, returns all
    /// levels.
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

    /// Returns the level that the user specified in place of the game, if there is one.
    pub(crate) fn asked(&self) -> Result<Option<Named>, Failure> {
        self.asked.first().map(LevelInput::read).transpose()
    }

    fn wanted(&self) -> &[LevelInput] {
        if self.asked.is_empty() { &self.levels } else { &self.asked }
    }

    /// Returns the level that the user specified: a file, or the number of a level that comes with the game.
    pub(crate) fn level(&self, name: &str) -> Result<Named, Failure> {
        self.find_level(name)?.read()
    }

    fn find_level(&self, name: &str) -> Result<LevelInput, Failure> {
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
                    [one] => format!("level {one} only"),
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

fn number_like(name: &str) -> bool {
    name.strip_prefix("lvl").unwrap_or(name).chars().all(|c| c.is_ascii_digit())
}

/// Finds a game by its file, its folder, the file of one of its levels, or the name of a corpus game.
pub(crate) fn game(name: &str) -> Result<GameInput, Failure> {
    let path = Path::new(name);
    let found = paths::metadata(path)?;
    if found.as_ref().is_some_and(|found| found.is_dir()) {
        let mut games = games_in(path)?;
        return match games.len() {
            1 => Ok(games.remove(0)),
            0 => Err(no_game_in(path)),
            count => {
                let first = &games[0].source.name;
                Err(malformed!("{name}: this folder contains {count} games; pass one, such as {first}"))
            }
        };
    }
    if found.is_some() {
        return match file(path)? {
            Found::Game(input) => Ok(input),
            Found::Level(_, Some(input)) => Ok(input),
            Found::Level(_, None) => Err(lost_level(path)),
        };
    }
    let corpus = embedded::corpus()?;
    let Some(found) = corpus.find(name) else {
        let near = engine::nearest(name, corpus.games.iter().map(|game| game.name.as_str()));
        let near = near.map(|near| format!("the corpus game `{near}`"));
        let help = match near.or_else(|| nearest_sibling(path).map(|near| format!("`{near}`"))) {
            Some(near) => format!("there is no such file, folder or corpus game; did you mean {near}?"),
            None => "there is no such file, folder or corpus game; check the path".to_owned(),
        };
        bail!("{}: {help}", name.in_message());
    };
    let level = |(number, text): (usize, &String)| {
        let named = Named { name: format!("{name}/lvl{number}.txt"), text: text.clone() };
        LevelInput { number: Some(number), place: LevelPlace::Text(named) }
    };
    Ok(GameInput {
        source: Named { name: format!("{name}/game.vgdl"), text: found.source.clone() },
        title: name.to_owned(),
        path: None,
        levels: found.levels.iter().enumerate().map(level).collect(),
        asked: Vec::new(),
        told: Arc::default(),
    })
}

/// A file that the user specified: a game, or a level with the game beside it, if there is one.
enum Found {
    Game(GameInput),
    Level(LevelInput, Option<GameInput>),
}

fn file(path: &Path) -> Result<Found, Failure> {
    let text = read_text(path, MAX_SOURCE.max(MAX_LEVEL_TEXT))?;
    let file_name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let called_level = layout::level_number(file_name).is_some();
    if is_game(&text) || !called_level && !is_level(&text) {
        if text.len() > MAX_SOURCE {
            bail!("{}: larger than {MAX_SOURCE} bytes, the limit for such a file", path.in_message());
        }
        refuse_python(path, &text)?;
        let names = match file_names(folder_of(path)) {
            // Levels are searched for beside any file, but only a whole game needs them.
            Err(_) if path.file_stem().is_none_or(|stem| !stem.eq_ignore_ascii_case("game")) => Vec::new(),
            names => names?,
        };
        return Ok(Found::Game(of_source(path, text, path.in_message().to_string(), &names)));
    }
    let level = LevelInput::file(path.to_owned());
    let names = file_names(folder_of(path))?;
    let Some(source) = layout::game_of(file_name, names.iter().map(String::as_str)) else {
        return Ok(Found::Level(level, None));
    };
    let source = path.with_file_name(source);
    let text = game_text(&source)?;
    let mut input = of_source(&source, text, source.in_message().to_string(), &names);
    input.asked.push(level.clone());
    Ok(Found::Level(level, Some(input)))
}

/// Returns the game in a file. Its levels are among `names`, the names of the files beside it.
fn of_source(path: &Path, text: String, title: String, names: &[String]) -> GameInput {
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

/// Returns a failure with advice for a level without a game beside it: the game may be in the parent folder.
fn lost_level(path: &Path) -> Failure {
    let name = path.in_message();
    let beside = games_in(folder_of(path)).unwrap_or_default();
    if beside.len() > 1 {
        let names =
            beside.iter().map(|game| format!("`{}`", game.source.name)).collect::<Vec<_>>().join(", ");
        return malformed!(
            "{name}: this is a level, and there are several games next to it: {names}; pass its game first: \
             arcade validate GAME {}",
            shell::quoted(path)
        );
    }
    let above = folder_of(path)
        .parent()
        .map(|above| if above.as_os_str().is_empty() { Path::new(".") } else { above });
    let games = above.and_then(|above| games_in(above).ok()).unwrap_or_default();
    let game = match &games[..] {
        [only] => only.source.name.as_str(),
        _ => "GAME",
    };
    malformed!(
        "{name}: this is a level, not a game, and there is no game next to it; pass its game first: arcade \
         validate {} {}",
        if game == "GAME" { game.to_owned() } else { shell::quoted(Path::new(game)) },
        shell::quoted(path)
    )
}

/// Rejects a Python file, and suggests the command that converts the game in it.
fn refuse_python(path: &Path, text: &str) -> Result<(), Failure> {
    let Some(found) = dialect::python_file(text) else { return Ok(()) };
    let levels = match found.levels.len() {
        1 => "1 level".to_owned(),
        count => format!("{count} levels"),
    };
    let out = path.file_stem().map_or_else(|| "game".into(), |stem| stem.to_string_lossy());
    bail!(
        "{}: this is a Python file with a game in the dialect of py-vgdl (line {}) and {levels}; convert it first: arcade fmt --from py-vgdl {} --out {}",
        path.in_message(),
        found.line,
        shell::quoted(path),
        shell::quoted(Path::new(&*out))
    )
}

/// The word that stands for all corpus games, unless a folder has that name.
pub(crate) const CORPUS: &str = "corpus";

/// Finds all games of an argument: the game that [`game`] finds, all games in a folder of games or of such folders, or the corpus
/// games for `corpus`.
pub(crate) fn games(name: &str) -> Result<Vec<GameInput>, Failure> {
    let path = Path::new(name);
    let found = paths::metadata(path)?;
    if name == CORPUS && found.is_none() {
        return embedded::corpus()?.games.iter().map(|known| game(&known.name)).collect();
    }
    if !found.is_some_and(|found| found.is_dir()) {
        return Ok(vec![game(name)?]);
    }
    let mut games = games_in(path)?;
    if let [only] = &games[..]
        && has_whole_game(only)
    {
        return Ok(games);
    }
    for folder in sorted_entries(path)? {
        if paths::metadata(&folder)?.is_some_and(|found| found.is_dir()) {
            games.append(&mut games_in(&folder)?);
        }
    }
    if games.is_empty() {
        return Err(no_game_in(path));
    }
    Ok(games)
}

/// Returns `true` if new games can be created at `place`. That is so if nothing exists there, or a folder that contains no game
/// and no visible folders. A name with an extension counts as a file, and the name of a corpus game as a game.
pub(crate) fn is_without_games(place: &Path) -> Result<bool, Failure> {
    let Some(found) = paths::metadata(place)? else {
        let is_known = embedded::corpus()?.find(&place.to_string_lossy()).is_some();
        return Ok(!is_known && place.extension().is_none());
    };
    if !found.is_dir() || !layout::games(file_names(place)?.iter().map(String::as_str)).is_empty() {
        return Ok(false);
    }
    let is_hidden =
        |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    Ok(!sorted_entries(place)?.iter().any(|path| path.is_dir() && !is_hidden(path)))
}

/// Returns the game or path of which `place`, which does not exist, may be a misspelling.
pub(crate) fn nearest_place(place: &Path) -> Result<Option<String>, Failure> {
    let corpus = embedded::corpus()?;
    let names = corpus.games.iter().map(|game| game.name.as_str());
    let near = engine::nearest(&place.to_string_lossy(), names).map(str::to_owned);
    Ok(near.or_else(|| nearest_sibling(place)))
}

fn has_whole_game(input: &GameInput) -> bool {
    let stem = input.path.as_deref().and_then(Path::file_stem);
    stem.is_some_and(|stem| stem.eq_ignore_ascii_case("game"))
}

/// Finds the games in a list of arguments. A level selects itself for its game: it can be followed by more levels of that game,
/// or by the game. A number, or a level without a game beside it, belongs to the game before it.
pub(crate) fn named_games(names: &[String]) -> Result<Vec<GameInput>, Failure> {
    let mut games: Vec<GameInput> = Vec::new();
    for name in names {
        let path = Path::new(name);
        let found = paths::metadata(path)?;
        let is_number = found.is_none() && !name.is_empty() && number_like(name);
        let is_file = found.as_ref().is_some_and(|found| !found.is_dir());
        if is_number && let Some(last) = games.last_mut() {
            let level = last.find_level(name)?;
            last.asked.push(level);
            continue;
        }
        if !is_file {
            games.append(&mut self::games(name)?);
            continue;
        }
        match file(path)? {
            Found::Game(input) => games.push(input),
            Found::Level(level, own) => {
                let same = |last: &&mut GameInput| own.as_ref().is_none_or(|own| own.path == last.path);
                match (games.last_mut().filter(same), own) {
                    (Some(last), _) => last.asked.push(level),
                    (None, Some(own)) => games.push(own),
                    (None, None) => return Err(lost_level(path)),
                }
            }
        }
    }
    Ok(games)
}

/// Returns a failure with advice for a folder without a game: it may be a release, whose games are in subfolders.
fn no_game_in(folder: &Path) -> Failure {
    let name = folder.in_message();
    let below = folder.join("games");
    let games = sorted_entries(&below).unwrap_or_default();
    match games.iter().find(|game| game.join("game.vgdl").is_file()) {
        Some(first) => malformed!(
            "{name}: this folder contains no game, but {} does: pass that folder to use all its games, or \
             one game, such as {}",
            below.in_message(),
            first.in_message()
        ),
        None => malformed!(
            "{name}: this folder contains no game.vgdl or game.txt, and no NAME.txt with NAME_lvl0.txt next \
             to it"
        ),
    }
}

/// Finds the path in the same folder with the most similar name, for typing errors.
fn nearest_sibling(path: &Path) -> Option<String> {
    let folder = path.parent()?;
    let wanted = path.file_name()?.to_string_lossy();
    let here = if folder == Path::new("") { Path::new(".") } else { folder };
    let there = sorted_entries(here).ok()?;
    let names: Vec<_> = there.iter().filter_map(|path| path.file_name()?.to_str()).collect();
    let with_ending =
        |name: &&str| ["vgdl", "txt"].iter().any(|ending| **name == format!("{wanted}.{ending}"));
    let near = names
        .iter()
        .copied()
        .find(with_ending)
        .or_else(|| engine::nearest(&wanted, names.iter().copied()))?;
    Some(folder.join(near).in_message().to_string())
}

/// Returns `true` if a text looks like a level: rows of equal width, and nothing that only games contain.
fn is_level(text: &str) -> bool {
    let text = text.trim_start_matches('\u{feff}').trim_end_matches(['\n', '\r']).replace("\r\n", "\n");
    let rows: Vec<&str> = text.split(['\n', '\r']).map(str::trim_end).collect();
    let width = |row: &&str| row.chars().count();
    let widest = rows.iter().map(width).max().unwrap_or_default();
    // Rows must have one width, ignoring trailing spaces. A single word may be anything.
    let full = rows.iter().filter(|row| width(row) == widest).count();
    let is_vgdl = |row: &&str| {
        let words =
            ["BasicGame", "GameSpace", "SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"];
        row.contains(" > ") || words.iter().any(|word| row.trim().starts_with(word))
    };
    rows.len() > 1 && widest > 1 && 2 * full >= rows.len() && !rows.iter().any(is_vgdl)
}

/// Returns `true` if a text is certainly a game: it has two of the sections, each on its own line.
fn is_game(text: &str) -> bool {
    let sections = ["SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"];
    text.split(['\n', '\r']).filter(|line| sections.contains(&line.trim())).count() > 1
}

/// Returns the games directly in a folder.
fn games_in(folder: &Path) -> Result<Vec<GameInput>, Failure> {
    let names = file_names(folder)?;
    let games = layout::games(names.iter().map(String::as_str));
    let input = |found: layout::GameFiles| {
        let path = folder.join(&found.source);
        let stem = path.file_stem().filter(|stem| !stem.eq_ignore_ascii_case("game"));
        let own = stem.or_else(|| folder.file_name());
        let title = own.map_or_else(|| folder.in_message().to_string(), |name| name.in_message().to_string());
        Ok(of_source(&path, game_text(&path)?, title, &names))
    };
    games.into_iter().map(input).collect()
}

/// Reads the file of a game and rejects a level.
fn game_text(path: &Path) -> Result<String, Failure> {
    let text = read_text(path, MAX_SOURCE)?;
    if is_level(&text) {
        let name = path.in_message();
        bail!("{name}: this is a level, not a game; put the game here, and the level beside it as lvl0.txt");
    }
    Ok(text)
}

/// Returns the folder of a file.
fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().unwrap_or(Path::new("."));
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// Returns the names of the files in a folder.
fn file_names(folder: &Path) -> Result<Vec<String>, Failure> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let named = sorted_entries(folder)?.into_iter().filter(|path| !path.is_dir());
    Ok(named.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect())
}

/// Returns the entries of a folder, sorted by name.
pub(crate) fn sorted_entries(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => {
            malformed!("{}: there is no such folder; check the path", folder.in_message())
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

/// Reads a text file of up to `limit` bytes, and never reads more than that.
pub(crate) fn read_text(path: &Path, limit: usize) -> Result<String, Failure> {
    let name = path.in_message();
    let read = disk::read_start(path, limit as u64 + 1);
    let bytes = read.map_err(|error| Failure::read(path, error))?;
    if bytes.starts_with(&ZSTD) {
        bail!(
            "{name}: this is an archive, not a text file; unpack it (tar -xf {name}), and pass a file or \
             folder from it"
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
        for level in ["wwww\nw.Aw\nwwww\n", "A g\nw\nwww\nwww", "w w\r\nwAw\r\n", "\u{feff}ww\rwA\rww"] {
            assert!(is_level(level), "{level}");
        }
        for other in
            ["", "\n", "BasicGame\n", "BasicGame\n  SpriteSet\n    a > Door\n", "ELF", "a > b\nc > d\n"]
        {
            assert!(!is_level(other), "{other}");
        }
    }
}
