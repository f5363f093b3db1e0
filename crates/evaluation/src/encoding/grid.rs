//! Encodes the board as a grid with one character per cell.

use super::scene::{Scene, places};
use crate::legend::Legend;
use engine::Observation;
use itertools::Itertools;
use render::EMPTY;

/// Draws the board with one line per row. Each cell shows its topmost sprite, ignoring floors and placing the
/// avatar above all other sprites. A sprite between cells is drawn in all cells that it overlaps. The avatar
/// is drawn in only one cell. Cost: O(cells).
pub fn grid(observation: &Observation, legend: &Legend) -> String {
    let scene = Scene::of(observation, legend);
    let symbol = |row, column| symbol(legend, scene.at(column, row));
    (0..scene.rows).map(|row| (0..scene.columns).map(|column| symbol(row, column)).join("")).join("\n")
}

/// Draws the board as [`grid`] does, rotated clockwise by a quarter turn. The first row of the result is the
/// board's first column, read from bottom to top. Cost: O(cells).
pub fn rotated(observation: &Observation, legend: &Legend) -> String {
    let scene = Scene::of(observation, legend);
    let symbol = |row, column| symbol(legend, scene.at(column, row));
    let rows = || (0..scene.rows).rev();
    (0..scene.columns).map(|column| rows().map(|row| symbol(row, column)).join("")).join("\n")
}

/// Returns the character for a cell that contains the given types.
fn symbol(legend: &Legend, names: &[&str]) -> char {
    names.last().and_then(|name| legend.entry(name)).map_or(EMPTY, |entry| entry.symbol)
}

/// Lists the stacks of sprites that the grid cannot show, such as `frost over snow: (3,4) (5,4)`. Each
/// distinct combination of sprites has one line, in board order. Cost: O(cells × stacks).
pub fn stacks(observation: &Observation, legend: &Legend) -> Vec<String> {
    let scene = Scene::of(observation, legend);
    // Each pile consists of its names, from bottom to top, and its cells.
    let mut piles: Vec<(&[&str], Vec<_>)> = Vec::new();
    for (cell, names) in scene.cells.iter().enumerate().filter(|(_, names)| names.len() > 1) {
        let at = (cell % scene.columns, cell / scene.columns);
        match piles.iter_mut().find(|(known, _)| *known == names.as_slice()) {
            Some((_, cells)) => cells.push(at),
            None => piles.push((names, vec![at])),
        }
    }
    piles.iter().map(|(names, cells)| format!("{}: {}", pile(names), places(cells))).collect()
}

/// Formats a stack of sprites from top to bottom.
pub(super) fn pile(names: &[&str]) -> String {
    names.iter().rev().join(" over ")
}
