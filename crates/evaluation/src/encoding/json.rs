//! Encodes observations as JSON.

use super::scene::Scene;
use crate::direction::direction_name;
use crate::legend::Legend;
use engine::Observation;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct Document<'a> {
    columns: usize,
    rows: usize,
    tick: u32,
    score: f64,
    avatar: Option<Avatar<'a>>,
    holds: BTreeMap<&'a str, i32>,
    /// The columns and rows of the sprites, by type name.
    objects: BTreeMap<&'a str, Vec<(usize, usize)>>,
}

#[derive(Serialize)]
struct Avatar<'a> {
    name: &'a str,
    place: (i32, i32),
    facing: Option<&'static str>,
    health: i32,
}

/// Encodes an observation as one line of JSON. The object contains the board size, the tick, the score, the
/// avatar, its resources, and the positions of all sprites except floors, by name. Cost: O(cells × types).
pub fn json(observation: &Observation, legend: &Legend) -> String {
    let scene = Scene::of(observation, legend);
    let objects = legend.entries().iter().map(|entry| {
        let cells: Vec<(usize, usize)> = scene.places(&entry.name).collect();
        (entry.name.as_str(), cells)
    });
    let document = Document {
        columns: scene.columns,
        rows: scene.rows,
        tick: observation.ticks,
        score: observation.score,
        avatar: observation.avatar.as_ref().map(|avatar| Avatar {
            name: &avatar.name,
            place: (avatar.column, avatar.row),
            facing: direction_name(avatar.facing),
            health: avatar.health,
        }),
        holds: observation.resources.iter().map(|(name, amount)| (name.as_str(), *amount)).collect(),
        objects: objects.filter(|(_, cells)| !cells.is_empty()).collect(),
    };
    serde_json::to_string(&document).expect("plain data")
}
