//! Advice on a known recipe key that is in the wrong table.

use crate::recipe::parts::{CorpusPart, GeneratedPart, InventedPart};
use crate::sections::SECTIONS;
use forge::games::Board;
use generators::games::Kind;
use serde::Serialize;
use validators::Criteria;

/// The top-level keys of a recipe, which come before its first table.
const HEAD: [&str; 7] = ["name", "description", "authors", "publisher", "seed", "commitment", "parent"];
/// The tables of a recipe, except those of [`SECTIONS`].
const TABLES: [&str; 9] =
    ["beacon", "board", "corpus", "criteria", "difficulty", "generated", "invented", "known", "taxonomy"];

/// Returns the name of the first table that contains a key, such as `corpus.criteria`; `None` if no table contains it.
fn table_with(key: &str, tables: &toml::Table) -> Option<String> {
    tables.iter().find_map(|(name, value)| {
        let table = value.as_table()?;
        match table.contains_key(key) {
            true => Some(name.clone()),
            false => table_with(key, table).map(|inner| format!("{name}.{inner}")),
        }
    })
}

/// Returns advice on a known key that is in the wrong table; `None` for an unknown key. A common cause is a line
/// appended to a file, because the line becomes part of the last table.
pub(crate) fn placement(error: &toml::de::Error, text: &str) -> Option<String> {
    let key = error.message().strip_prefix("unknown field `")?.split('`').next()?;
    let recipe: toml::Table = toml::from_str(text).ok()?;
    let holds = |value: &toml::Value| value.as_table().is_some_and(|table| table.contains_key(key));
    if let Some(table) = table_with(key, &recipe) {
        if HEAD.contains(&key) {
            return Some(format!(
                "`{key}` is in the table [{table}], but belongs to the recipe as a whole: move the line \
                 above the first [table]"
            ));
        }
        if TABLES.contains(&key) || SECTIONS.iter().any(|section| section.name() == key) {
            return Some(format!("`{key}` is a table of its own: write [{key}] instead of [{table}.{key}]"));
        }
    }
    if !recipe.contains_key(key) && !recipe.values().any(holds) {
        return None;
    }
    let known = [
        ("generated", keys_of(&GeneratedPart { kinds: vec![Kind::KeyAndDoor], ..GeneratedPart::default() })),
        ("invented", keys_of(&InventedPart::default())),
        ("corpus", keys_of(&CorpusPart::default())),
        ("criteria", keys_of(&Criteria::default())),
        ("board", keys_of(&Board::default())),
    ];
    let tables: Vec<String> = known
        .iter()
        .filter(|(_, keys)| keys.iter().any(|known| known == key))
        .map(|(table, _)| format!("[{table}]"))
        .collect();
    (!tables.is_empty())
        .then(|| format!("`{key}` belongs in {}: move it below that line", tables.join(" or ")))
}

/// Returns the keys of a table.
fn keys_of(table: &impl Serialize) -> Vec<String> {
    let value = serde_json::to_value(table).expect("a part of a recipe is plain data");
    value.as_object().map_or_else(Vec::new, |keys| keys.keys().cloned().collect())
}
