//! `docs/reference/limits.md` states the values of the constants in `engine::limits`.

use engine::limits;
use tests::read;

/// Defines the constants with their names.
macro_rules! constants {
    ($($name:ident)*) => { [$((stringify!($name), limits::$name as usize)),*] };
}

#[test]
fn the_page_lists_every_limit() {
    let constants = constants! {
        MAX_SOURCE MAX_LINE MAX_NAME MAX_NESTING MAX_TYPES MAX_PARAMETERS MAX_LIST MAX_INTERACTIONS MAX_REACH
        MAX_COUNTERS MAX_SQUARE MAX_PROBLEMS MAX_LEVEL_TEXT MAX_SIDE MAX_CELLS MAX_SPRITES MAX_ATTEMPTS MAX_TICKS MAX_MESSAGES MAX_SLOTS MAX_WORK
        EFFECT_WORK MAX_TIMERS MAX_HELD MAX_SEEN
    };
    let source = read("engine/src/limits.rs");
    let declared = source.lines().filter_map(|line| line.strip_prefix("pub const ")?.split_once(':'));
    let declared: Vec<&str> = declared.map(|(name, _)| name).collect();
    assert_eq!(declared, constants.map(|(name, _)| name), "this test checks every constant");
    let page = read("docs/reference/limits.md");
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.contains('`'));
    let rows = rows.map(|line| line.split('|').map(str::trim).collect());
    // The engine's limits are the table rows that have a constant and a result.
    let rows: Vec<Vec<&str>> = rows.filter(|row: &Vec<&str>| row.len() == 6).collect();
    for (name, value) in constants {
        let quoted = format!("`{name}`");
        let found: Vec<&str> = rows.iter().filter(|row| row[3] == quoted).map(|row| row[2]).collect();
        assert!(!found.is_empty(), "docs/reference/limits.md does not list {name}");
        assert!(found.iter().all(|limit| *limit == value.to_string()), "{name} is {value}, not {found:?}");
    }
    assert!(rows.iter().all(|row| declared.contains(&row[3].trim_matches('`'))), "a limit that is none");
}
