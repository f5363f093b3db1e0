//! Locks and keys. A gate in a bottleneck guards the cells behind it, and the key to the gate lies in front of it.

use crate::levels::construct::builder::Builder;
use crate::levels::construct::plan::furnishable;
use crate::levels::grid::{FAR, WAYS};
use engine::SpriteType;
use engine::analysis::{Key, Lock, Role};

/// A bottleneck: its cell, and the cells reachable only through it.
pub(crate) struct Bottleneck {
    pub(crate) cell: usize,
    pub(crate) behind: Vec<usize>,
}

impl Builder<'_> {
    /// Places gates in bottlenecks of the area that is still open, and numbers the zones behind them from 1 in the
    /// order of placement. The key to a gate may lie behind a gate with a higher number. Returns the placed types.
    pub(crate) fn gates(&mut self) -> Vec<SpriteType> {
        let mut types: Vec<SpriteType> = furnishable(self.analysis, self.palette, Role::Gate);
        types.retain(|&stype| {
            // Keys that must be pushed onto something are left to `warehouse`.
            self.lock_of(stype).is_some_and(|lock| {
                let pushed = matches!(lock.key, Key::Switch(_, Some(_)));
                !pushed && lock.givers.iter().any(|giver| self.palette.symbol(giver.0).is_some())
            })
        });
        self.sampler.shuffle(&mut types);
        let most = 1 + crate::levels::construct::plan::round(1.0 + self.difficulty(), &mut self.sampler);
        let mut placed = Vec::new();
        for stype in types.into_iter().take(most) {
            let zone = placed.len() as u8 + 1;
            let Some(bottleneck) = self.bottleneck(false).or_else(|| self.build_vault(false)) else { break };
            self.put(bottleneck.cell, stype);
            self.board.zone[bottleneck.cell] = zone;
            for cell in bottleneck.behind {
                self.board.zone[cell] = zone;
            }
            placed.push(stype);
        }
        placed
    }

    /// Returns a type's lock; `None` if the type has no lock.
    pub(crate) fn lock_of(&self, stype: SpriteType) -> Option<&Lock> {
        self.analysis.locks().iter().find(|lock| lock.stype == stype)
    }

    /// Draws a bottleneck in zone 0 (the part of the board without gates) that cuts off neither too few nor too many
    /// cells; `None` if there is no such bottleneck. If `runway` is `true`, two free cells must lie in line in front of
    /// the bottleneck, so that an object can be pushed into it.
    pub(crate) fn bottleneck(&mut self, runway: bool) -> Option<Bottleneck> {
        let grid = self.board.grid;
        let here = |builder: &Self, cell: usize| {
            builder.board.zone[cell] == 0 && builder.board.is_walkable(builder.palette, cell)
        };
        let near: Vec<usize> = (0..grid.len()).filter(|&cell| here(self, cell)).collect();
        let mut found: Vec<Bottleneck> = Vec::new();
        for &cell in &near {
            let beside = grid.beside(cell).filter(|&next| here(self, next)).count();
            let close = grid.manhattan(cell, self.board.start) < 2;
            if close || beside != 2 || self.board.placed[cell].is_some() || self.board.kept[cell] {
                continue;
            }
            let steps = grid.flood(&[self.board.start], |next| next != cell && here(self, next));
            let behind: Vec<usize> =
                near.iter().copied().filter(|&next| next != cell && steps[next] == FAR).collect();
            let before =
                |cell: Option<usize>| cell.is_some_and(|cell| here(self, cell) && steps[cell] != FAR);
            let line = |way: &(i32, i32)| {
                let next = grid.shift(cell, *way);
                before(next) && before(next.and_then(|next| grid.shift(next, *way)))
            };
            let fits = !runway || WAYS.iter().any(line);
            if fits && !behind.is_empty() && behind.len() * 5 <= near.len() * 3 {
                found.push(Bottleneck { cell, behind });
            }
        }
        // Prefer to cut off rooms rather than niches, but less than half of the level.
        let weight = |bottleneck: &Bottleneck| match bottleneck.behind.len() {
            1 => 1,
            size if size * 3 <= near.len() => 2 + 2 * size.min(8) as u32,
            _ => 3,
        };
        let weights: Vec<u32> = found.iter().map(weight).collect();
        let drawn = self.sampler.weighted(&weights)?;
        Some(found.swap_remove(drawn))
    }

    /// Walls off a corner or a niche of zone 0 (the part of the board without gates), leaving one opening. `runway` has
    /// the same meaning as in [`Builder::bottleneck`].
    pub(crate) fn build_vault(&mut self, runway: bool) -> Option<Bottleneck> {
        self.palette.wall?;
        let grid = self.board.grid;
        for _ in 0..60 {
            let (width, height) = (self.sampler.between(1, 3), self.sampler.between(1, 3));
            if grid.columns < width + 3 || grid.rows < height + 3 {
                continue;
            }
            let (left, top) =
                (self.sampler.below(grid.columns - width), self.sampler.below(grid.rows - height));
            let inside = |cell: usize| {
                (left..left + width).contains(&grid.x(cell)) && (top..top + height).contains(&grid.y(cell))
            };
            let cells: Vec<usize> = (0..grid.len()).filter(|&cell| inside(cell)).collect();
            let usable = |cell: usize| self.board.is_free(cell) && self.board.zone[cell] == 0;
            let shell: Vec<usize> = (0..grid.len())
                .filter(|&cell| !inside(cell) && grid.around(cell).into_iter().flatten().any(&inside))
                .collect();
            let fits = cells.iter().all(|&cell| usable(cell))
                && shell.iter().all(|&cell| self.board.wall[cell] || usable(cell))
                && shell.iter().filter(|&&cell| !self.board.wall[cell]).count() <= 6;
            if !fits {
                continue;
            }
            let before = self.board.wall.clone();
            let outward = |cell: usize| {
                grid.beside(cell).any(|next| !inside(next) && !shell.contains(&next) && !before[next])
                    && grid.beside(cell).any(inside)
            };
            let openings: Vec<usize> =
                shell.iter().copied().filter(|&cell| usable(cell) && outward(cell)).collect();
            if openings.is_empty() {
                continue;
            }
            let opening = *self.sampler.choose(&openings);
            for &cell in shell.iter().filter(|&&cell| cell != opening) {
                self.board.wall[cell] = true;
            }
            let steps = grid.flood(&[self.board.start], |cell| {
                !self.board.wall[cell] && self.board.placed[cell].is_none_or(|_| true)
            });
            let whole = (0..grid.len()).all(|cell| self.board.wall[cell] || steps[cell] != FAR);
            let outside = |cell: Option<usize>| {
                cell.is_some_and(|cell| {
                    self.board.is_free(cell) && !inside(cell) && self.board.zone[cell] == 0
                })
            };
            let line = |way: &(i32, i32)| {
                let next = grid.shift(opening, *way);
                outside(next) && outside(next.and_then(|next| grid.shift(next, *way)))
            };
            if whole && (!runway || WAYS.iter().any(line)) {
                return Some(Bottleneck { cell: opening, behind: cells });
            }
            self.board.wall = before;
        }
        None
    }
}
