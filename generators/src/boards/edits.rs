//! Small changes to a board that make sense in its game.

use super::draft::Draft;
use super::idiom::Idiom;
use crate::levels::grid::WAYS;
use base::Sampler;

/// A board edit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edit {
    /// Moves a piece to a cell that fits it.
    MovePiece,
    /// Swaps two pieces of different kinds.
    Swap,
    /// Moves adjacent pieces of the same kind together.
    MoveGroup,
    /// Moves a straight segment of wall sideways.
    ShiftWall,
    /// Extends a wall by one or two cells.
    Extend,
    /// Shortens a wall by one or two cells at one end.
    Shorten,
    /// Moves a gap, with its contents, along its wall.
    MoveGap,
    /// Adds one more piece of some kind.
    Add,
    /// Removes one piece of some kind.
    Remove,
    /// Moves the avatar's start.
    MoveHero,
}

/// All edits, with their weights. Pieces are edited more often than walls, so that the plan remains recognizable.
const EDITS: [(Edit, u32); 10] = [
    (Edit::MovePiece, 9),
    (Edit::Swap, 3),
    (Edit::MoveGroup, 4),
    (Edit::ShiftWall, 1),
    (Edit::Extend, 1),
    (Edit::Shorten, 1),
    (Edit::MoveGap, 2),
    (Edit::Add, 4),
    (Edit::Remove, 3),
    (Edit::MoveHero, 3),
];

impl Edit {
    pub(crate) fn draw(sampler: &mut Sampler) -> Edit {
        let weights = EDITS.map(|(_, weight)| weight);
        EDITS[sampler.weighted(&weights).expect("the weights are positive")].0
    }
}

impl Draft<'_> {
    /// Applies an edit. Returns `None` if the edit does not apply to anything on the board. The result may be unsound.
    pub(crate) fn edit(&mut self, edit: Edit, sampler: &mut Sampler) -> Option<()> {
        match edit {
            Edit::MovePiece => self.move_piece(sampler),
            Edit::Swap => self.swap(sampler),
            Edit::MoveGroup => self.move_group(sampler),
            Edit::ShiftWall => self.shift_wall(sampler),
            Edit::Extend => self.extend(sampler),
            Edit::Shorten => self.shorten(sampler),
            Edit::MoveGap => self.move_gap(sampler),
            Edit::Add => self.add(sampler),
            Edit::Remove => self.remove(sampler),
            Edit::MoveHero => self.move_hero(sampler),
        }
    }

    fn move_piece(&mut self, sampler: &mut Sampler) -> Option<()> {
        let from = pick(&self.pieces(), sampler)?;
        let piece = self.kit.piece(self.cells[from])?;
        self.clear(from);
        let to = self.draw_cell(piece.symbol, Some(from), sampler)?;
        self.cells[to] = piece.symbol;
        Some(())
    }

    /// Draws a free cell that fits a piece, other than its current cell. Pieces that stand in rows are often placed
    /// next to pieces of the same kind. Half of the draws prefer cells near the current cell.
    fn draw_cell(&self, symbol: u8, from: Option<usize>, sampler: &mut Sampler) -> Option<usize> {
        let piece = self.kit.piece(symbol)?;
        let near = from.filter(|_| sampler.ratio(1, 2));
        let joins = matches!(piece.idiom, Idiom::Ground | Idiom::Crossing | Idiom::Hazard | Idiom::Thing)
            && sampler.ratio(2, 3);
        let weight = |cell: usize| {
            if !self.is_free(cell) || Some(cell) == from {
                return 0;
            }
            let own = self.grid.beside(cell).any(|next| self.cells[next] == symbol);
            let close = near.is_none_or(|from| self.grid.manhattan(from, cell) <= 3);
            let join = if joins && own { 6 } else { 1 };
            self.fit(piece, cell) * join * if close { 12 } else { 1 }
        };
        let weights: Vec<u32> = (0..self.grid.len()).map(weight).collect();
        sampler.weighted(&weights)
    }

    fn swap(&mut self, sampler: &mut Sampler) -> Option<()> {
        let pieces = self.pieces();
        let one = pick(&pieces, sampler)?;
        let others: Vec<usize> =
            pieces.into_iter().filter(|&cell| self.cells[cell] != self.cells[one]).collect();
        let two = pick(&others, sampler)?;
        self.cells.swap(one, two);
        Some(())
    }

    fn move_group(&mut self, sampler: &mut Sampler) -> Option<()> {
        let start = pick(&self.pieces(), sampler)?;
        let symbol = self.cells[start];
        let regions = self.grid.regions(|cell| self.cells[cell] == symbol);
        let group = regions.into_iter().find(|region| region.contains(&start))?;
        let way = *sampler.choose(&WAYS);
        let far = sampler.between(1, 3) as i32;
        let shift = (way.0 * far, way.1 * far);
        let to: Vec<usize> = group.iter().filter_map(|&cell| self.grid.shift(cell, shift)).collect();
        group.iter().for_each(|&cell| self.clear(cell));
        if to.len() < group.len() || !to.iter().all(|&cell| self.is_free(cell)) {
            return None;
        }
        to.into_iter().for_each(|cell| self.cells[cell] = symbol);
        Some(())
    }

    /// Returns the walls that are not on the border.
    fn inner_walls(&self) -> Vec<usize> {
        (0..self.grid.len()).filter(|&cell| self.is_wall(cell) && !self.grid.on_border(cell)).collect()
    }

    /// Returns the straight segment of inner walls through a cell, extended by up to three cells on both sides.
    fn segment(&self, cell: usize, is_vertical: bool) -> Vec<usize> {
        let ways = if is_vertical { [(0, -1), (0, 1)] } else { [(-1, 0), (1, 0)] };
        let mut segment = vec![cell];
        for way in ways {
            let mut at = cell;
            for _ in 0..3 {
                let next = self.grid.shift(at, way);
                let Some(next) = next.filter(|&next| self.is_wall(next) && !self.grid.on_border(next)) else {
                    break;
                };
                segment.push(next);
                at = next;
            }
        }
        segment
    }

    fn shift_wall(&mut self, sampler: &mut Sampler) -> Option<()> {
        let wall = self.kit.palette.wall?;
        let cell = pick(&self.inner_walls(), sampler)?;
        let is_vertical = sampler.ratio(1, 2);
        let segment = self.segment(cell, is_vertical);
        let side = if sampler.ratio(1, 2) { 1 } else { -1 };
        let way = if is_vertical { (side, 0) } else { (0, side) };
        segment.iter().for_each(|&cell| self.clear(cell));
        for &cell in &segment {
            let to = self.grid.shift(cell, way)?;
            if !self.is_free(to) {
                continue;
            }
            self.cells[to] = wall;
        }
        Some(())
    }

    fn extend(&mut self, sampler: &mut Sampler) -> Option<()> {
        let wall = self.kit.palette.wall?;
        let walls: Vec<usize> = (0..self.grid.len()).filter(|&cell| self.is_wall(cell)).collect();
        let mut at = pick(&walls, sampler)?;
        let way = *sampler.choose(&WAYS);
        for _ in 0..sampler.between(1, 2) {
            at = self.grid.shift(at, way).filter(|&next| self.is_free(next) && !self.grid.on_border(next))?;
            self.cells[at] = wall;
        }
        Some(())
    }

    fn shorten(&mut self, sampler: &mut Sampler) -> Option<()> {
        let ends: Vec<usize> = self
            .inner_walls()
            .into_iter()
            .filter(|&cell| self.walls_beside(cell).into_iter().filter(|&wall| wall).count() <= 2)
            .collect();
        let cell = pick(&ends, sampler)?;
        self.clear(cell);
        let walls: Vec<usize> = self.grid.beside(cell).filter(|&next| self.is_wall(next)).collect();
        let next = walls.first().filter(|_| sampler.ratio(1, 3));
        if let Some(&next) = next.filter(|&&next| !self.grid.on_border(next)) {
            self.clear(next);
        }
        Some(())
    }

    fn move_gap(&mut self, sampler: &mut Sampler) -> Option<()> {
        let wall = self.kit.palette.wall?;
        let gaps: Vec<usize> =
            (0..self.grid.len()).filter(|&cell| !self.is_solid(cell) && self.is_gap(cell)).collect();
        let gap = pick(&gaps, sampler)?;
        let is_vertical = self.walls_beside(gap)[0];
        let far = sampler.between(1, 3) as i32 * if sampler.ratio(1, 2) { 1 } else { -1 };
        let to = self.grid.shift(gap, if is_vertical { (0, far) } else { (far, 0) })?;
        if !self.is_wall(to) || self.grid.on_border(to) {
            return None;
        }
        self.cells[to] = self.cells[gap];
        self.cells[gap] = wall;
        Some(())
    }

    fn add(&mut self, sampler: &mut Sampler) -> Option<()> {
        let room = |&at: &usize| {
            let piece = &self.kit.pieces[at];
            self.count(piece.symbol) < self.most(piece)
        };
        let kinds: Vec<usize> = (0..self.kit.pieces.len()).filter(|at| room(at)).collect();
        let symbol = self.kit.pieces[pick(&kinds, sampler)?].symbol;
        let cell = self.draw_cell(symbol, None, sampler)?;
        self.cells[cell] = symbol;
        Some(())
    }

    fn remove(&mut self, sampler: &mut Sampler) -> Option<()> {
        let spare = |&cell: &usize| {
            let piece = self.kit.piece(self.cells[cell]);
            piece.is_some_and(|piece| self.count(piece.symbol) > piece.counts.0.max(1))
        };
        let spare: Vec<usize> = self.pieces().into_iter().filter(spare).collect();
        let cell = pick(&spare, sampler)?;
        self.clear(cell);
        Some(())
    }

    fn move_hero(&mut self, sampler: &mut Sampler) -> Option<()> {
        let from = self.hero()?;
        let symbol = self.cells[from];
        self.clear(from);
        let free: Vec<usize> = (0..self.grid.len()).filter(|&cell| self.is_free(cell)).collect();
        let close: Vec<usize> =
            free.iter().copied().filter(|&cell| self.grid.manhattan(from, cell) <= 3).collect();
        let to = if sampler.ratio(1, 2) { pick(&close, sampler)? } else { pick(&free, sampler)? };
        self.cells[to] = symbol;
        (to != from).then_some(())
    }
}

fn pick(cells: &[usize], sampler: &mut Sampler) -> Option<usize> {
    (!cells.is_empty()).then(|| *sampler.choose(cells))
}
