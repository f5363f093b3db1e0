//! Construction of rooms: floors, interior walls, drawn pieces, borders and openings.

use super::cell::Cell;
use super::embedding::{Embedding, Rectangle};
use super::{Board, Traits};
use crate::kernels::file::kernel::Kernel;
use crate::kernels::file::map::{Link, Map, Room, Size, Style};
use base::Sampler;

/// The openings of each room: cells on its border.
pub(super) type Openings = Vec<Vec<Cell>>;

/// Draws a room's minimum width and height, including spare columns and rows.
pub(super) fn size(room: &Room, kernel: &Kernel, spare: usize, sampler: &mut Sampler) -> (usize, usize) {
    if let Some(rows) = room.piece.as_ref().and_then(|piece| kernel.pieces.get(&piece.name)) {
        return (rows[0].chars().count(), rows.len());
    }
    let items: u32 = room.items.iter().map(|item| item.count.1).sum();
    let (width, height) = match room.size {
        Size::Small => (sampler.between(2, 3), 2),
        Size::Medium => (sampler.between(3, 4), sampler.between(2, 3)),
        Size::Large => (sampler.between(4, 6), sampler.between(3, 4)),
        Size::Wide => (sampler.between(5, 7), sampler.between(2, 3)),
        Size::Tall => (sampler.between(2, 3), sampler.between(4, 5)),
        Size::Corridor => (3, 3),
    };
    let (width, height) =
        if room.size == Size::Corridor { (width, height) } else { (width + spare, height + spare) };
    // Items occupy at most one third of the floor.
    let width = width.max((3 * items as usize).div_ceil(height));
    match room.style {
        Style::Ring => (width.max(5), height.max(5)),
        Style::Bends | Style::Pillars => (width.max(5), height.max(3)),
        Style::Plain | Style::Open => (width, height),
    }
}

/// Builds all rooms and the openings between them; `None` if two linked rooms have no space for their openings or a
/// drawn piece does not fit.
pub(super) fn build(
    map: &Map,
    kernel: &Kernel,
    traits: &Traits,
    embedding: &Embedding,
    board: &mut Board,
    sampler: &mut Sampler,
) -> Option<Openings> {
    for area in &embedding.rooms {
        area.cells().for_each(|cell| board.put(cell, None));
    }
    divide(map, kernel, traits, embedding, board);
    let mut openings: Openings = vec![Vec::new(); map.rooms.len()];
    for link in &map.links {
        let (one, two) = link.between;
        let cells =
            opening_cells(link, embedding.rooms[one].border(embedding.rooms[two]), &openings[one], sampler)?;
        let held = link.stype.as_deref().filter(|stype| traits.present.contains(*stype));
        for &cell in &cells {
            board.put(cell, held);
        }
        openings[one].extend(&cells);
        openings[two].extend(&cells);
    }
    for (number, room) in map.rooms.iter().enumerate() {
        let area = embedding.rooms[number];
        let before = board.clone();
        if let Some(piece) = &room.piece {
            let rows = turned(&kernel.pieces[&piece.name], piece.as_is, area, sampler)?;
            draw_piece(&rows, kernel, traits, area, board);
        } else if room.size == Size::Corridor {
            carve_corridor(area, &openings[number], board);
        } else if let &[opening] = &openings[number][..]
            && is_bare(room, traits)
        {
            leave_nook(area, opening, board);
        } else {
            style(room.style, area, board, sampler);
        }
        if !is_connected(area, &openings[number], room.piece.is_some(), board) {
            if room.piece.is_some() {
                return None;
            }
            *board = before;
        }
    }
    Some(openings)
}

/// Fills the border between any two adjacent rooms with their link's divider or, by default, with the kernel's divider.
fn divide(map: &Map, kernel: &Kernel, traits: &Traits, embedding: &Embedding, board: &mut Board) {
    let is_there = |stype: &&String| traits.present.contains(*stype);
    for (number, one) in embedding.rooms.iter().enumerate() {
        for (other, two) in embedding.rooms.iter().enumerate().skip(number + 1) {
            let link = map.links.iter().find(|link| link.from(number) == Some(other));
            let own = link.and_then(|link| link.border.as_ref());
            if let Some(stype) = own.or(kernel.divider.as_ref()).filter(is_there) {
                one.border(*two).into_iter().for_each(|cell| board.put(cell, Some(stype)));
            }
        }
    }
}

/// Draws the cells of a link's openings, if possible away from corners and from other openings.
fn opening_cells(link: &Link, border: Vec<Cell>, taken: &[Cell], sampler: &mut Sampler) -> Option<Vec<Cell>> {
    let free: Vec<Cell> = border.iter().copied().filter(|cell| !taken.contains(cell)).collect();
    if link.is_wide {
        let width = free.len().min(3);
        let start = (free.len() - width) / 2;
        return (width > 0).then(|| free[start..start + width].to_vec());
    }
    let count = link.openings.max(1) as usize;
    if free.len() < count {
        return None;
    }
    if count == 1 {
        // At least half of the openings are in the middle, where they look deliberate.
        let inner = if free.len() > 2 { &free[1..free.len() - 1] } else { &free[..] };
        let at = if sampler.ratio(1, 2) { inner.len() / 2 } else { sampler.below(inner.len()) };
        return Some(vec![inner[at]]);
    }
    let gap = free.len() as f64 / count as f64;
    Some((0..count).map(|number| free[((number as f64 + 0.5) * gap) as usize]).collect())
}

/// Mirrors a piece at random, unless it must be used as it is; `None` if the piece does not fit the area.
fn turned(rows: &[String], as_is: bool, area: Rectangle, sampler: &mut Sampler) -> Option<Vec<Vec<char>>> {
    let mut rows: Vec<Vec<char>> = rows.iter().map(|row| row.chars().collect()).collect();
    if !as_is {
        if sampler.ratio(1, 2) {
            rows.iter_mut().for_each(|row| row.reverse());
        }
        if sampler.ratio(1, 2) {
            rows.reverse();
        }
    }
    (rows.len() <= area.height() && rows[0].len() <= area.width()).then_some(rows)
}

/// Draws a piece in the middle of an area.
fn draw_piece(rows: &[Vec<char>], kernel: &Kernel, traits: &Traits, area: Rectangle, board: &mut Board) {
    let left = area.left + (area.width() - rows[0].len()) / 2;
    let top = area.top + (area.height() - rows.len()) / 2;
    for (y, row) in rows.iter().enumerate() {
        for (x, symbol) in row.iter().enumerate() {
            let stype = match symbol {
                '.' => None,
                '#' => Some("wall"),
                symbol => {
                    let stype = kernel.legend[symbol].as_str();
                    (stype == "wall" || traits.present.contains(stype)).then_some(stype)
                }
            };
            board.put((left + x, top + y), stype);
        }
    }
}

/// Fills the area with walls, leaving corridors one cell wide between the openings and the middle.
fn carve_corridor(area: Rectangle, openings: &[Cell], board: &mut Board) {
    area.cells().for_each(|cell| board.put(cell, Some("wall")));
    let (x, y) = (area.left + area.width() / 2, area.top + area.height() / 2);
    let clamp = |value: usize, low: usize, high: usize| value.clamp(low, high);
    board.put((x, y), None);
    for &(from_x, from_y) in openings {
        let (from_x, from_y) = (clamp(from_x, area.left, area.right), clamp(from_y, area.top, area.bottom));
        (from_x.min(x)..=from_x.max(x)).for_each(|x| board.put((x, from_y), None));
        (from_y.min(y)..=from_y.max(y)).for_each(|y| board.put((x, y), None));
    }
}

/// Returns `true` if a room has no contents in this game.
fn is_bare(room: &Room, traits: &Traits) -> bool {
    let holds = |stype: &str| stype == "wall" || traits.present.contains(stype);
    !room.fill.as_deref().is_some_and(holds) && !room.items.iter().any(|item| holds(&item.stype))
}

/// Leaves a 3×2 nook behind a dead end's opening, so that the room becomes a cupboard instead of an empty hall.
fn leave_nook(area: Rectangle, (x, y): Cell, board: &mut Board) {
    let (across, deep) = (1, 2);
    let beside = x >= area.left && x <= area.right;
    let (wide, tall) = if beside { (across, deep) } else { (deep, across) };
    let outside = |cell: &Cell| cell.0.abs_diff(x) > wide || cell.1.abs_diff(y) > tall;
    area.cells().filter(outside).for_each(|cell| board.put(cell, Some("wall")));
}

/// Adds the interior walls of a style.
fn style(style: Style, area: Rectangle, board: &mut Board, sampler: &mut Sampler) {
    let (width, height) = (area.width(), area.height());
    let mut wall = |x: usize, y: usize| board.put((area.left + x, area.top + y), Some("wall"));
    match style {
        Style::Open => {}
        // Most rooms have no interior walls. Some rooms have all four corners cut, but no room has only some of them
        // cut.
        Style::Plain => {
            if width >= 5 && height >= 4 && sampler.ratio(1, 4) {
                for (x, y) in [(0, 0), (width - 1, 0), (0, height - 1), (width - 1, height - 1)] {
                    wall(x, y);
                }
            }
        }
        Style::Pillars => {
            let step = if width >= 7 && sampler.ratio(1, 2) { 3 } else { 2 };
            for y in (1..height - 1).step_by(2) {
                for x in (1..width.div_ceil(2)).step_by(step) {
                    // The pillars are symmetric from left to right. Two adjacent pillars would form a stub, so both are
                    // omitted.
                    if width - 1 - x != x + 1 {
                        wall(x, y);
                        wall(width - 1 - x, y);
                    }
                }
            }
        }
        Style::Bends => {
            let across = width >= height;
            let (long, short) = if across { (width, height) } else { (height, width) };
            let mut from_start = sampler.ratio(1, 2);
            for at in (1..long - 1).step_by(2) {
                for beside in 0..short - 1 {
                    let beside = if from_start { beside } else { beside + 1 };
                    let (x, y) = if across { (at, beside) } else { (beside, at) };
                    wall(x, y);
                }
                from_start = !from_start;
            }
        }
        Style::Ring => {
            // A large block has an aisle through its middle, which creates two loops. The corners of the block may be
            // missing.
            let in_aisle = |at: usize, size: usize| size >= 7 && (at == size / 2 || at == (size - 1) / 2);
            let is_worn = width > 5 && height > 5 && sampler.ratio(1, 2);
            for y in 1..height - 1 {
                for x in 1..width - 1 {
                    let at_corner = (x == 1 || x == width - 2) && (y == 1 || y == height - 2);
                    let is_gone =
                        in_aisle(x, width) || width < 7 && in_aisle(y, height) || is_worn && at_corner;
                    if !is_gone {
                        wall(x, y);
                    }
                }
            }
        }
    }
}

/// Returns `true` if all floor in an area is connected to all of its openings. In a drawn piece, only the openings must
/// be connected.
fn is_connected(area: Rectangle, openings: &[Cell], drawn: bool, board: &Board) -> bool {
    let is_open = |cell: Cell| area.contains(cell) && !board.is_wall(cell);
    let inside = |opening: &Cell| board.beside(*opening).find(|&cell| is_open(cell));
    let first = openings.first().and_then(inside).or_else(|| area.cells().find(|&cell| is_open(cell)));
    let Some(start) = first else { return false };
    let steps = board.steps_from(start, is_open);
    let reaches =
        |opening: &Cell| board.beside(*opening).any(|cell| area.contains(cell) && steps.contains_key(&cell));
    let whole = || area.cells().filter(|&cell| is_open(cell)).all(|cell| steps.contains_key(&cell));
    (drawn || whole()) && openings.iter().all(reaches)
}
