//! Games and levels specified by the user: files, folders and names of corpus games.

pub(crate) mod embedded;
pub(crate) mod episodes;
pub(crate) mod game_input;
pub(crate) mod text;
pub(crate) mod trusted;

use crate::diagnostics::Named;
use crate::failure::Failure;
use crate::input::game_input::{GameInput, LevelInput, LevelPlace, number_like, of_source};
use crate::input::text::{file_names, folder_of, is_game, is_level, read_text, sorted_entries};
use crate::{paths, shell};
use base::MessagePath;
use engine::{MAX_LEVEL_TEXT, MAX_SOURCE, dialect, layout};
use std::path::Path;
use std::sync::Arc;

/// Finds a game by its file, its folder, one of its level files, or the name of a corpus game.
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

/// A file specified by the user: a game, or a level with the game beside it, if any.
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
            // A folder that cannot be listed is an error only for `game.*`, whose levels are expected beside
            // it.
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

/// Returns the failure for a level without a game beside it, with advice. The game may be in the parent
/// folder.
fn lost_level(path: &Path) -> Failure {
    let name = path.in_message();
    let beside = games_in(folder_of(path)).unwrap_or_default();
    if beside.len() > 1 {
        let names =
            beside.iter().map(|game| format!("`{}`", game.source.name)).collect::<Vec<_>>().join(", ");
        return malformed!(
            "{name} is a level, and several games are next to it ({names}); pass its game first: \
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

/// Rejects a Python file, and suggests the command that converts a Python game.
fn refuse_python(path: &Path, text: &str) -> Result<(), Failure> {
    let Some(found) = dialect::python_file(text) else { return Ok(()) };
    let levels = match found.levels.len() {
        1 => "1 level".to_owned(),
        count => format!("{count} levels"),
    };
    let out = path.file_stem().map_or_else(|| "game".into(), |stem| stem.to_string_lossy());
    bail!(
        "{}: this is a Python file that contains a game in the py-vgdl dialect (line {}) and {levels}; \
         convert it first: arcade fmt --from py-vgdl {} --out {}",
        path.in_message(),
        found.line,
        shell::quoted(path),
        shell::quoted(Path::new(&*out))
    )
}

/// The argument that selects all corpus games, unless a folder of that name exists.
pub(crate) const CORPUS: &str = "corpus";

/// Finds all games specified by an argument: the game found by [`game`], all games in a folder of games (or
/// in a folder of such folders), or the corpus games for `corpus`.
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

/// Returns `true` if new games can be created at `place`. The path must either not exist or be a folder
/// without games or visible subfolders. A name with an extension counts as a file, and the name of a corpus
/// game counts as a game.
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

/// Returns the game or path that the user probably meant by the nonexistent path `place`.
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

/// Finds the games in a list of arguments. A level file selects only that level of its game. It can be
/// followed by more levels of that game, or by the game itself. A number, or a level without a game beside
/// it, belongs to the preceding game.
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

/// Returns the error for a folder that contains no game, with a hint: the folder may be a release, whose games are
/// in subfolders.
fn no_game_in(folder: &Path) -> Failure {
    let name = folder.in_message();
    let below = folder.join("games");
    let games = sorted_entries(&below).unwrap_or_default();
    match games.iter().find(|game| game.join("game.vgdl").is_file()) {
        Some(first) => malformed!(
            "{name}: not a game folder, but its folder {} contains games: pass that folder to use all of \
             them, or one game, such as {}",
            below.in_message(),
            first.in_message()
        ),
        None => malformed!(
            "{name}: this folder contains no game.vgdl or game.txt, and no NAME.txt with NAME_lvl0.txt next \
             to it"
        ),
    }
}

/// Finds the path with the most similar name in the same folder, in case the name contains a typing error.
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

/// Reads a game file, and rejects level files.
fn game_text(path: &Path) -> Result<String, Failure> {
    let text = read_text(path, MAX_SOURCE)?;
    if is_level(&text) {
        let name = path.in_message();
        bail!("{name}: this is a level, not a game; put the game here, and the level beside it as lvl0.txt");
    }
    Ok(text)
}
