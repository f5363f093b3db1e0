//! All things by name and place.

use super::scene::{Scene, places};
use crate::legend::Legend;
use engine::Observation;

/// A line for each type that is on the board, walls included and floors not: `lantern: (3,2) (8,2)`. It tells what the grid
/// tells, without the order of what is in one cell. Cost: O(cells × types).
pub fn coordinates(observation: &Observation, legend: &Legend) -> Vec<String> {
    let scene = Scene::of(observation, legend);
    let line = |name: &String| {
        let cells: Vec<(usize, usize)> = scene.places(name).collect();
        (!cells.is_empty()).then(|| format!("{name}: {}", places(&cells)))
    };
    legend.entries().iter().filter_map(|entry| line(&entry.name)).collect()
}
