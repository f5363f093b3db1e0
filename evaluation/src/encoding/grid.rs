//! The board with one character per cell.

use super::scene::{Scene, places};
use crate::legend::Legend;
use engine::Observation;
use render::EMPTY;

/// Draws the board in rows of characters, each row a line: the uppermost sprite of each cell that is not a floor, and the
/// avatar on top. A sprite between cells is drawn in all cells that it overlaps, except for the avatar. Cost: O(cells).
pub fn grid(observation: &Observation, legend: &Legend) -> String {
    let scene = Scene::of(observation, legend);
    let lines = (0..scene.rows).map(|row| {
        let line = (0..scene.columns).map(|column| symbol(legend, scene.at(column, row)));
        line.collect::<String>()
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Draws the board of [`grid`] rotated clockwise by a quarter turn: its first row is the first column of the
/// board, read from the bottom to the top. Cost: O(cells).
pub fn rotated(observation: &Observation, legend: &Legend) -> String {
    let scene = Scene::of(observation, legend);
    let lines = (0..scene.columns).map(|column| {
        let line = (0..scene.rows).rev().map(|row| symbol(legend, scene.at(column, row)));
        line.collect::<String>()
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the character of a cell that holds these names.
fn symbol(legend: &Legend, names: &[&str]) -> char {
    names.last().and_then(|name| legend.entry(name)).map_or(EMPTY, |entry| entry.symbol)
}

/// Lists the piles that one character per cell cannot show: `frost over snow: (3,4) (5,4)`, a line for each pile of several
/// sprites, in the order of the board. Cost: O(cells × piles).
pub fn stacks(observation: &Observation, legend: &Legend) -> Vec<String> {
    let scene = Scene::of(observation, legend);
    let mut piles: Vec<Pile<'_, '_>> = Vec::new();
    for (cell, names) in scene.cells.iter().enumerate().filter(|(_, names)| names.len() > 1) {
        let at = (cell % scene.columns, cell / scene.columns);
        match piles.iter_mut().find(|pile| pile.names == names.as_slice()) {
            Some(pile) => pile.cells.push(at),
            None => piles.push(Pile { names, cells: vec![at] }),
        }
    }
    let line = |pile: &Pile<'_, '_>| {
        let names: Vec<&str> = pile.names.iter().rev().copied().collect();
        format!("{}: {}", names.join(" over "), places(&pile.cells))
    };
    piles.iter().map(line).collect()
}

/// The same stack of sprites in some cells.
struct Pile<'a, 'b> {
    /// The names from the lowest to the uppermost.
    names: &'b [&'a str],
    cells: Vec<(usize, usize)>,
}
