//! Placement of sprites on an open field for an avatar that moves along one edge, with enemies on the far side and
//! cover in between.

use crate::levels::construct::builder::Builder;
use crate::levels::construct::plan::Wish;
use engine::SpriteType;
use engine::analysis::{Motion, Role, Steering};

/// A field from the avatar's point of view. The coordinate `along` is the position on the avatar's line of movement,
/// and `deep` is the row counted from the far side.
struct Field {
    upright: bool,
    edge: usize,
    length: usize,
}

impl Field {
    /// Returns the cell at a position in the field.
    fn cell(&self, builder: &Builder<'_>, along: usize, deep: usize) -> usize {
        let grid = builder.board.grid;
        if self.upright {
            grid.at(self.edge + along, self.edge + deep)
        } else {
            // An avatar that moves up and down stands on the left.
            grid.at(grid.columns - 1 - self.edge - deep, self.edge + along)
        }
    }

    fn deep(&self, builder: &Builder<'_>, cell: usize) -> usize {
        let grid = builder.board.grid;
        if self.upright {
            grid.y(cell).saturating_sub(self.edge)
        } else {
            (grid.columns - 1 - self.edge).saturating_sub(grid.x(cell))
        }
    }

    fn along(&self, builder: &Builder<'_>, cell: usize) -> usize {
        let grid = builder.board.grid;
        let along = if self.upright { grid.x(cell) } else { grid.y(cell) };
        along.saturating_sub(self.edge)
    }
}

impl Builder<'_> {
    /// Places the sprites on a field without inner walls.
    pub(crate) fn gallery(&mut self, steering: Steering, ring: bool) {
        let edge = usize::from(ring);
        let (columns, rows) = (self.board.grid.columns - 2 * edge, self.board.grid.rows - 2 * edge);
        let upright = steering != Steering::Vertical;
        let (length, depth) = if upright { (columns, rows) } else { (rows, columns) };
        let field = Field { upright, edge, length };
        let wishes = self.wishes();
        let wards = wishes.iter().any(|wish| wish.role == Role::Ward && self.is_still(wish.stype));
        // Things to protect stand behind the avatar if there is room.
        let home = if wards && depth >= 6 { depth - 2 } else { depth - 1 };
        let middle = length / 2;
        let along = (middle + self.sampler.below(3)).saturating_sub(1).min(length - 1);
        let start = field.cell(self, along, home);
        self.put_avatar(start);
        for wish in &wishes {
            match wish.role {
                Role::Ward if self.is_still(wish.stype) => self.line_up(&field, *wish, depth - 1),
                Role::Cover | Role::Hazard | Role::Breakable => self.bases(&field, *wish, home),
                Role::Enemy | Role::Prey => self.formation(&field, *wish, home),
                Role::Spawner => self.at_far_side(&field, *wish, home),
                _ => self.somewhere(&field, *wish, home),
            }
        }
    }

    fn is_still(&self, stype: SpriteType) -> bool {
        self.analysis.facts(stype).motion == Motion::Still
    }

    /// Places sprites evenly along a row, with small random offsets.
    fn line_up(&mut self, field: &Field, wish: Wish, deep: usize) {
        for at in 0..wish.count {
            let middle = (2 * at + 1) * field.length / (2 * wish.count);
            let along = (middle + self.sampler.below(3)).saturating_sub(1).min(field.length - 1);
            let cell = field.cell(self, along, deep);
            if self.fits(cell, wish.stype) {
                self.put(cell, wish.stype);
            } else {
                self.put_where(wish.stype, |builder, cell| u32::from(field.deep(builder, cell) == deep));
            }
        }
    }

    /// Places sprites in mirrored blocks of two to four along a band in front of the avatar.
    fn bases(&mut self, field: &Field, wish: Wish, home: usize) {
        if home < 4 {
            return;
        }
        let gap = if home >= 7 { 2 } else { 1 };
        let deeper = if self.target.is_some() && home >= 9 { self.sampler.below(2) } else { 0 };
        let band = home - gap - 1 - deeper;
        let mut left = wish.count;
        let width = self.sampler.between(2, 4);
        let pitch = width + self.sampler.between(2, 3);
        let mut offset = self.sampler.below(pitch);
        let thick = if left > field.length { 2 } else { 1 };
        if self.target.is_some() {
            // Bases are placed from the middle towards both sides, with a base or a gap in the middle, so that they are
            // never all on one side.
            let middle = if self.sampler.ratio(1, 2) { width / 2 } else { (width + pitch) / 2 };
            offset = (middle + pitch * field.length - (field.length - 1) / 2) % pitch;
        }
        for row in 0..thick {
            let mut line: Vec<usize> = (0..field.length).collect();
            if self.target.is_some() {
                line.sort_by_key(|along| along.abs_diff((field.length - 1) / 2));
            }
            for along in line {
                let mirrored = along.min(field.length - 1 - along);
                let cell = field.cell(self, along, band - row);
                if left > 0 && (mirrored + offset) % pitch < width && self.fits(cell, wish.stype) {
                    self.put(cell, wish.stype);
                    left -= 1;
                }
            }
        }
    }

    /// Places sprites in evenly spaced ranks on the far side, one type per rank.
    fn formation(&mut self, field: &Field, wish: Wish, home: usize) {
        let deepest = (home / 2).max(1);
        let grid = self.board.grid;
        let taken = |builder: &Self, deep: usize| {
            (0..grid.len())
                .any(|cell| builder.board.placed[cell].is_some() && field.deep(builder, cell) == deep)
        };
        let ranks: Vec<usize> = (0..deepest).filter(|&deep| !taken(self, deep)).collect();
        let rank = if ranks.is_empty() { self.sampler.below(deepest) } else { *self.sampler.choose(&ranks) };
        // A rank leaves enough room to move.
        let fits = (field.length / 3).max(1);
        let mut left = wish.count;
        let mut deep = rank;
        while left > 0 {
            let now = left.min(fits);
            for at in 0..now {
                let middle = (2 * at + 1) * field.length / (2 * now);
                let mut along = (middle + self.sampler.below(2)).min(field.length - 1);
                // Nothing starts directly above the avatar.
                let home = field.along(self, self.board.start);
                if along.abs_diff(home) < 3 {
                    along =
                        if along < home { home.saturating_sub(3) } else { (home + 3).min(field.length - 1) };
                }
                let cell = field.cell(self, along, deep);
                if self.fits(cell, wish.stype) {
                    self.put(cell, wish.stype);
                }
            }
            left -= now;
            deep = (deep + 1) % deepest;
        }
    }

    /// Places sprites near the corners of the far side.
    fn at_far_side(&mut self, field: &Field, wish: Wish, home: usize) {
        for _ in 0..wish.count {
            let length = field.length;
            self.put_where(wish.stype, |builder, cell| {
                let along = field.along(builder, cell);
                let deep = field.deep(builder, cell);
                let outer = along.min(length - 1 - along);
                let apart = builder.apart_from(cell, Role::Spawner).min(12) as u32;
                let over = along.abs_diff(field.along(builder, builder.board.start)) < 3;
                if deep > (home / 4).max(1) || over {
                    0
                } else {
                    apart * if outer < length / 5 { 4 } else { 1 }
                }
            });
        }
    }

    /// Places all other sprites. Stationary sprites that the avatar must touch are placed on its line, and the rest in
    /// the area between.
    fn somewhere(&mut self, field: &Field, wish: Wish, home: usize) {
        let touched = matches!(
            wish.role,
            Role::Exit
                | Role::Collectable
                | Role::Key
                | Role::Portal
                | Role::PortalExit
                | Role::Pushable
                | Role::Socket
        );
        let on_line = touched && self.is_still(wish.stype);
        for _ in 0..wish.count {
            self.put_where(wish.stype, |builder, cell| {
                let deep = field.deep(builder, cell);
                let apart = builder.apart(cell, |other| other == wish.stype).min(8) as u32;
                let suits = if on_line { deep == home } else { deep + 2 < home };
                let near = builder.board.grid.manhattan(cell, builder.board.start) < 3;
                if suits && !near { apart } else { 0 }
            });
        }
    }
}
