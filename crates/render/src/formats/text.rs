//! A state as text: one character per cell, followed by the caption, the legend, and the contents of crowded
//! cells.

use super::symbols::{EMPTY, Symbols};
use crate::caption;
use crate::looks::glyph::Glyph;
use crate::looks::look::Looks;
use engine::{Outcome, SpriteType, State};
use std::collections::BTreeSet;
use std::fmt::Write;

/// The maximum number of cells with several sprites to list.
const MAX_STACKS: usize = 20;

/// Returns the board as lines of characters. Each cell shows its topmost sprite. A sprite between cells
/// appears in all cells that it overlaps. Each line ends with a newline. Cost: O(sprites + cells).
pub fn rows(looks: &Looks, symbols: &Symbols, state: &State) -> String {
    let columns = state.size().0.max(1) as usize;
    let cells = stacks(looks, symbols, state);
    let symbol = |stack: &Vec<SpriteType>| stack.last().map_or(EMPTY, |&stype| symbols.symbol(stype));
    let row = |row: &[Vec<SpriteType>]| row.iter().map(symbol).chain(['\n']).collect::<String>();
    cells.chunks(columns).map(row).collect()
}

/// Returns the complete text: the rows, the caption, a legend for the types on the board, and the cells with
/// several sprites.
pub fn text(looks: &Looks, symbols: &Symbols, state: &State) -> String {
    let game = looks.game();
    let mut text = rows(looks, symbols, state);
    let outcome = match state.outcome() {
        Outcome::Ongoing => String::new(),
        Outcome::Stopped(limit) => format!(", stopped: {limit}"),
        other => format!(", {}", format!("{other:?}").to_lowercase()),
    };
    let prospects = looks.prospects();
    let time = prospects.time(state).map_or(String::new(), |time| format!(" ({time})"));
    let _ = writeln!(text, "\ntick {}{time}, score {}{outcome}", state.tick() + 1, state.score());
    let lines = [
        ("holds", caption::holdings(looks, state)),
        ("to win", prospects.goals(state)),
        ("soon", prospects.countdowns(game, state)),
    ];
    for (word, line) in lines.into_iter().filter(|(_, line)| !line.is_empty()) {
        let _ = writeln!(text, "{word}: {line}");
    }
    let cells = stacks(looks, symbols, state);
    let there: BTreeSet<(Glyph, SpriteType)> =
        cells.iter().flatten().map(|&stype| (looks.look(stype).glyph, stype)).collect();
    let _ = writeln!(text);
    for (_, stype) in there {
        let _ = writeln!(text, "{} {} ({})", symbols.symbol(stype), game.name(stype), looks.meaning(stype));
    }
    let columns = state.size().0.max(1) as usize;
    let several: Vec<(usize, &Vec<SpriteType>)> =
        cells.iter().enumerate().filter(|(_, stack)| stack.len() > 1).collect();
    for (cell, stack) in several.iter().take(MAX_STACKS) {
        let names: Vec<&str> = stack.iter().rev().map(|&stype| game.name(stype)).collect();
        let (column, row) = (cell % columns + 1, cell / columns + 1);
        let _ = writeln!(text, "column {column}, row {row}: {}", names.join(" over "));
    }
    if several.len() > MAX_STACKS {
        let _ = writeln!(text, "and {} more cells with several sprites", several.len() - MAX_STACKS);
    }
    text
}

/// Returns the types visible in each cell, row by row and in drawing order, excluding floors.
fn stacks(looks: &Looks, symbols: &Symbols, state: &State) -> Vec<Vec<SpriteType>> {
    let game = looks.game();
    let by_name = |name: &String| {
        let stype = game.sprite_type(name)?;
        (looks.is_visible(stype) && symbols.symbol(stype) != EMPTY).then_some(stype)
    };
    game.observe(state).cells.iter().map(|names| names.iter().filter_map(by_name).collect()).collect()
}
