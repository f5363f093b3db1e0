//! A board under construction or edit, with one character per cell.

use super::canvas::{emptiness, narrow};
use super::idiom::Idiom;
use super::kit::{Kit, Piece};
use crate::levels::grid::{FAR, Grid, WAYS};
use crate::levels::palette::holds_avatar;
use engine::Level;
use engine::analysis::Motion;

/// The number of consecutive free cells that a sprite moving straight ahead needs in its direction.
const LANE: usize = 5;
/// The minimum distance in steps between the avatar and any hunter or spawner.
const AWAY: usize = 6;
/// The maximum fraction of a board's floor that may consist of narrow passages.
const MAX_NARROW: f64 = 0.36;
/// The maximum fraction of the area within the border that may be wall. Boards with many walls all look alike.
const MAX_WALLS: f64 = 0.35;

/// A board under construction or edit.
#[derive(Clone, Debug)]
pub(crate) struct Draft<'k> {
    pub(crate) kit: &'k Kit<'k>,
    pub(crate) grid: Grid,
    /// The characters in row-major order.
    pub(crate) cells: Vec<u8>,
}

impl<'k> Draft<'k> {
    pub(crate) fn of(kit: &'k Kit<'k>, level: &Level) -> Draft<'k> {
        let grid = Grid { columns: level.columns(), rows: level.rows() };
        let base = kit.palette.base;
        let plain = |&symbol: &u8| match kit.analysis.game().places(symbol).is_empty() {
            true => base,
            false => symbol,
        };
        Draft { kit, grid, cells: level.cells().iter().map(plain).collect() }
    }

    /// Returns the level, if the engine accepts it.
    pub(crate) fn level(&self) -> Option<Level> {
        let row = |row: &[u8]| row.iter().map(|&symbol| char::from(symbol)).chain(['\n']).collect::<String>();
        let text: String = self.cells.chunks(self.grid.columns).map(row).collect();
        self.kit.analysis.game().level(&text).ok()
    }

    pub(crate) fn is_free(&self, cell: usize) -> bool {
        self.cells[cell] == self.kit.palette.base
    }

    pub(crate) fn is_wall(&self, cell: usize) -> bool {
        self.kit.palette.wall == Some(self.cells[cell])
    }

    /// Returns `true` if a cell contains something that the avatar can never pass or remove.
    pub(crate) fn is_solid(&self, cell: usize) -> bool {
        self.kit.is_solid(self.cells[cell])
    }

    /// Returns `true` if the avatar can stand in the cell when the level starts.
    pub(crate) fn is_open(&self, cell: usize) -> bool {
        !self.is_solid(cell) && self.kit.is_open(self.cells[cell])
    }

    pub(crate) fn hero(&self) -> Option<usize> {
        (0..self.grid.len()).find(|&cell| holds_avatar(self.kit.analysis, self.cells[cell]))
    }

    pub(crate) fn count(&self, symbol: u8) -> usize {
        self.cells.iter().filter(|&&other| other == symbol).count()
    }

    /// Returns the cells with pieces, in row-major order.
    pub(crate) fn pieces(&self) -> Vec<usize> {
        (0..self.grid.len()).filter(|&cell| self.kit.piece(self.cells[cell]).is_some()).collect()
    }

    pub(crate) fn clear(&mut self, cell: usize) {
        self.cells[cell] = self.kit.palette.base;
    }

    /// Returns, for each side of a cell in the order of [`WAYS`], `true` if the side borders on a wall or the board
    /// edge.
    pub(crate) fn walls_beside(&self, cell: usize) -> [bool; 4] {
        WAYS.map(|way| self.grid.shift(cell, way).is_none_or(|next| self.is_solid(next)))
    }

    /// Returns `true` if a cell has solid cells on exactly two opposite sides.
    pub(crate) fn is_gap(&self, cell: usize) -> bool {
        matches!(self.walls_beside(cell), [false, true, false, true] | [true, false, true, false])
    }

    /// Returns the number of consecutive open cells in a cell's column or row, counting the cell itself.
    fn lane(&self, cell: usize, is_vertical: bool) -> usize {
        let ways = if is_vertical { [(0, -1), (0, 1)] } else { [(-1, 0), (1, 0)] };
        let along = |way: (i32, i32)| {
            let (mut at, mut free) = (cell, 0);
            while let Some(next) = self.grid.shift(at, way).filter(|&next| self.is_open(next)) {
                (at, free) = (next, free + 1);
            }
            free
        };
        1 + ways.into_iter().map(along).sum::<usize>()
    }

    /// Returns the weight of a cell for placing a piece; 0 if the piece must not be in the cell. The cell's current
    /// content is ignored.
    pub(crate) fn fit(&self, piece: &Piece, cell: usize) -> u32 {
        let [up, left, down, right] = self.walls_beside(cell);
        let walls = [up, left, down, right].into_iter().filter(|&wall| wall).count();
        let away = self.hero().map_or(usize::MAX, |hero| self.grid.manhattan(hero, cell));
        if piece.harmful && away < 3 || away < 2 {
            return 0;
        }
        match piece.idiom {
            Idiom::Heavy => match walls {
                0 => 10,
                1 => 2,
                _ => 0,
            },
            Idiom::Spot => match walls {
                4 => 0,
                3 => 3,
                _ => 6,
            },
            Idiom::Barrier | Idiom::Road if self.is_gap(cell) => 24,
            Idiom::Barrier | Idiom::Road => self.fit_of_barrier(piece, cell),
            Idiom::Crossing | Idiom::Ground | Idiom::Hazard | Idiom::Obstacle => 4,
            Idiom::Thing => 4 + walls as u32,
            Idiom::Patrol => self.fit_of_patrol(piece, cell),
            Idiom::Hunter => match away {
                0..AWAY => 0,
                _ => 4,
            },
            Idiom::Stray => u32::from(away >= 3) * (5 - walls as u32),
            Idiom::Source => match away {
                0..AWAY => 0,
                _ => 1 + 3 * walls as u32,
            },
            Idiom::Exit => match away {
                0..AWAY => 1,
                _ => 3 + 3 * walls as u32,
            },
        }
    }

    /// Returns the weight of a cell that is not a gap, for a piece that belongs in gaps. Such a piece may extend a gap
    /// or a wall.
    fn fit_of_barrier(&self, piece: &Piece, cell: usize) -> u32 {
        let own = |next: usize| self.cells[next] == piece.symbol;
        let barred = |next: usize| self.is_solid(next) && !self.grid.on_border(next);
        match () {
            () if self.grid.beside(cell).any(own) => 2,
            () if piece.idiom == Idiom::Barrier && self.grid.beside(cell).any(barred) => 1,
            () => 0,
        }
    }

    /// Returns the weight of a cell for a piece that moves straight ahead and therefore needs a long lane.
    fn fit_of_patrol(&self, piece: &Piece, cell: usize) -> u32 {
        let Motion::Straight(direction) = self.kit.analysis.facts(piece.stype).motion else { return 1 };
        let lane = match (direction.x != 0.0, direction.y != 0.0) {
            (true, false) => self.lane(cell, false),
            (false, true) => self.lane(cell, true),
            _ => self.lane(cell, false).max(self.lane(cell, true)),
        };
        if lane < LANE { 0 } else { lane as u32 }
    }

    /// Returns the number of steps from the avatar to every cell, through cells that are open at the start.
    pub(crate) fn near(&self) -> Vec<u32> {
        let from: Vec<usize> = self.hero().into_iter().collect();
        self.grid.flood(&from, |cell| self.is_open(cell))
    }

    /// Returns `true` if the board is sound. A sound board has one avatar with nothing harmful nearby. All cells that
    /// are not solid are connected, and only a small part of the board is narrow or walled. The number of each piece is
    /// in its range, and no wall block stands alone.
    pub(crate) fn is_sound(&self) -> bool {
        let Some(hero) = self.hero() else { return false };
        let reach = self.grid.flood(&[hero], |cell| !self.is_solid(cell));
        let cut_off = |cell: usize| reach[cell] == FAR && !self.is_solid(cell);
        let crowds = |cell: usize| {
            let piece = self.kit.piece(self.cells[cell]);
            piece.is_some_and(|piece| piece.harmful && self.grid.manhattan(hero, cell) < 2)
        };
        let counts_fit = self.kit.pieces.iter().all(|piece| {
            let count = self.count(piece.symbol);
            count == 0 && !piece.asked
                || (piece.counts.0..=piece.counts.1.max(self.most(piece))).contains(&count)
        });
        counts_fit
            && !(0..self.grid.len()).any(|cell| cut_off(cell) || crowds(cell))
            && self.lone_blocks() == 0
            && self.walls() <= MAX_WALLS
            && narrow(self.grid, |cell| !self.is_solid(cell)) <= MAX_NARROW
    }

    /// Returns the fraction of the area within the border that is wall.
    fn walls(&self) -> f64 {
        let (right, bottom) = (self.grid.columns - 1, self.grid.rows - 1);
        let is_within = |cell: &usize| {
            (1..right).contains(&self.grid.x(*cell)) && (1..bottom).contains(&self.grid.y(*cell))
        };
        let walls = (0..self.grid.len()).filter(is_within).filter(|&cell| self.is_wall(cell)).count();
        walls as f64 / ((right - 1) * (bottom - 1)).max(1) as f64
    }

    /// Returns the maximum number of copies of a piece on a board. Barriers that form lines may exceed the usual
    /// maximum.
    pub(crate) fn most(&self, piece: &Piece) -> usize {
        match piece.idiom {
            Idiom::Barrier | Idiom::Crossing | Idiom::Ground | Idiom::Road if !piece.asked => {
                piece.counts.1.max(self.grid.columns.max(self.grid.rows) + 4)
            }
            _ => piece.counts.1,
        }
    }

    /// Returns the area of the largest empty rectangle, as a fraction of the area within the border.
    pub(crate) fn emptiness(&self) -> f64 {
        emptiness(self.grid, |cell| self.is_free(cell))
    }

    /// Returns the number of fragments. A fragment is a group of one or two wall blocks that touches no other block, or
    /// a lone piece of a type that normally stands in rows.
    pub(crate) fn fragments(&self) -> usize {
        let walls = self.grid.regions(|cell| self.is_wall(cell));
        let is_lone = |&cell: &usize| {
            let rows =
                |piece: &Piece| matches!(piece.idiom, Idiom::Ground | Idiom::Crossing | Idiom::Obstacle);
            self.kit.piece(self.cells[cell]).is_some_and(rows)
                && !self.grid.beside(cell).any(|next| self.cells[next] == self.cells[cell])
        };
        walls.iter().filter(|group| group.len() <= 2).count() + (0..self.grid.len()).filter(is_lone).count()
    }

    /// Returns `true` if a board has at most `fragments` fragments, and no empty rectangle larger than `empty`.
    pub(crate) fn is_composed(&self, fragments: usize, empty: f64) -> bool {
        self.fragments() <= fragments && self.emptiness() <= empty
    }

    /// Returns the number of wall blocks that have no solid neighbours.
    pub(crate) fn lone_blocks(&self) -> usize {
        let is_lone = |&cell: &usize| {
            let mut around = self.grid.around(cell).into_iter();
            self.is_wall(cell) && around.all(|next| next.is_some_and(|next| !self.is_solid(next)))
        };
        (0..self.grid.len()).filter(is_lone).count()
    }
}
