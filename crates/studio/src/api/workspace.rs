//! Requests about the opened games and their files.

use crate::files;
use crate::files::NamedText;
use crate::frames::{Frame, TileSvg, Tiles};
use crate::refusal::Refusal;
use crate::studio::Studio;
use crate::templates::{GAME_FILE, TEMPLATES, Template};
use crate::workspace::{GameEntry, Place};
use axum::http::StatusCode;
use base::{Digest, Seed};
use engine::{Episode, describe};
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;
use std::sync::PoisonError;

pub(crate) fn workspace(studio: &Studio) -> Result<Value, Refusal> {
    let games = studio.workspace.games();
    let listed: Vec<Value> = games.par_iter().map(|game| summary(studio, game)).collect();
    Ok(json!({
        "kind": studio.workspace.kind,
        "name": studio.workspace.name,
        "version": studio.version,
        "games": listed,
        "judge": studio.judging.is_some(),
        "templates": TEMPLATES.map(|Template { genre, about, .. }| json!({ "genre": genre, "about": about })),
    }))
}

fn summary(studio: &Studio, game: &GameEntry) -> Value {
    // A game that cannot be read, or that has problems, is listed without an image.
    let (tiles, frame) =
        first_board(studio, game).map_or((Vec::new(), None), |(tiles, frame)| (tiles, Some(frame)));
    json!({
        "id": game.id,
        "title": game.title,
        "levels": game.count(),
        "writable": game.is_writable(),
        "summary": game.summary,
        "kind": of_card(game, "kind"),
        "tier": hardest(game),
        "tile": frame,
        "tiles": tiles,
    })
}

/// Returns a field of a game's card; `None` if the card has no such field.
fn of_card<'a>(game: &'a GameEntry, field: &str) -> Option<&'a Value> {
    game.card.as_ref()?.get(field)
}

/// Returns the highest tier among a game's levels; `None` if no tier is known.
fn hardest(game: &GameEntry) -> Option<u64> {
    let levels = of_card(game, "levels")?.as_array()?;
    levels.iter().filter_map(|level| level.get("tier")?.as_u64()).max()
}

/// Draws a game's first level, if the level exists and has no problems.
pub(crate) fn first_board(studio: &Studio, game: &GameEntry) -> Option<(Vec<TileSvg>, Frame)> {
    let (source, levels) = game.read().ok()?;
    let compiled = studio.compiled.find(&source.text).ok()?;
    let level = compiled.game.level(&levels.first()?.text).ok()?;
    let state = compiled.game.start(&level, Seed::from_text("board"));
    let mut tiles = Tiles::default();
    let frame = Frame::of(&compiled, &state, 0, &mut tiles).ok()?;
    Some((tiles.fresh(), frame))
}

pub(crate) fn game(studio: &Studio, id: &str) -> Result<Value, Refusal> {
    let game = studio.workspace.game(id)?;
    let (source, levels) = game.read()?;
    let described =
        studio.compiled.find(&source.text).map_or_else(|_| String::new(), |found| describe(&found.game));
    let file = |NamedText { name, text }: &NamedText| json!({ "name": name, "text": text, "digest": Digest::of(text.as_bytes()) });
    let witnesses = game.witnesses.iter();
    let witnesses: Vec<Value> =
        witnesses.map(|witness| json!({ "name": witness.name, "level": witness.level })).collect();
    Ok(json!({
        "id": game.id,
        "title": game.title,
        "writable": game.is_writable(),
        "source": file(&source),
        "levels": levels.iter().map(file).collect::<Vec<_>>(),
        "card": game.card,
        "witnesses": witnesses,
        "describe": described,
    }))
}

pub(crate) fn versions(studio: &Studio, id: &str) -> Result<Value, Refusal> {
    let (source, levels) = studio.workspace.game(id)?.read()?;
    let files: BTreeMap<String, Digest> = std::iter::once(source)
        .chain(levels)
        .map(|NamedText { name, text }| (name, Digest::of(text.as_bytes())))
        .collect();
    Ok(json!({ "files": files }))
}

pub(crate) fn witness(studio: &Studio, id: &str, name: &str) -> Result<Episode, Refusal> {
    let game = studio.workspace.game(id)?;
    let found = game.witnesses.iter().find(|witness| witness.name == name);
    found.map(|witness| witness.episode.clone()).ok_or_else(|| Refusal::missing("there is no such recording"))
}

/// A request to save a text. It contains the digest of the file version on which the text is based.
#[derive(Deserialize)]
pub(crate) struct Save {
    text: String,
    base: Option<Digest>,
}

pub(crate) fn save(studio: &Studio, id: &str, name: &str, asked: Save) -> Result<Value, Refusal> {
    let game = studio.workspace.game(id)?;
    let path = game.path_of(name)?;
    let limit = match files::level_number(name) {
        Some(_) => engine::MAX_LEVEL_TEXT,
        None => engine::MAX_SOURCE,
    };
    if asked.text.len() > limit {
        return Err(Refusal::new(
            StatusCode::PAYLOAD_TOO_LARGE,
            format_args!("{name} is larger than the limit of {limit} bytes"),
        ));
    }
    let _saving = studio.saving.lock().unwrap_or_else(PoisonError::into_inner);
    unchanged(&path, name, asked.base, "keep one of the two texts, or merge them, and save again")?;
    files::write(&path, &asked.text)?;
    Ok(json!({ "digest": Digest::of(asked.text.as_bytes()) }))
}

/// Rejects the request if a file is no longer the version that the page has loaded.
fn unchanged(path: &Path, name: &str, base: Option<Digest>, help: &str) -> Result<(), Refusal> {
    let now = files::content(path)?;
    let digest = now.as_ref().map(|text| Digest::of(text.as_bytes()));
    if digest == base {
        return Ok(());
    }
    let error = match now {
        Some(_) => format!("{name} was changed by another program"),
        None => format!("{name} was removed by another program"),
    };
    let refusal = Refusal::new(StatusCode::CONFLICT, error).help(help);
    Err(refusal.with("text", now).with("digest", json!(digest)))
}

/// A request to remove a file. It contains the digest of the file version that the page has loaded.
#[derive(Deserialize)]
pub(crate) struct Remove {
    base: Digest,
}

pub(crate) fn remove(studio: &Studio, id: &str, name: &str, asked: Remove) -> Result<Value, Refusal> {
    let game = studio.workspace.game(id)?;
    let path = game.path_of(name)?;
    let _saving = studio.saving.lock().unwrap_or_else(PoisonError::into_inner);
    // Only the last level can be removed, so that no gap appears among the level numbers.
    let last = match &game.place {
        Place::Folder { folder, source, .. } => {
            files::level_files(folder, source)?.last().map(|(last, _)| *last)
        }
        _ => None,
    };
    let Some(last) = last.filter(|_| files::level_number(name).is_some()) else {
        return Err(Refusal::forbidden("only levels can be removed"));
    };
    if files::level_number(name) < Some(last) {
        return Err(Refusal::forbidden(format_args!("only the last level, lvl{last}.txt, can be removed"))
            .help("move the parts that you want to keep to earlier levels"));
    }
    unchanged(&path, name, Some(asked.base), "check the current content before you remove the level")?;
    files::remove(&path)?;
    Ok(json!({}))
}

/// A request to copy a game. It contains the title of the copy.
#[derive(Deserialize)]
pub(crate) struct Copy {
    id: String,
    title: String,
}

/// The maximum length of the folder name for a copy, in characters.
const MAX_FOLDER: usize = 60;

pub(crate) fn copy(studio: &Studio, asked: Copy) -> Result<Value, Refusal> {
    let game = studio.workspace.game(&asked.id)?;
    let (source, levels) = game.read()?;
    let summary = format!("a copy of {}", game.title);
    add(studio, asked.title, summary, |folder| {
        fs::create_dir(folder)?;
        for (number, level) in levels.iter().enumerate() {
            files::put(&folder.join(format!("lvl{number}.txt")), &level.text)?;
        }
        files::put(&folder.join(GAME_FILE), &source.text)
    })
}

/// A request for a new game. It contains the genre and the title.
#[derive(Deserialize)]
pub(crate) struct Begin {
    genre: String,
    title: String,
}

pub(crate) fn begin(studio: &Studio, asked: Begin) -> Result<Value, Refusal> {
    let Some(template) = Template::of(&asked.genre) else {
        return Err(Refusal::bad("there is no such genre").help("load the page again"));
    };
    add(studio, asked.title, template.about.to_owned(), |folder| template.begin(folder))
}

/// Writes a game into a new folder among the copies, named after the title, and adds the game to the
/// workspace.
fn add(
    studio: &Studio,
    title: String,
    summary: String,
    write: impl Fn(&Path) -> io::Result<()>,
) -> Result<Value, Refusal> {
    let name = folder_name(&title);
    if name.is_empty() {
        return Err(Refusal::bad("the title contains no letters or digits")
            .help("use letters from a to z or digits from 0 to 9"));
    }
    let failed = |name: &str, error: io::Error| {
        Refusal::failed(format_args!("cannot write the folder {name}: {}", error.kind()))
            .help("open the studio in a writable folder, or choose a different folder with --out")
    };
    let _saving = studio.saving.lock().unwrap_or_else(PoisonError::into_inner);
    let copies = &studio.workspace.copies;
    // The opened folder may not exist yet.
    fs::create_dir_all(copies).map_err(|error| failed(&studio.workspace.name, error))?;
    let numbered = std::iter::once(name.clone()).chain((2..1000).map(|number| format!("{name}-{number}")));
    for name in numbered {
        let folder = copies.join(&name);
        match write(&folder) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            Err(error) => return Err(failed(&name, error)),
        }
        let place = Place::Folder { folder, source: GAME_FILE.to_owned(), writable: true };
        let game = GameEntry { id: name, title, place, card: None, summary, witnesses: Vec::new() };
        return Ok(json!({ "id": studio.workspace.add(game) }));
    }
    Err(Refusal::bad("there are too many games with this title").help("choose another title"))
}

/// Returns a folder name for a title. It consists of lower-case letters, digits and dashes.
fn folder_name(title: &str) -> String {
    let words = title.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let name = words.map(str::to_ascii_lowercase).collect::<Vec<_>>().join("-");
    name.chars().take(MAX_FOLDER).collect::<String>().trim_end_matches('-').to_owned()
}

#[cfg(test)]
mod tests {
    use super::folder_name;

    #[test]
    fn titles_make_plain_names_of_folders() {
        let check = |title: &str, expect: &str| assert_eq!(folder_name(title), expect);
        check("My Game 2", "my-game-2");
        check("../../etc/passwd", "etc-passwd");
        check("..", "");
        check("<script>", "script");
        check("", "");
        assert_eq!(folder_name(&"long ".repeat(100)).len(), 59);
    }
}
