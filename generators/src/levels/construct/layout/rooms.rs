//! Rooms, created by dividing the area inside the border recursively with walls that have doors.

use crate::levels::grid::Grid;
use base::Sampler;

/// A rectangle of open cells, given by a corner (x, y), a width and a height.
#[derive(Clone, Copy)]
struct Room {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
}

/// The minimum side length of a room, in cells.
const SHORTEST: usize = 2;

/// Divides the area inside the border until the rooms are small. `loops` is the probability that a wall gets a second
/// door.
pub(super) fn rooms(grid: Grid, ring: bool, loops: f64, sampler: &mut Sampler, wall: &mut [bool]) {
    let edge = usize::from(ring);
    let whole = Room { x: edge, y: edge, width: grid.columns - 2 * edge, height: grid.rows - 2 * edge };
    let largest = sampler.between(12, 24);
    let mut doors: Vec<usize> = Vec::new();
    let mut todo = vec![whole];
    while let Some(room) = todo.pop() {
        let small = room.width * room.height <= largest;
        if small && sampler.ratio(4, 5) {
            continue;
        }
        todo.extend(divide(grid, room, loops, sampler, &mut doors, wall).into_iter().flatten());
    }
}

/// Places a wall across a room without blocking a door. Returns the room's two halves.
fn divide(
    grid: Grid,
    room: Room,
    loops: f64,
    sampler: &mut Sampler,
    doors: &mut Vec<usize>,
    wall: &mut [bool],
) -> Option<[Room; 2]> {
    let tall = room.height > room.width || (room.height == room.width && sampler.ratio(1, 2));
    // The wall runs along `length`, and the room is `depth` deep across the wall.
    let (length, depth) = if tall { (room.width, room.height) } else { (room.height, room.width) };
    let cell = |along: usize, across: usize| {
        if tall { grid.at(room.x + along, room.y + across) } else { grid.at(room.x + across, room.y + along) }
    };
    let ends_free = |across: usize| {
        let beyond = |inner: usize, outward: bool| {
            let shift = match (tall, outward) {
                (true, false) => (-1, 0),
                (true, true) => (1, 0),
                (false, false) => (0, -1),
                (false, true) => (0, 1),
            };
            grid.shift(inner, shift).is_none_or(|end| !doors.contains(&end))
        };
        beyond(cell(0, across), false) && beyond(cell(length - 1, across), true)
    };
    let places: Vec<usize> =
        (SHORTEST..depth.saturating_sub(SHORTEST)).filter(|&across| ends_free(across)).collect();
    if places.is_empty() || length < SHORTEST {
        return None;
    }
    let across = *sampler.choose(&places);
    for along in 0..length {
        wall[cell(along, across)] = true;
    }
    let door = sampler.below(length);
    let mut opened = vec![door];
    if sampler.unit() < loops {
        opened.push(sampler.below(length));
    }
    for along in opened {
        wall[cell(along, across)] = false;
        doors.push(cell(along, across));
    }
    let near = if tall { Room { height: across, ..room } } else { Room { width: across, ..room } };
    let far = if tall {
        Room { y: room.y + across + 1, height: room.height - across - 1, ..room }
    } else {
        Room { x: room.x + across + 1, width: room.width - across - 1, ..room }
    };
    Some([near, far])
}
