//! Describes the avatar's surroundings as text: sprite names and positions, and the first sprite in each
//! direction.

use super::grid::pile;
use super::scene::{Scene, places};
use crate::direction::direction_name;
use crate::legend::{Entry, EntryRole, Legend};
use engine::Observation;
use itertools::Itertools;

/// The maximum number of positions listed per type, nearest first.
const NEAREST: usize = 8;

/// Describes each of the four directions from the avatar, and then lists all sprites except walls, as in
/// `lantern: (3,2) (8,2)`.
///
/// Up to `NEAREST` positions are listed per type, nearest first. Scenery at more than `NEAREST` positions is
/// omitted, because the board shows it. Without an avatar, only the sprites are listed, row by row. Cost:
/// O(cells × types).
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
    let listed = |entry: &&Entry| match entry.role {
        EntryRole::Thing => true,
        EntryRole::Scenery => scene.places(&entry.name).count() <= NEAREST,
        EntryRole::Avatar | EntryRole::Wall | EntryRole::Floor => false,
    };
    let things = legend.entries().iter().filter(listed);
    lines.extend(things.filter_map(|entry| thing(&scene, &entry.name)));
    lines
}

/// Lists the sprites that move straight ahead, by direction, as in `drifter: right (7,1) (2,2), left (10,3)`.
/// Up to `NEAREST` sprites are listed per type, nearest first. Types that always move in a direction stated
/// in the rules are omitted. Cost: O(movers × types).
pub fn directions(observation: &Observation, legend: &Legend) -> Vec<String> {
    let avatar = Scene::of(observation, legend).avatar;
    let line = |entry: &Entry| {
        let of_type = observation.movers.iter().filter(|mover| mover.name == entry.name);
        let mut movers: Vec<_> = of_type
            .filter_map(|mover| {
                let place = (usize::try_from(mover.column).ok()?, usize::try_from(mover.row).ok()?);
                let is_inside = place.0 < observation.columns && place.1 < observation.rows;
                direction_name(mover.facing).filter(|_| is_inside).map(|direction| (direction, place))
            })
            .collect();
        movers.sort_by_key(|&(_, (column, row))| {
            let distance = avatar.map_or(0, |(x, y)| column.abs_diff(x) + row.abs_diff(y));
            (distance, row, column)
        });
        movers.truncate(NEAREST);
        let ways = movers.iter().map(|(direction, _)| *direction).unique();
        let ways = ways.map(|way| {
            let cells: Vec<_> =
                movers.iter().filter(|(own, _)| *own == way).map(|(_, place)| *place).collect();
            format!("{way} {}", places(&cells))
        });
        (!movers.is_empty()).then(|| format!("{}: {}", entry.name, ways.collect::<Vec<_>>().join(", ")))
    };
    legend.entries().iter().filter(|entry| entry.is_turned).filter_map(line).collect()
}

/// Describes the nearest sprite in a direction, such as `wall` or `3 free, then lantern`.
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
        // The sort is stable, so cells at equal distances stay in row order.
        cells.sort_by_key(|cell| cell.0.abs_diff(x) + cell.1.abs_diff(y));
    }
    let more = match cells.len().saturating_sub(NEAREST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    cells.truncate(NEAREST);
    (!cells.is_empty()).then(|| format!("{name}: {}{more}", places(&cells)))
}
