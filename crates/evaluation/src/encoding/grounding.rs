//! Describes the avatar's surroundings as text: sprite names and positions, and the first sprite in each
//! direction.

use super::grid::pile;
use super::scene::{Scene, places};
use crate::direction::direction_name;
use crate::legend::{Entry, EntryRole, Legend};
use engine::{CountdownView, Event, Observation};
use itertools::Itertools;

/// The maximum number of positions listed per type, starting with those nearest to the avatar.
const NEAREST: usize = 8;

/// Describes each of the four directions from the avatar, and then lists all sprites except walls, as in
/// `lantern: (3,2) (8,2)`.
///
/// Up to `NEAREST` positions are listed per type, starting with those nearest to the avatar. Scenery at more
/// than `NEAREST` positions is omitted, because the board shows it. Without an avatar, only the sprites are
/// listed, row by row. Cost: O(cells × types).
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
/// Up to `NEAREST` sprites are listed per type, starting with those nearest to the avatar. Types that always
/// move in a direction stated in the rules are omitted. Cost: O(movers × types).
pub fn directions(observation: &Observation, legend: &Legend) -> Vec<String> {
    let turned = legend.entries().iter().filter(|entry| entry.is_turned);
    turned
        .filter_map(|entry| Some(format!("{}: {}", entry.name, ways(observation, legend, entry)?)))
        .collect()
}

/// Lists the directions of a type's sprites, each with the cells of up to `NEAREST` sprites, starting with
/// those nearest to the avatar. Returns `None` if no sprite has a direction.
fn ways(observation: &Observation, legend: &Legend, entry: &Entry) -> Option<String> {
    let avatar = Scene::of(observation, legend).avatar;
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
        let cells: Vec<_> = movers.iter().filter(|(own, _)| *own == way).map(|(_, place)| *place).collect();
        format!("{way} {}", places(&cells))
    });
    (!movers.is_empty()).then(|| ways.collect::<Vec<_>>().join(", "))
}

/// Lists facts about the near future that a board cannot show: the next steps of sprites that follow paths, as
/// in `wolf: next step, while its target stays: left (3,4)`, and countdowns, soonest first, as in `crack:
/// vanishes in 3 ticks (4,4); in 5 ticks (2,1)` and `wolf: can move in 2 ticks`.
///
/// Up to `NEAREST` countdowns are listed per type and event. Cells are omitted if the countdowns to an event
/// are equal for all sprites of a type. Cost: O(c log c), where c is the number of countdowns.
pub fn soon(observation: &Observation, legend: &Legend) -> Vec<String> {
    let line = |entry: &Entry, event: Event| {
        let of_event = |view: &&CountdownView| view.name == entry.name && view.countdown.event == event;
        let known = observation.countdowns.iter().filter(of_event).map(|view| &view.countdown);
        let mut timed: Vec<_> =
            known.filter_map(|known| Some((known.ticks?, known.left, known.cell))).collect();
        timed.sort_unstable();
        let &(first, ..) = timed.first()?;
        let are_equal = timed.iter().all(|&(ticks, left, _)| ticks == first && left.is_none());
        timed.truncate(if are_equal { 1 } else { NEAREST });
        let parts = timed.iter().map(|&(ticks, left, cell)| {
            let unit = if ticks == 1 { "tick" } else { "ticks" };
            let place = cell.filter(|_| !are_equal).map_or(String::new(), |(x, y)| format!(" ({x},{y})"));
            let left = left.map_or(String::new(), |left| format!(", {left} left"));
            format!("in {ticks} {unit}{place}{left}")
        });
        let verb = match event {
            Event::Moves => "can move",
            Event::Makes => "makes something",
            Event::Turns => "changes",
            Event::Ends => "vanishes",
        };
        Some(format!("{}: {verb} {}", entry.name, parts.collect::<Vec<_>>().join("; ")))
    };
    let events = [Event::Moves, Event::Makes, Event::Turns, Event::Ends];
    let lines = |entry: &Entry| {
        let way = entry.follows_paths.then(|| ways(observation, legend, entry)).flatten();
        let way = way.map(|way| format!("{}: next step, while its target stays: {way}", entry.name));
        way.into_iter().chain(events.into_iter().filter_map(|event| line(entry, event))).collect::<Vec<_>>()
    };
    legend.entries().iter().flat_map(lines).collect()
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
