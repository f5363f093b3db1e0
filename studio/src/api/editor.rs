//! What an editor asks of the text of a game and its levels.

use crate::compiled::Compiled;
use crate::frames::Tiles;
use crate::positions;
use crate::refusal::Refusal;
use crate::studio::Studio;
use engine::{Diagnostics, LevelMapping, describe};
use serde::Deserialize;
use serde_json::{Value, json};

/// The text of a game, and its levels.
#[derive(Deserialize)]
pub(crate) struct Check {
    source: String,
    #[serde(default)]
    levels: Vec<String>,
}

pub(crate) fn check(studio: &Studio, asked: Check) -> Result<Value, Refusal> {
    let Check { source, levels } = asked;
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

/// Returns the characters of levels, with what each places and looks like.
fn legend(compiled: &Compiled, tiles: &mut Tiles) -> Vec<Value> {
    let Compiled { game, looks, .. } = compiled;
    let order = game.drawing_order();
    let entry = |symbol: u8| {
        let types = game.places(symbol);
        let visible = types.iter().filter(|&&stype| looks.is_visible(stype));
        let on_top = visible.max_by_key(|stype| order.iter().position(|&at| at == stype.0));
        let tile = on_top.map(|&stype| tiles.number(&render::sprite_tile(looks, stype)));
        let names: Vec<&str> = types.iter().map(|&stype| game.name(stype)).collect();
        let label = on_top.map_or("", |&stype| looks.meaning(stype));
        json!({ "symbol": char::from(symbol), "types": names, "label": label, "tile": tile })
    };
    // Those that the game maps, in its order, then those that are mapped by default.
    let written = game.description().mapping.iter().filter_map(|line| u8::try_from(line.symbol).ok());
    let mut symbols: Vec<u8> = written.collect();
    let by_default = (b'!'..=b'~').filter(|symbol| !symbols.contains(symbol));
    symbols.extend(by_default.collect::<Vec<u8>>());
    symbols.retain(|&symbol| !game.places(symbol).is_empty());
    symbols.into_iter().map(entry).collect()
}

/// The name of a page of the manual.
#[derive(Deserialize)]
pub(crate) struct Page {
    name: String,
}

pub(crate) fn page(studio: &Studio, asked: Page) -> Result<Value, Refusal> {
    let found = (studio.manual)(&asked.name);
    let text = found.ok_or_else(|| Refusal::missing("the manual has no such page"))?;
    Ok(json!({ "markdown": text }))
}
