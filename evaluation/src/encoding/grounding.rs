//! The neighbourhood of the avatar in words: names and places of things, and the first thing in each direction.

use super::grid::pile;
use super::scene::{Scene, places};
use crate::legend::{EntryRole, Legend};
use engine::Observation;

/// The maximum number of things of one type listed by place, the nearest first.
const NEAREST: usize = 8;

/// Describes each of the four directions from the avatar, then the things on the board: `lantern: (3,2) (8,2)`, the nearest
/// first and at most `NEAREST` per type, without walls. Without an avatar, only the things, row by row.
/// Cost: O(cells × types).
pub fn grounding(observation: &Observation, legend: &Legend) -> Vec<String> {
    let scene = Scene::of(observation, legend);
    let mut lines = Vec::new();
    if let Some(avatar) = scene.avatar {
        let ways = [("up", (0, -1)), ("left", (-1, 0)), ("down", (0, 1)), ("right", (1, 0))];
        lines.extend(ways.map(|(name, step)| format!("{name}: {}", way(&scene, avatar, step))));
        let own = scene.at(avatar.0, avatar.1);
        if let [below @ .., _] = own
            && !below.is_empty()
        {
            lines.push(format!("where you are: {}", pile(below)));
        }
    }
    let things = legend.entries().iter().filter(|entry| entry.role == EntryRole::Thing);
    lines.extend(things.filter_map(|entry| thing(&scene, &entry.name)));
    lines
}

/// Returns the first thing in a direction: `wall`, `3 free, then lantern`.
fn way(scene: &Scene<'_>, from: (usize, usize), (dx, dy): (isize, isize)) -> String {
    let (mut column, mut row, mut free) = (from.0, from.1, 0);
    let met = loop {
        let next = (column.checked_add_signed(dx), row.checked_add_signed(dy));
        let (Some(x), Some(y)) = next else { break "edge of the board".to_owned() };
        if x >= scene.columns || y >= scene.rows {
            break "edge of the board".to_owned();
        }
        if !scene.at(x, y).is_empty() {
            break pile(scene.at(x, y));
        }
        (column, row, free) = (x, y, free + 1);
    };
    if free == 0 { met } else { format!("{free} free, then {met}") }
}

fn thing(scene: &Scene<'_>, name: &str) -> Option<String> {
    let mut cells: Vec<(usize, usize)> = scene.places(name).collect();
    if let Some((x, y)) = scene.avatar {
        // The sort is stable: equal distances stay in row order.
        cells.sort_by_key(|cell| cell.0.abs_diff(x) + cell.1.abs_diff(y));
    }
    let more = match cells.len().saturating_sub(NEAREST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    cells.truncate(NEAREST);
    (!cells.is_empty()).then(|| format!("{name}: {}{more}", places(&cells)))
}
