//! Adjustment of a finished board to the requested fraction of cells that contain more than floor.

use crate::levels::construct::builder::Builder;
use crate::levels::examples::is_cover;
use crate::levels::grid::FAR;
use engine::analysis::{Role, Steering};

impl Builder<'_> {
    /// Adds walls until enough cells are covered, or removes walls and sprites until no more cells are covered than
    /// requested. On boards without walls, adds other sprites. All sprites that the game requires are preserved, and no
    /// cell is cut off, so the requested cover is not always reached.
    pub(crate) fn adjust_cover(&mut self) {
        let Some((low, high)) = self.config.cover else { return };
        if is_cover(self.analysis, self.palette.base) {
            return;
        }
        for _ in 0..self.board.grid.len() {
            let share = self.covered() as f64 / self.board.grid.len() as f64;
            let done = if share < low {
                !self.add_cover()
            } else if share > high {
                !self.remove_cover()
            } else {
                true
            };
            if done {
                return;
            }
        }
    }

    /// Returns the number of cells that contain more than floor.
    fn covered(&self) -> usize {
        let covered = |&cell: &usize| match self.board.placed[cell] {
            Some(symbol) => is_cover(self.analysis, symbol),
            None => self.board.wall[cell],
        };
        (0..self.board.grid.len()).filter(covered).count()
    }

    /// Adds a wall or a sprite. Returns `true` if there was room.
    fn add_cover(&mut self) -> bool {
        // Add walls while there are fewer than in the examples, then other things, and finally walls again.
        let missing = self.target.as_ref().is_none_or(|target| self.inner_walls() < target.walls);
        missing && self.add_wall() || self.add_thing() || !missing && self.add_wall()
    }

    /// Returns the fraction of the cells inside the border that are walls.
    fn inner_walls(&self) -> f64 {
        let grid = self.board.grid;
        let inner = || (0..grid.len()).filter(|&cell| !grid.on_border(cell));
        inner().filter(|&cell| self.board.wall[cell]).count() as f64 / inner().count().max(1) as f64
    }

    /// Adds a wall without cutting off any cells. Returns `true` if there was room.
    fn add_wall(&mut self) -> bool {
        let grid = self.board.grid;
        let bare = self.target.as_ref().is_some_and(|target| target.walls <= 0.0);
        if self.palette.wall.is_some() && !bare {
            let steps = self.steps();
            let cells: Vec<usize> = self.board.free().collect();
            let weight = |&cell: &usize| {
                let near = grid.manhattan(cell, self.board.start) < 2 || self.is_on_line(cell);
                let busy = grid.beside(cell).any(|next| self.board.placed[next].is_some());
                let cut = near || busy || self.board.would_cut(self.palette, cell);
                // Walls grow from existing walls and fill niches first.
                let walls = self.board.walls_around(cell);
                match walls {
                    _ if cut || steps[cell] == FAR => 0,
                    0 => 1,
                    1..=2 => 3,
                    3..=4 => 20,
                    _ => 80,
                }
            };
            let weights: Vec<u32> = cells.iter().map(weight).collect();
            if let Some(at) = self.sampler.weighted(&weights) {
                self.board.wall[cells[at]] = true;
                return true;
            }
        }
        false
    }

    /// Returns `true` if a cell is on the avatar's line of movement. The line is wider for a large avatar.
    fn is_on_line(&self, cell: usize) -> bool {
        let Some(avatar) = self.analysis.start_avatar() else { return false };
        let grid = self.board.grid;
        let (columns, rows) = self.analysis.facts(avatar.stype).span;
        let ahead = |at: usize, from: usize, length: usize| (from..from + length).contains(&at);
        match avatar.steering {
            Steering::Horizontal => ahead(grid.y(cell), grid.y(self.board.start), rows),
            Steering::Vertical => ahead(grid.x(cell), grid.x(self.board.start), columns),
            _ => false,
        }
    }

    /// Adds a sprite of a type already on the board. Returns `true` if there was room.
    fn add_thing(&mut self) -> bool {
        let lying = |stype: &engine::SpriteType| {
            matches!(
                self.role(*stype),
                Role::Soil | Role::Collectable | Role::Cover | Role::Refuge | Role::Breakable | Role::Hazard
            )
        };
        let mut types: Vec<_> = self.log.iter().map(|(_, stype)| *stype).filter(lying).collect();
        types.retain(|stype| self.config.counts.iter().all(|(asked, _)| asked != stype));
        if types.is_empty() {
            return false;
        }
        // Common types are more likely to be drawn.
        let stype = *self.sampler.choose(&types);
        self.place(stype, self.role(stype)).is_some()
    }

    /// Removes a dispensable wall or sprite. Returns `true` if there was one.
    fn remove_cover(&mut self) -> bool {
        let grid = self.board.grid;
        let spare = |&(cell, stype): &(usize, engine::SpriteType)| {
            let lies = matches!(
                self.role(stype),
                Role::Soil
                    | Role::Collectable
                    | Role::Cover
                    | Role::Refuge
                    | Role::Breakable
                    | Role::Hazard
                    | Role::Neutral
                    | Role::Enemy
                    | Role::Boulder
                    | Role::Wall
            );
            let asked = self.config.counts.iter().any(|(asked, _)| *asked == stype);
            lies && !asked && !self.board.kept[cell] && self.board.count(self.analysis, stype) > 3
        };
        let things: Vec<usize> = (0..self.log.len()).filter(|&at| spare(&self.log[at])).collect();
        let walls: Vec<usize> = (0..grid.len())
            .filter(|&cell| {
                let stub = || grid.beside(cell).filter(|&next| self.board.wall[next]).count() <= 1;
                self.board.wall[cell] && !grid.on_border(cell) && stub()
            })
            .filter(|&cell| {
                grid.beside(cell).any(|next| !self.board.wall[next] && self.board.placed[next].is_none())
            })
            .collect();
        // On boards with gates, all walls stay, because an opening could bypass a gate. On other boards, only the ends
        // of walls are removed.
        let open_up = !walls.is_empty() && (things.is_empty() || self.sampler.ratio(2, 3));
        if open_up && !self.board.zone.iter().any(|&zone| zone > 0) {
            let cell = *self.sampler.choose(&walls);
            self.board.wall[cell] = false;
            return true;
        }
        if things.is_empty() {
            return false;
        }
        let at = *self.sampler.choose(&things);
        let (cell, _) = self.log.swap_remove(at);
        self.board.placed[cell] = None;
        true
    }
}
