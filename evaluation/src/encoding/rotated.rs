//! The board, rotated.

use super::grid::symbol;
use super::scene::Scene;
use crate::legend::Legend;
use engine::Observation;

/// Draws the board of [`grid`](super::grid()) rotated clockwise by a quarter turn: its first row is the first column of the
/// board, read from the bottom to the top. Cost: O(cells).
pub fn rotated(observation: &Observation, legend: &Legend) -> String {
    let scene = Scene::of(observation, legend);
    let lines = (0..scene.columns).map(|column| {
        let line = (0..scene.rows).rev().map(|row| symbol(legend, scene.at(column, row)));
        line.collect::<String>()
    });
    lines.collect::<Vec<_>>().join("\n")
}
