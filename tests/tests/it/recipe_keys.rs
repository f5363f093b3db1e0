//! The book's page with every recipe key, generated from the structs into which recipes are parsed.

use std::fmt::Write;
use std::fs;

use tests::{read, workspace_root};

const PAGE: &str = "docs/reference/recipe-keys.md";

const HEAD: &str = "# Keys of a recipe

This page lists every key of a [recipe](recipes.md) with its default, as the code documents it. A test compares the page with the code.
`BLESS=1 cargo test -p infinite-arcade-tests --test it recipe_keys` writes it again.
";

const PARTS: &str = "crates/snapshots/src/recipe/parts.rs";
const PUZZLES: &str = "crates/snapshots/src/sections/puzzles/mod.rs";

/// The recipe sections, each with its heading, and the file and name of the struct into which the section is parsed.
const SECTIONS: [(&str, &str, &str); 16] = [
    ("The recipe as a whole", "crates/snapshots/src/recipe/mod.rs", "Recipe"),
    ("`[invented]`", PARTS, "InventedPart"),
    ("`[designs]`", "crates/snapshots/src/sections/designs/mod.rs", "DesignsPart"),
    ("`[generated]`", PARTS, "GeneratedPart"),
    ("`[corpus]`", PARTS, "CorpusPart"),
    ("`[puzzles]`, `[locks]`, `[yards]`, `[strays]`", PUZZLES, "PuzzlePart"),
    ("`[tiers]`", "crates/snapshots/src/sections/tiers/mod.rs", "Tiers"),
    ("`[marks]`", "crates/snapshots/src/sections/marks/mod.rs", "MarksPart"),
    ("`[ceilings]`", "crates/snapshots/src/sections/ceilings/mod.rs", "CeilingsPart"),
    ("`[memory]`", "crates/snapshots/src/sections/memory/part.rs", "MemoryPart"),
    ("`[taxonomy]`", PARTS, "Taxonomy"),
    ("`[board]`", "crates/forge/src/games/order.rs", "Board"),
    ("`[beacon]`", "crates/snapshots/src/recipe/beacon.rs", "BeaconPart"),
    ("`[known]`", "crates/snapshots/src/recipe/known.rs", "Known"),
    ("`[criteria]`", "validators/src/thresholds.rs", "Criteria"),
    ("`[criteria.gates]`", "validators/src/gates/thresholds.rs", "Gates"),
];

/// A key in a section.
#[derive(Debug, PartialEq)]
struct Key {
    name: String,
    /// The default as written in the code; empty if there is no default.
    default: String,
    doc: String,
}

/// Returns a struct's public fields, parsed from formatted source code, with their names in files.
fn keys(source: &str, name: &str) -> Vec<Key> {
    let start = format!("pub struct {name} {{");
    let body = source.lines().skip_while(|line| line.trim() != start).skip(1);
    let body = body.take_while(|line| line.trim() != "}");
    let (mut keys, mut doc, mut renamed) = (Vec::new(), String::new(), None);
    for line in body.map(str::trim) {
        if let Some(text) = line.strip_prefix("///") {
            doc += text;
        } else if let Some((_, rest)) = line.split_once("rename = \"") {
            renamed = rest.split('"').next().map(str::to_owned);
        } else if let Some(field) = line.strip_prefix("pub ") {
            let (field, rest) = field.split_once(": ").expect("a field has a type");
            let default = rest.split_once(" = ").map_or("", |(_, default)| default);
            keys.push(Key {
                name: renamed.take().unwrap_or_else(|| field.to_owned()),
                default: in_toml(default.trim_end_matches(',')),
                doc: std::mem::take(&mut doc).trim().replace('|', "\\|"),
            });
        }
    }
    keys
}

/// Returns a default in the notation of recipes; empty if the default's expression is not a plain value.
fn in_toml(value: &str) -> String {
    let list = value.strip_prefix("names(&").and_then(|list| list.strip_suffix(')'));
    let list = list.or_else(|| value.strip_prefix("vec!")).unwrap_or(value);
    let plain = match list {
        "" | "None" | "Vec::new()" => return String::new(),
        list if list.contains("::") => return String::new(),
        list => list.replace('_', if list.starts_with(|c: char| c.is_ascii_digit()) { "" } else { "_" }),
    };
    let plain = plain
        .strip_prefix('(')
        .and_then(|pair| pair.strip_suffix(')'))
        .map_or(plain.clone(), |pair| format!("[{pair}]"));
    format!("`{plain}`")
}

fn page() -> String {
    let mut text = HEAD.to_owned();
    for (heading, file, name) in SECTIONS {
        let _ = write!(text, "\n## {heading}\n\n| Key | Default | Meaning |\n|---|---|---|\n");
        let keys = keys(&read(file), name);
        assert!(!keys.is_empty(), "{file} has no struct {name}");
        for Key { name, default, doc } in keys {
            let _ = writeln!(text, "| `{name}` | {default} | {doc} |");
        }
    }
    text
}

#[test]
fn the_page_lists_every_key() {
    let page = page();
    if std::env::var_os("BLESS").is_some() {
        fs::write(workspace_root().join(PAGE), &page).expect("writable");
    }
    let written = fs::read_to_string(workspace_root().join(PAGE)).unwrap_or_default();
    let differing = page.lines().zip(written.lines()).find(|(new, old)| new != old);
    assert!(page == written, "{PAGE} is old; {HEAD}\n{differing:?}");
}

#[test]
fn every_table_of_a_recipe_has_a_section() {
    let (_, file, name) = SECTIONS[0];
    let plain = ["name", "description", "authors", "publisher", "seed", "commitment", "parent", "difficulty"];
    let tables = keys(&read(file), name).into_iter().filter(|key| !plain.contains(&key.name.as_str()));
    let is_missing =
        |table: &Key| !SECTIONS.iter().any(|(heading, ..)| heading.contains(&format!("[{}]", table.name)));
    assert_eq!(tables.filter(is_missing).collect::<Vec<Key>>(), []);
}

#[test]
fn keys_are_read_from_a_struct() {
    let source = "pub struct Other {\n    /// No.\n    pub no: u32 = 1,\n}\npub struct Part {\n    /// The number\n    /// of games.\n    \
                  pub games: u32 = 1_000,\n    #[serde(rename = \"plays\")]\n    /// Names.\n    pub of: Vec<String> = names(&[\"a\"]),\n    \
                  /// Sizes.\n    pub rows: (usize, usize) = (8, 11),\n    /// A digest.\n    pub parent: Option<Digest>,\n}\n";
    let key = |name: &str, default: &str, doc: &str| Key {
        name: name.to_owned(),
        default: default.to_owned(),
        doc: doc.to_owned(),
    };
    let expect = [
        key("games", "`1000`", "The number of games."),
        key("plays", "`[\"a\"]`", "Names."),
        key("rows", "`[8, 11]`", "Sizes."),
        key("parent", "", "A digest."),
    ];
    assert_eq!(keys(source, "Part"), expect);
}
