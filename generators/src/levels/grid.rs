//! The board as a graph of cells. A cell is given by its row-major index.

use base::Sampler;
use engine::Action;
use std::collections::VecDeque;

/// The steps up, left, down and right: (columns, rows).
pub(crate) const WAYS: [(i32, i32); 4] = [(0, -1), (-1, 0), (0, 1), (1, 0)];
/// The actions for the steps in [`WAYS`].
pub(crate) const ACTIONS: [Action; 4] = [Action::Up, Action::Left, Action::Down, Action::Right];
/// The offsets of the eight surrounding cells, clockwise from the top.
const AROUND: [(i32, i32); 8] = [(0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1)];
/// The distance assigned to unreachable cells.
pub(crate) const FAR: u32 = u32::MAX;

/// A board's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Grid {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Grid {
    pub(crate) fn len(self) -> usize {
        self.columns * self.rows
    }

    pub(crate) fn at(self, x: usize, y: usize) -> usize {
        y * self.columns + x
    }

    pub(crate) fn x(self, cell: usize) -> usize {
        cell % self.columns
    }

    pub(crate) fn y(self, cell: usize) -> usize {
        cell / self.columns
    }

    /// Returns the cell at an offset from `cell`; `None` if it is off the board.
    pub(crate) fn shift(self, cell: usize, (dx, dy): (i32, i32)) -> Option<usize> {
        let x = usize::try_from(self.x(cell) as i32 + dx).ok().filter(|&x| x < self.columns)?;
        let y = usize::try_from(self.y(cell) as i32 + dy).ok().filter(|&y| y < self.rows)?;
        Some(self.at(x, y))
    }

    /// Returns the cells of the rectangle with the top left corner `cell`, row by row. Cells off the board are omitted.
    pub(crate) fn block(self, cell: usize, (columns, rows): (usize, usize)) -> impl Iterator<Item = usize> {
        let (right, bottom) = (self.x(cell) + columns, self.y(cell) + rows);
        let (right, bottom) = (right.min(self.columns), bottom.min(self.rows));
        (self.y(cell)..bottom).flat_map(move |y| (self.x(cell)..right).map(move |x| self.at(x, y)))
    }

    /// Returns a cell's neighbours, up to four.
    pub(crate) fn beside(self, cell: usize) -> impl Iterator<Item = usize> {
        WAYS.into_iter().filter_map(move |way| self.shift(cell, way))
    }

    /// Returns the eight cells around a cell, clockwise from the top; `None` for cells off the board.
    pub(crate) fn around(self, cell: usize) -> [Option<usize>; 8] {
        AROUND.map(|shift| self.shift(cell, shift))
    }

    pub(crate) fn on_border(self, cell: usize) -> bool {
        let (x, y) = (self.x(cell), self.y(cell));
        x == 0 || y == 0 || x + 1 == self.columns || y + 1 == self.rows
    }

    /// Returns the offset from one cell to another, as (columns, rows).
    pub(crate) fn offset(self, from: usize, to: usize) -> (i32, i32) {
        let apart = |axis: fn(Grid, usize) -> usize| axis(self, to) as i32 - axis(self, from) as i32;
        (apart(Grid::x), apart(Grid::y))
    }

    /// Returns the number of steps between two cells, ignoring obstacles.
    pub(crate) fn manhattan(self, one: usize, two: usize) -> usize {
        self.x(one).abs_diff(self.x(two)) + self.y(one).abs_diff(self.y(two))
    }

    /// Returns the distance of each cell from the nearest cell in `from`, in steps through open cells. Unreachable
    /// cells have the distance [`FAR`]. The cells in `from` need not be open. Cost: O(cells).
    pub(crate) fn flood(self, from: &[usize], open: impl Fn(usize) -> bool) -> Vec<u32> {
        let mut steps = vec![FAR; self.len()];
        let mut queue: VecDeque<usize> = from.iter().copied().collect();
        for &cell in from {
            steps[cell] = 0;
        }
        while let Some(cell) = queue.pop_front() {
            for next in self.beside(cell) {
                if steps[next] == FAR && open(next) {
                    steps[next] = steps[cell] + 1;
                    queue.push_back(next);
                }
            }
        }
        steps
    }

    /// Returns a shortest path from `from` to `to` through open cells, including both ends; `None` if there is no path.
    /// Cost: O(cells).
    pub(crate) fn way(self, from: usize, to: usize, open: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
        let steps = self.flood(&[to], |cell| cell == from || open(cell));
        let mut way = vec![from];
        let mut cell = from;
        while cell != to {
            if steps[cell] == FAR {
                return None;
            }
            cell = self.beside(cell).find(|&next| steps[next] < steps[cell])?;
            way.push(cell);
        }
        Some(way)
    }

    /// Returns the connected regions of open cells, from largest to smallest. Regions of equal size are ordered by
    /// first cell. Cost: O(cells).
    pub(crate) fn regions(self, open: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.len()];
        let mut regions: Vec<Vec<usize>> = Vec::new();
        for start in 0..self.len() {
            if seen[start] || !open(start) {
                continue;
            }
            seen[start] = true;
            let mut region = vec![start];
            let mut next = 0;
            while next < region.len() {
                for beside in self.beside(region[next]) {
                    if !seen[beside] && open(beside) {
                        seen[beside] = true;
                        region.push(beside);
                    }
                }
                next += 1;
            }
            region.sort_unstable();
            regions.push(region);
        }
        regions.sort_by_key(|region| std::cmp::Reverse(region.len()));
        regions
    }

    /// Turns up to `walls` cells of floor into walls. The remaining floor stays connected. Cost: O(cells · walls).
    pub(crate) fn wall_off(self, is_floor: &mut [bool], walls: usize, sampler: &mut Sampler) {
        let mut inner: Vec<usize> = (0..self.len()).filter(|&cell| is_floor[cell]).collect();
        sampler.shuffle(&mut inner);
        for &cell in inner.iter().take(walls) {
            if !self.is_cut(cell, |next| is_floor[next]) {
                is_floor[cell] = false;
            }
        }
    }

    /// Returns `true` if the open cells next to `cell` would be disconnected without `cell`. Cost: usually O(1),
    /// otherwise O(cells).
    pub(crate) fn is_cut(self, cell: usize, open: impl Fn(usize) -> bool) -> bool {
        let beside: Vec<usize> = self.beside(cell).filter(|&next| open(next)).collect();
        if beside.len() < 2 {
            return false;
        }
        // Count the runs of open cells around the cell that share a side with it. If there is only one run, all
        // neighbours are connected without the cell.
        let around = self.around(cell).map(|next| next.is_some_and(&open));
        let runs = (0..8).filter(|&at| around[at] && !around[(at + 7) % 8]).filter(|&at| {
            let run = (0..8).map(|more| (at + more) % 8).take_while(|&place| around[place]);
            run.into_iter().any(|place| place % 2 == 0)
        });
        if runs.count() < 2 {
            return false;
        }
        let steps = self.flood(&beside[..1], |next| next != cell && open(next));
        beside.iter().any(|&next| steps[next] == FAR)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(text: &str) -> (Grid, Vec<bool>) {
        let columns = text.split('\n').next().map_or(0, str::len);
        let cells: Vec<bool> = text.bytes().filter(|&c| c != b'\n').map(|c| c == b'.').collect();
        (Grid { columns, rows: cells.len() / columns }, cells)
    }

    #[test]
    fn a_cell_cuts_without_another_path() {
        let (grid, cells) = open("...\n#.#\n...");
        assert!(grid.is_cut(grid.at(1, 1), |cell| cells[cell]));
        assert!(!grid.is_cut(grid.at(0, 0), |cell| cells[cell]));
        let (ring, cells) = open("...\n.#.\n...");
        assert!(!ring.is_cut(ring.at(1, 0), |cell| cells[cell]));
    }

    #[test]
    fn paths_are_shortest() {
        let (grid, cells) = open("...\n.#.\n...");
        let way = grid.way(0, 8, |cell| cells[cell]).unwrap();
        assert_eq!((way.len(), way[0], way[4]), (5, 0, 8));
        assert_eq!(grid.regions(|cell| !cells[cell]), [vec![4]]);
    }
}
