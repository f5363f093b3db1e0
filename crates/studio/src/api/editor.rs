//! Requests from an editor about the text of a game and its levels.

use crate::compiled::Compiled;
use crate::frames::Tiles;
use crate::positions;
use crate::refusal::Refusal;
use crate::studio::Studio;
use axum::http::StatusCode;
use editor::Hover;
use editor::positions::byte_of_utf16;
use engine::analysis::Role;
use engine::{Diagnostics, LevelMapping, MAX_LEVEL_TEXT, MAX_SOURCE, describe};
use serde::Deserialize;
use serde_json::{Value, json};

/// The maximum number of edits in a renaming. Each edit takes about a hundred bytes in the response.
const MAX_EDITS: usize = 100_000;

/// Rejects texts that are too large for a game or a level.
fn bounded(source: &str, levels: &[String]) -> Result<(), Refusal> {
    let too_large = |what: &str, limit: usize| {
        Refusal::new(
            StatusCode::PAYLOAD_TOO_LARGE,
            format_args!("{what} is larger than the limit of {limit} bytes"),
        )
    };
    match () {
        () if source.len() > MAX_SOURCE => Err(too_large("a game", MAX_SOURCE)),
        () if levels.iter().any(|level| level.len() > MAX_LEVEL_TEXT) => {
            Err(too_large("a level", MAX_LEVEL_TEXT))
        }
        () => Ok(()),
    }
}

/// A request to check the text of a game and its levels.
#[derive(Deserialize)]
pub(crate) struct Check {
    source: String,
    #[serde(default)]
    levels: Vec<String>,
}

pub(crate) fn check(studio: &Studio, asked: Check) -> Result<Value, Refusal> {
    let Check { source, levels } = asked;
    bounded(&source, &levels)?;
    let listed = |text: &str, problems: &[engine::Diagnostic]| -> Vec<Value> {
        problems.iter().map(|problem| positions::problem(text, problem)).collect()
    };
    match studio.compiled.find(&source) {
        Ok(compiled) => {
            let of_level = |level: &String| match compiled.game.level(level) {
                Ok(found) => json!({ "problems": listed(level, found.warnings()) }),
                Err(Diagnostics(problems)) => json!({ "problems": listed(level, &problems) }),
            };
            let mut tiles = Tiles::default();
            let legend = legend(&compiled, &mut tiles);
            Ok(json!({
                "problems": listed(&source, compiled.game.warnings()),
                "levels": levels.iter().map(of_level).collect::<Vec<_>>(),
                "describe": describe(&compiled.game),
                "legend": legend,
                "tiles": tiles.fresh(),
            }))
        }
        Err(Diagnostics(problems)) => {
            let mapping = LevelMapping::of_source(&source);
            let of_level = |level: &String| {
                let problems = mapping.as_ref().map_or(Vec::new(), |mapping| mapping.problems(level));
                json!({ "problems": listed(level, &problems) })
            };
            Ok(json!({
                "problems": listed(&source, &problems),
                "levels": levels.iter().map(of_level).collect::<Vec<_>>(),
                "describe": "",
                "legend": [],
                "tiles": [],
            }))
        }
    }
}

/// Returns the characters used in levels, each with its tile and the types that it places.
fn legend(compiled: &Compiled, tiles: &mut Tiles) -> Vec<Value> {
    let Compiled { source, game, looks, analysis } = compiled;
    let order = game.drawing_order();
    let entry = |symbol: u8| {
        let types = game.places(symbol);
        let visible = types.iter().filter(|&&stype| looks.is_visible(stype));
        let on_top = visible.max_by_key(|stype| order.iter().position(|&at| at == stype.0));
        let tile = on_top.map(|&stype| tiles.number(&render::sprite_tile(looks, stype)));
        let names: Vec<&str> = types.iter().map(|&stype| game.name(stype)).collect();
        let label = on_top.map_or("", |&stype| looks.meaning(stype));
        let is_floor = types.iter().all(|&stype| analysis.role(stype) == Role::Floor);
        json!({ "symbol": game.character(symbol), "types": names, "label": label, "tile": tile, "floor": is_floor })
    };
    // The characters that the game maps come first, in the game's order. Characters that map to one of the game's
    // types by default follow.
    let written = game.description().mapping.iter().filter_map(|line| u8::try_from(line.symbol).ok());
    let mut symbols: Vec<u8> = written.collect();
    let by_default = (b'!'..=b'~').filter(|symbol| !symbols.contains(symbol));
    let is_used = |symbol: &u8| game.places(*symbol).iter().any(|&stype| is_named(source, game.name(stype)));
    let by_default = by_default.filter(is_used);
    symbols.extend(by_default.collect::<Vec<u8>>());
    symbols.retain(|&symbol| !game.places(symbol).is_empty());
    symbols.into_iter().map(entry).collect()
}

/// Returns `true` if a word occurs in a game's text outside of comments.
fn is_named(source: &str, name: &str) -> bool {
    let code = source.lines().filter_map(|line| line.split('#').next());
    code.flat_map(|code| code.split(|c: char| !c.is_alphanumeric() && c != '_')).any(|word| word == name)
}

/// A request about a position in a game's text, in UTF-16 code units.
#[derive(Deserialize)]
pub(crate) struct At {
    source: String,
    at: usize,
}

pub(crate) fn hover(_: &Studio, At { source, at }: At) -> Result<Value, Refusal> {
    bounded(&source, &[])?;
    let found = editor::hover(&source, byte_of_utf16(&source, at));
    Ok(json!(found.map(|Hover { span, markdown }| {
        let (start, end) = positions::range(&source, span);
        json!({ "start": start, "end": end, "markdown": markdown })
    })))
}

pub(crate) fn complete(_: &Studio, At { source, at }: At) -> Result<Value, Refusal> {
    bounded(&source, &[])?;
    let found = editor::complete(&source, byte_of_utf16(&source, at));
    let (start, end) = positions::range(&source, found.span);
    let items = found.items.into_iter().map(|item| {
        json!({ "label": item.label, "detail": item.detail, "markdown": item.markdown, "insert": item.insert })
    });
    Ok(json!({ "start": start, "end": end, "items": items.collect::<Vec<Value>>() }))
}

pub(crate) fn definition(_: &Studio, At { source, at }: At) -> Result<Value, Refusal> {
    bounded(&source, &[])?;
    let found = editor::definition(&source, byte_of_utf16(&source, at));
    Ok(json!(found.map(|span| {
        let (start, end) = positions::range(&source, span);
        json!({ "start": start, "end": end })
    })))
}

/// A request to rename the symbol at a position.
#[derive(Deserialize)]
pub(crate) struct Rename {
    source: String,
    at: usize,
    name: String,
    /// The levels, which must also change if a character that they use is renamed.
    #[serde(default)]
    levels: Vec<String>,
}

pub(crate) fn rename(_: &Studio, asked: Rename) -> Result<Value, Refusal> {
    let Rename { source, at, name, levels } = asked;
    bounded(&source, &levels)?;
    let byte = byte_of_utf16(&source, at);
    let edits = editor::rename(&source, byte, &name).map_err(Refusal::bad)?;
    // A level character must be replaced with a single character, in the levels as well.
    let old = editor::renamable(&source, byte).ok().and_then(|span| source.get(span.start..span.end));
    let is_symbol = editor::definition(&source, byte).is_some_and(|span| in_mapping(&source, span.start));
    let single = |text: &str| {
        let mut characters = text.chars();
        characters.next().filter(|_| characters.next().is_none())
    };
    let symbols = old.filter(|_| is_symbol).and_then(single).zip(single(&name));
    let of_level = |level: &String| -> Vec<Value> {
        let edits = symbols.map_or(Vec::new(), |(old, new)| editor::rename_in_level(level, old, new));
        edits.iter().map(|made| positions::edit(level, made)).collect()
    };
    let places = |level: &String| symbols.map_or(0, |(old, _)| level.matches(old).count());
    if edits.len() + levels.iter().map(places).sum::<usize>() > MAX_EDITS {
        return Err(Refusal::bad(format_args!("the name occurs in more than {MAX_EDITS} places"))
            .help("rename it with a text editor"));
    }
    let edits: Vec<Value> = edits.iter().map(|made| positions::edit(&source, made)).collect();
    Ok(json!({ "edits": edits, "levels": levels.iter().map(of_level).collect::<Vec<_>>() }))
}

/// Returns `true` if a LevelMapping line starts at this byte, so that the byte is the mapped character.
fn in_mapping(source: &str, byte: usize) -> bool {
    let (description, _) = engine::syntax::parse(source);
    description.mapping.iter().any(|line| line.span.start == byte)
}

/// A request with the text of a game.
#[derive(Deserialize)]
pub(crate) struct Source {
    source: String,
}

pub(crate) fn format(_: &Studio, Source { source }: Source) -> Result<Value, Refusal> {
    bounded(&source, &[])?;
    let refused = |problems: Vec<editor::Problem>| {
        let first = problems.first().map_or("", |problem| problem.message.as_str());
        Refusal::bad(format_args!("the game has errors: {first}")).help("fix them first")
    };
    Ok(json!({ "text": editor::format(&source).map_err(refused)? }))
}

/// A request for a manual page, by name.
#[derive(Deserialize)]
pub(crate) struct Page {
    name: String,
}

pub(crate) fn page(studio: &Studio, asked: Page) -> Result<Value, Refusal> {
    let of_word = || editor::page(&asked.name).map(str::to_owned);
    let text = (studio.manual)(&asked.name).or_else(of_word);
    Ok(json!({ "markdown": text.ok_or_else(|| Refusal::missing("the manual has no such page"))? }))
}
