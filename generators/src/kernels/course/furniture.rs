//! Placement of sprites in rooms.

use super::cell::Cell;
use super::embedding::{Embedding, Rectangle};
use super::room::Openings;
use super::{Board, Traits};
use crate::kernels::file::map::{Item, Map, Place};
use base::Sampler;
use std::collections::{BTreeMap, BTreeSet};

/// Places the sprites in all rooms; `None` if there is not enough space.
pub(super) fn furnish(
    map: &Map,
    traits: &Traits,
    embedding: &Embedding,
    openings: &Openings,
    board: &mut Board,
    sampler: &mut Sampler,
) -> Option<()> {
    let hero_room = map.rooms.iter().position(|room| room.items.iter().any(|item| item.stype == "hero"));
    let entries = entries(map, embedding, openings, hero_room.unwrap_or(0), board);
    for (number, room) in map.rooms.iter().enumerate() {
        let mut furnisher = Furnisher {
            area: embedding.rooms[number],
            openings: &openings[number],
            entry: entries[number],
            traits,
            placed: Vec::new(),
        };
        // Sprites that move along lanes come first, followed by the other items that need a specific position.
        let mut items: Vec<&Item> =
            room.items.iter().filter(|item| furnisher.is_there(&item.stype)).collect();
        items.sort_by_key(|item| match item.place {
            Place::Lane => 0,
            Place::Centre => 1,
            Place::Far | Place::Corner => 2,
            Place::Row => 3,
            Place::Near | Place::Wall => 4,
            Place::Fair => 5,
        });
        for item in items {
            let count = sampler.between(item.count.0 as usize, item.count.1 as usize);
            furnisher.place(item, count, board, sampler)?;
        }
        if let Some(fill) = room.fill.as_ref().filter(|fill| furnisher.is_there(fill)) {
            let free: Vec<Cell> = furnisher.area.cells().filter(|&cell| board.is_floor(cell)).collect();
            free.into_iter().for_each(|cell| board.put(cell, Some(fill)));
        }
    }
    Some(())
}

/// Returns, for each room, the opening through which the avatar first enters the room; `None` for the room in which the
/// avatar starts.
fn entries(
    map: &Map,
    embedding: &Embedding,
    openings: &Openings,
    start: usize,
    board: &Board,
) -> Vec<Option<Cell>> {
    let mut entries = vec![None; map.rooms.len()];
    let mut seen = BTreeSet::from([start]);
    let mut front = vec![start];
    while let Some(room) = front.pop() {
        for other in map.links.iter().filter_map(|link| link.from(room)) {
            if seen.insert(other) {
                let shared = openings[other].iter().find(|cell| openings[room].contains(cell));
                entries[other] = shared.copied();
                front.insert(0, other);
            }
        }
    }
    assert!(embedding.columns == board.columns && embedding.rows == board.rows);
    entries
}

struct Furnisher<'a> {
    area: Rectangle,
    openings: &'a [Cell],
    entry: Option<Cell>,
    traits: &'a Traits,
    placed: Vec<Cell>,
}

impl Furnisher<'_> {
    fn is_there(&self, stype: &str) -> bool {
        stype == "wall" || self.traits.present.contains(stype)
    }

    /// Places `count` sprites of a type.
    fn place(&mut self, item: &Item, count: usize, board: &mut Board, sampler: &mut Sampler) -> Option<()> {
        if item.place == Place::Row && count > 1 {
            let row = self.row(count, board, sampler)?;
            row.into_iter().for_each(|cell| self.put(cell, &item.stype, board));
            return Some(());
        }
        for _ in 0..count {
            let cell = self.cell(item, board, sampler)?;
            self.put(cell, &item.stype, board);
        }
        Some(())
    }

    fn put(&mut self, cell: Cell, stype: &str, board: &mut Board) {
        board.put(cell, Some(stype));
        self.placed.push(cell);
    }

    /// Draws one of the cells that best match a sprite's preferred position.
    fn cell(&self, item: &Item, board: &Board, sampler: &mut Sampler) -> Option<Cell> {
        let from = self.entry.or(self.openings.first().copied());
        let steps = match from {
            Some(from) => board.steps_from(from, |cell| self.area.contains(cell) && !board.is_wall(cell)),
            None => BTreeMap::new(),
        };
        let apart = |one: Cell, other: Cell| one.0.abs_diff(other.0) + one.1.abs_diff(other.1);
        let solid = self.traits.solid.contains(&item.stype);
        let careful = solid || self.traits.deadly.contains(&item.stype);
        let at_opening = |cell: Cell| self.openings.iter().any(|&opening| apart(cell, opening) == 1);
        let free: Vec<Cell> = self
            .area
            .cells()
            .filter(|&cell| board.is_floor(cell) && !(careful && at_opening(cell)))
            .filter(|&cell| !solid || self.stays_connected(cell, board))
            .collect();
        let spread =
            |cell: Cell| self.placed.iter().map(|&other| apart(cell, other)).min().unwrap_or(3).min(3);
        let walls = |cell: Cell| board.beside(cell).filter(|&beside| board.is_wall(beside)).count();
        let (middle_x, middle_y) = (self.area.left + self.area.right, self.area.top + self.area.bottom);
        let off_centre = |(x, y): Cell| (2 * x).abs_diff(middle_x) + (2 * y).abs_diff(middle_y);
        let score = |cell: Cell| -> i64 {
            let distance = steps.get(&cell).copied().unwrap_or(0) as i64;
            let spread = spread(cell) as i64;
            match item.place {
                Place::Far => 4 * distance + spread + walls(cell) as i64,
                Place::Near => -4 * distance + spread,
                Place::Centre => -8 * off_centre(cell) as i64,
                Place::Corner => 8 * walls(cell) as i64 + spread + distance.min(2),
                Place::Wall => 8 * walls(cell).min(1) as i64 + 2 * spread,
                Place::Lane => 8 * self.lane(cell, &item.stype, board) as i64 - off_centre(cell) as i64,
                Place::Row | Place::Fair => 3 * spread - 6 * i64::from(at_opening(cell)),
            }
        };
        let best = free.iter().map(|&cell| score(cell)).max()?;
        // For variety, accept cells that are nearly as good as the best.
        let tolerance = match item.place {
            Place::Far | Place::Near | Place::Wall => 3,
            Place::Fair | Place::Row => 4,
            Place::Centre | Place::Corner | Place::Lane => 0,
        };
        let good: Vec<Cell> = free.into_iter().filter(|&cell| score(cell) >= best - tolerance).collect();
        Some(*sampler.choose(&good))
    }

    /// Returns `true` if the floor and the openings remain connected when a cell is blocked.
    fn stays_connected(&self, blocked: Cell, board: &Board) -> bool {
        let is_open = |cell: Cell| {
            cell != blocked
                && self.area.contains(cell)
                && board.at(cell).is_none_or(|stype| stype != "wall" && !self.traits.solid.contains(stype))
        };
        let beside: Vec<Cell> = board.beside(blocked).filter(|&cell| is_open(cell)).collect();
        let Some(&start) = beside.first() else { return false };
        let steps = board.steps_from(start, is_open);
        beside.iter().all(|cell| steps.contains_key(cell))
    }

    /// Returns the length of the free line through a cell, along a type's direction of movement.
    fn lane(&self, (x, y): Cell, stype: &str, board: &Board) -> usize {
        let is_free = |cell: Cell| self.area.contains(cell) && board.is_floor(cell);
        let upright = || {
            let down = (y + 1..).take_while(|&y| is_free((x, y))).count();
            let up = (0..y).rev().take_while(|&y| is_free((x, y))).count();
            1 + down + up
        };
        let level = || {
            let right = (x + 1..).take_while(|&x| is_free((x, y))).count();
            let left = (0..x).rev().take_while(|&x| is_free((x, y))).count();
            1 + right + left
        };
        match self.traits.lanes.get(stype) {
            Some(true) => upright(),
            Some(false) => level(),
            None => upright().max(level()),
        }
    }

    /// Draws adjacent free cells that form a line.
    fn row(&self, count: usize, board: &Board, sampler: &mut Sampler) -> Option<Vec<Cell>> {
        let is_free = |cell: &Cell| self.area.contains(*cell) && board.is_floor(*cell);
        let lines = self.area.cells().flat_map(|(x, y)| {
            let level: Vec<Cell> = (x..x + count).map(|x| (x, y)).collect();
            let upright: Vec<Cell> = (y..y + count).map(|y| (x, y)).collect();
            [level, upright]
        });
        let lines: Vec<Vec<Cell>> = lines.filter(|line| line.iter().all(is_free)).collect();
        (!lines.is_empty()).then(|| sampler.choose(&lines).clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solid_thing_cuts_nothing_off_in_a_room_that_is_cut_in_two() {
        let mut board = Board::walls(9, 4);
        for (x, y) in (1..=7).flat_map(|x| [(x, 1), (x, 2)]) {
            board.put((x, y), (x == 4).then_some("gate"));
        }
        let solid = BTreeSet::from(["gate".to_owned()]);
        let traits = Traits { solid, ..Traits::default() };
        let area = Rectangle { left: 1, top: 1, right: 7, bottom: 2 };
        let furnisher = Furnisher { area, openings: &[], entry: None, traits: &traits, placed: Vec::new() };
        assert!(furnisher.stays_connected((1, 1), &board));
        board.put((2, 2), Some("gate"));
        assert!(!furnisher.stays_connected((2, 1), &board));
    }
}
