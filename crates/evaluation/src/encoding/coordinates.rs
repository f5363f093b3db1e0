//! Encodes a board as a list of all sprites, with their names and positions.

use super::scene::{Scene, places};
use crate::legend::Legend;
use engine::Observation;

/// Lists the positions of each type on the board, with one line per type: `lantern: (3,2) (8,2)`. Walls are
/// included, but floors are not. The list contains the same information as the grid, except for the stacking
/// order within a cell. Cost: O(cells × types).
pub fn coordinates(observation: &Observation, legend: &Legend) -> Vec<String> {
    let scene = Scene::of(observation, legend);
    let line = |name: &String| {
        let cells: Vec<(usize, usize)> = scene.places(name).collect();
        (!cells.is_empty()).then(|| format!("{name}: {}", places(&cells)))
    };
    legend.entries().iter().filter_map(|entry| line(&entry.name)).collect()
}
