//! A level under construction: walls, placed characters and reachable cells.

use crate::levels::grid::{FAR, Grid};
use crate::levels::palette::{Palette, Walk};
use engine::analysis::Key;
use engine::{Analysis, SpriteType};

/// A level under construction.
#[derive(Clone, Debug)]
pub(crate) struct Board {
    pub(crate) grid: Grid,
    /// For each cell, `true` if it contains a structural wall.
    pub(crate) wall: Vec<bool>,
    /// The character placed in each cell; `None` for empty cells.
    pub(crate) placed: Vec<Option<u8>>,
    /// For each cell, `true` if it is reserved and must stay free.
    pub(crate) kept: Vec<bool>,
    /// For each cell, the number of the gate in front of it; 0 if there is no gate. Gates are numbered in the order of
    /// placement.
    pub(crate) zone: Vec<u8>,
    /// The cell where the avatar starts.
    pub(crate) start: usize,
    /// `true` if pushable objects do not count as obstacles.
    pub(crate) pushing: bool,
}

impl Board {
    /// Creates an empty board with the given walls.
    pub(crate) fn new(grid: Grid, wall: Vec<bool>) -> Board {
        let (placed, kept, zone) = (vec![None; grid.len()], vec![false; grid.len()], vec![0; grid.len()]);
        Board { grid, wall, placed, kept, zone, start: 0, pushing: false }
    }

    /// Returns `true` if a cell has neither a wall nor a character, and is not reserved.
    pub(crate) fn is_free(&self, cell: usize) -> bool {
        !self.wall[cell] && self.placed[cell].is_none() && !self.kept[cell]
    }

    pub(crate) fn free(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.grid.len()).filter(|&cell| self.is_free(cell))
    }

    /// Returns `true` if the whole border consists of walls.
    pub(crate) fn is_closed(&self) -> bool {
        (0..self.grid.len()).all(|cell| self.wall[cell] || !self.grid.on_border(cell))
    }

    /// Returns the number of cells without a wall.
    pub(crate) fn area(&self) -> usize {
        self.wall.iter().filter(|&&wall| !wall).count()
    }

    /// Returns `true` if the avatar can enter the cell at the start of the level. Breakable obstacles do not count as
    /// obstacles.
    pub(crate) fn is_walkable(&self, palette: &Palette, cell: usize) -> bool {
        let open = |symbol: u8| match palette.walk(symbol) {
            Walk::Open | Walk::Breakable => true,
            Walk::Pushed => self.pushing,
            _ => false,
        };
        !self.wall[cell] && self.placed[cell].is_none_or(open)
    }

    /// Returns the number of steps from the avatar's start to each cell, avoiding locked and deadly cells.
    pub(crate) fn steps(&self, palette: &Palette) -> Vec<u32> {
        self.grid.flood(&[self.start], |cell| self.is_walkable(palette, cell))
    }

    /// Returns `true` if an obstacle in the cell would cut off other cells. Locked cells count as open, because the
    /// avatar will open them.
    pub(crate) fn would_cut(&self, palette: &Palette, cell: usize) -> bool {
        let locked = |symbol: u8| matches!(palette.walk(symbol), Walk::Locked(_));
        let open = |cell: usize| self.is_walkable(palette, cell) || self.placed[cell].is_some_and(locked);
        self.grid.is_cut(cell, open)
    }

    /// Returns the number of walls and off-board cells among the eight surrounding cells.
    pub(crate) fn walls_around(&self, cell: usize) -> usize {
        self.grid.around(cell).iter().filter(|next| next.is_none_or(|next| self.wall[next])).count()
    }

    /// Returns the number of sprites of the given type among the placed characters.
    pub(crate) fn count(&self, analysis: &Analysis, stype: SpriteType) -> usize {
        let placed = self.placed.iter().flatten();
        placed.flat_map(|&symbol| analysis.game().places(symbol)).filter(|&&placed| placed == stype).count()
    }

    /// Returns the level's text.
    pub(crate) fn text(&self, palette: &Palette) -> String {
        let wall = palette.wall.unwrap_or(palette.base);
        let mut text = String::with_capacity(self.grid.len() + self.grid.rows);
        for cell in 0..self.grid.len() {
            let symbol = self.placed[cell].unwrap_or(if self.wall[cell] { wall } else { palette.base });
            text.push(char::from(symbol));
            if self.grid.x(cell) + 1 == self.grid.columns {
                text.push('\n');
            }
        }
        text
    }

    /// Returns, for each cell, `true` if the avatar can reach it by taking every reachable key and opening the locks.
    /// Keys that locks use up are counted. Cost: O(locks × cells).
    pub(crate) fn reach(&self, analysis: &Analysis, palette: &Palette) -> Vec<bool> {
        let mut opened = vec![false; self.grid.len()];
        let mut spent: Vec<i64> = vec![0; analysis.locks().len()];
        loop {
            let open = |cell: usize| opened[cell] || self.is_walkable(palette, cell);
            let steps = self.grid.flood(&[self.start], open);
            let reached = |cell: &usize| steps[*cell] != FAR;
            let next_to = |cell: &usize| self.grid.beside(*cell).any(|next| steps[next] != FAR);
            let found = |giver: SpriteType| -> i64 {
                let seen = (0..self.grid.len()).filter(|cell| reached(cell) || next_to(cell));
                let symbols = seen.filter_map(|cell| self.placed[cell]);
                let places = symbols.flat_map(|symbol| analysis.game().places(symbol));
                places.filter(|&&stype| stype == giver).count() as i64
            };
            let locked = (0..self.grid.len()).find_map(|cell| {
                let Walk::Locked(at) = palette.walk(self.placed[cell]?) else { return None };
                if opened[cell] || !next_to(&cell) {
                    return None;
                }
                let lock = &analysis.locks()[at];
                let held: i64 =
                    lock.givers.iter().map(|&(giver, amount)| found(giver) * i64::from(amount)).sum();
                let (needed, uses) = match lock.key {
                    Key::Resource { amount, spent, .. } => (i64::from(amount), spent),
                    Key::Avatar(_) | Key::Switch(..) => (1, false),
                };
                let same = |other: &usize| analysis.locks()[*other].givers == lock.givers;
                let used: i64 = (0..spent.len()).filter(same).map(|other| spent[other]).sum();
                (held - used >= needed).then_some((cell, at, if uses { needed } else { 0 }))
            });
            match locked {
                Some((cell, at, cost)) => {
                    opened[cell] = true;
                    spent[at] += cost;
                }
                None => return steps.iter().map(|&steps| steps != FAR).collect(),
            }
        }
    }
}
