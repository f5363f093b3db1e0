//! A board's walls while its plan is being drawn.

use crate::levels::grid::{FAR, Grid};
use base::Sampler;

/// A line that divides a board, and the gaps in the line. The line's walls have not been placed yet.
#[derive(Clone, Debug)]
pub(crate) struct Divider {
    /// The line's cells from one end to the other, including gaps.
    pub(crate) line: Vec<usize>,
    pub(crate) gaps: Vec<Vec<usize>>,
}

/// A board's walls while its plan is being drawn.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    pub(crate) grid: Grid,
    pub(crate) wall: Vec<bool>,
    pub(crate) dividers: Vec<Divider>,
    /// The floor cells in or around the landmark (the plan's main feature), reserved for the most important sprites.
    pub(crate) marks: Vec<usize>,
}

impl Canvas {
    /// Creates a canvas with open floor inside a ring of walls.
    pub(crate) fn new(columns: usize, rows: usize) -> Canvas {
        let grid = Grid { columns, rows };
        let wall = (0..grid.len()).map(|cell| grid.on_border(cell)).collect();
        Canvas { grid, wall, dividers: Vec::new(), marks: Vec::new() }
    }

    /// Returns the width of the floor. The floor covers the columns from 1 to this width.
    pub(crate) fn width(&self) -> usize {
        self.grid.columns - 2
    }

    /// Returns the height of the floor. The floor covers the rows from 1 to this height.
    pub(crate) fn height(&self) -> usize {
        self.grid.rows - 2
    }

    /// Fills a rectangle with walls, except for any part that is off the board.
    pub(crate) fn fill(&mut self, (x, y): (usize, usize), size: (usize, usize)) {
        for cell in self.cells((x, y), size) {
            self.wall[cell] = true;
        }
    }

    /// Clears a rectangle, except for any part on or beyond the border.
    pub(crate) fn clear(&mut self, (x, y): (usize, usize), size: (usize, usize)) {
        for cell in self.cells((x, y), size) {
            self.wall[cell] = self.grid.on_border(cell);
        }
    }

    /// Marks the floor of a rectangle as part of the plan's landmark (its main feature).
    pub(crate) fn mark(&mut self, (x, y): (usize, usize), size: (usize, usize)) {
        let cells = self.cells((x, y), size);
        self.marks.extend(cells.into_iter().filter(|&cell| !self.grid.on_border(cell)));
    }

    /// Returns the cells of a rectangle that lie on the board, row by row.
    pub(crate) fn cells(&self, (x, y): (usize, usize), size: (usize, usize)) -> Vec<usize> {
        if x >= self.grid.columns || y >= self.grid.rows {
            return Vec::new();
        }
        self.grid.block(self.grid.at(x, y), size).collect()
    }

    /// Returns the cells along a line through the given corners. Each corner is in the same row or column as the
    /// previous corner.
    pub(crate) fn path(&self, corners: &[(usize, usize)]) -> Vec<usize> {
        let mut cells: Vec<usize> = Vec::new();
        for pair in corners.windows(2) {
            let ((x, y), (to_x, to_y)) = (pair[0], pair[1]);
            let steps = x.abs_diff(to_x).max(y.abs_diff(to_y));
            let along = |from: usize, to: usize, at: usize| match from.cmp(&to) {
                std::cmp::Ordering::Less => from + at,
                std::cmp::Ordering::Equal => from,
                std::cmp::Ordering::Greater => from - at,
            };
            for at in 0..=steps {
                let cell = self.grid.at(along(x, to_x, at), along(y, to_y, at));
                if !self.grid.on_border(cell) && cells.last() != Some(&cell) {
                    cells.push(cell);
                }
            }
        }
        cells
    }

    /// Adds a divider with up to `gaps` gaps. Each gap is one or two cells wide, lies on a straight stretch, and is not
    /// next to another gap.
    pub(crate) fn divide(&mut self, line: Vec<usize>, gaps: usize, sampler: &mut Sampler) {
        let is_straight = |at: usize| {
            at > 0
                && at + 1 < line.len()
                && self.grid.offset(line[at - 1], line[at]) == self.grid.offset(line[at], line[at + 1])
        };
        let mut places: Vec<usize> = (0..line.len()).filter(|&at| is_straight(at)).collect();
        let mut chosen: Vec<(usize, usize)> = Vec::new();
        while chosen.len() < gaps && !places.is_empty() {
            let at = *sampler.choose(&places);
            let width = if is_straight(at + 1) && sampler.ratio(2, 3) { 2 } else { 1 };
            chosen.push((at, width));
            places.retain(|&other| other.abs_diff(at) > 3);
        }
        let gaps = chosen.iter().map(|&(at, width)| line[at..at + width].to_vec()).collect();
        self.dividers.push(Divider { line, gaps });
    }

    /// Returns the canvas transformed by a symmetry: bit 0 mirrors left and right, bit 1 mirrors up and down, bit 2
    /// swaps columns and rows.
    pub(crate) fn turned(self, symmetry: usize) -> Canvas {
        let grid = self.grid;
        let image = match symmetry & 4 {
            0 => grid,
            _ => Grid { columns: grid.rows, rows: grid.columns },
        };
        let moved = |cell: usize| {
            let (x, y) = (grid.x(cell), grid.y(cell));
            let x = if symmetry & 1 != 0 { grid.columns - 1 - x } else { x };
            let y = if symmetry & 2 != 0 { grid.rows - 1 - y } else { y };
            if symmetry & 4 != 0 { image.at(y, x) } else { image.at(x, y) }
        };
        let all = |cells: &[usize]| cells.iter().map(|&cell| moved(cell)).collect::<Vec<usize>>();
        let mut wall = vec![false; grid.len()];
        (0..grid.len()).for_each(|cell| wall[moved(cell)] = self.wall[cell]);
        let divider = |divider: &Divider| Divider {
            line: all(&divider.line),
            gaps: divider.gaps.iter().map(|gap| all(gap)).collect(),
        };
        let dividers = self.dividers.iter().map(divider).collect();
        Canvas { grid: image, wall, dividers, marks: all(&self.marks) }
    }

    /// Fills some of the floor's corners and edges, so that its outline is not a plain rectangle.
    pub(crate) fn bite(&mut self, sampler: &mut Sampler) {
        let (width, height) = (self.width(), self.height());
        for corner in 0..4 {
            if !sampler.ratio(2, 5) {
                continue;
            }
            let (across, down) = (sampler.between(1, 3), sampler.between(1, 2));
            for step in 0..down {
                let reach = across.saturating_sub(if sampler.ratio(1, 2) { step } else { 0 }).max(1);
                let y = if corner & 1 == 0 { 1 + step } else { height - step };
                let x = if corner & 2 == 0 { 1 } else { width + 1 - reach };
                self.fill((x, y), (reach, 1));
            }
        }
        if sampler.ratio(1, 2) {
            let (long, at) = (sampler.between(2, 3), sampler.between(3, width.max(5) - 2));
            let y = if sampler.ratio(1, 2) { 1 } else { height };
            self.fill((at, y), (long.min(width.saturating_sub(at)), 1));
        }
    }

    /// Removes walls that do not touch another wall, and fills disconnected floor. Dividers count as floor. Returns
    /// `false` if a disconnected part of the floor is too large to fill, or if too little floor is left.
    pub(crate) fn settle(&mut self) -> bool {
        for cell in 0..self.grid.len() {
            let barred = |next: &Option<usize>| next.is_none_or(|next| self.wall[next]);
            if self.wall[cell] && !self.grid.around(cell).iter().any(barred) {
                self.wall[cell] = false;
            }
        }
        let regions = self.grid.regions(|cell| !self.wall[cell]);
        let Some((largest, pockets)) = regions.split_first() else { return false };
        if pockets.iter().any(|pocket| pocket.len() > 4) {
            return false;
        }
        pockets.iter().flatten().for_each(|&cell| self.wall[cell] = true);
        let is_wall = |cell: &usize| self.wall[*cell];
        for divider in &mut self.dividers {
            divider.line.retain(|cell| !is_wall(cell));
            divider.gaps.iter_mut().for_each(|gap| gap.retain(|cell| !is_wall(cell)));
            divider.gaps.retain(|gap| !gap.is_empty());
        }
        self.marks.retain(|cell| !is_wall(cell));
        largest.len() * 5 >= self.width() * self.height() * 2
    }
}

/// Returns the fraction of floor cells that are not in any 2×2 square of floor cells. Such cells form corridors,
/// doorways and alcoves.
pub(crate) fn narrow(grid: Grid, is_floor: impl Fn(usize) -> bool) -> f64 {
    let mut wide = vec![false; grid.len()];
    for cell in 0..grid.len() {
        let square: Vec<usize> = grid.block(cell, (2, 2)).collect();
        if square.len() == 4 && square.iter().all(|&cell| is_floor(cell)) {
            square.iter().for_each(|&cell| wide[cell] = true);
        }
    }
    let floor: Vec<usize> = (0..grid.len()).filter(|&cell| is_floor(cell)).collect();
    let narrow = floor.iter().filter(|&&cell| !wide[cell]).count();
    narrow as f64 / floor.len().max(1) as f64
}

/// Returns the area of the largest empty rectangle, as a fraction of the area within the border. Cost: O(cells ×
/// columns).
pub(crate) fn emptiness(grid: Grid, is_empty: impl Fn(usize) -> bool) -> f64 {
    let mut heights = vec![0usize; grid.columns];
    let mut largest = 0;
    for y in 1..grid.rows - 1 {
        for (x, height) in heights.iter_mut().enumerate().take(grid.columns - 1).skip(1) {
            *height = if is_empty(grid.at(x, y)) { *height + 1 } else { 0 };
        }
        for left in 1..grid.columns - 1 {
            let mut lowest = usize::MAX;
            for (right, &height) in heights.iter().enumerate().take(grid.columns - 1).skip(left) {
                lowest = lowest.min(height);
                largest = largest.max(lowest * (right + 1 - left));
            }
        }
    }
    largest as f64 / ((grid.columns - 2) * (grid.rows - 2)) as f64
}

/// Returns the cells whose distance from a given cell through open cells is at least 70% of the maximum distance.
pub(crate) fn far_from(grid: Grid, from: usize, open: impl Fn(usize) -> bool) -> Vec<usize> {
    let steps = grid.flood(&[from], open);
    let reached = || steps.iter().copied().filter(|&steps| steps != FAR);
    let most = reached().max().unwrap_or(0);
    (0..grid.len()).filter(|&cell| steps[cell] != FAR && steps[cell] * 10 >= most * 7).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_empty_rectangle_counts() {
        let mut canvas = Canvas::new(8, 6);
        let empty = |canvas: &Canvas| emptiness(canvas.grid, |cell| !canvas.wall[cell]);
        assert_eq!(empty(&canvas), 1.0);
        canvas.fill((3, 1), (1, 3));
        // The empty rectangle is either the three columns on the right, or the row at the bottom.
        assert_eq!(empty(&canvas), 12.0 / 24.0);
        canvas.fill((5, 1), (1, 4));
        assert_eq!(empty(&canvas), 8.0 / 24.0);
    }
}
