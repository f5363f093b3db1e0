//! The tools for filling a board: placing sprites at sensible positions.

use super::board::Board;
use super::plan::{self, Wish};
use crate::levels::config::LevelConfig;
use crate::levels::examples::{Examples, Target};
use crate::levels::grid::{FAR, WAYS};
use crate::levels::palette::{Palette, Walk};
use crate::levels::placement::{NICHE, nook};
use base::Sampler;
use engine::analysis::{Motion, Role, Steering};
use engine::{Analysis, Direction, SpriteType};

/// The weight factor for a cell next to a companion, which is a sprite that almost always stands next to a sprite of
/// the type in the examples.
const COMPANION_WEIGHT: u32 = 1000;
/// The weight factor for a cell in line with other sprites of a type, if such sprites stand in lines in the examples.
const LINE_WEIGHT: u32 = 40;

/// A level under construction, with all data needed for decisions about it.
pub(crate) struct Builder<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) palette: &'a Palette,
    pub(crate) config: &'a LevelConfig,
    pub(crate) sampler: Sampler,
    pub(crate) board: Board,
    /// The cells and types of all placed sprites, in the order of placement.
    pub(crate) log: Vec<(usize, SpriteType)>,
    /// The target drawn from the examples, if there are any.
    pub(crate) target: Option<Target>,
}

impl Builder<'_> {
    /// Places a sprite of the type in a cell. Other cells that the sprite covers are reserved.
    pub(crate) fn put(&mut self, cell: usize, stype: SpriteType) {
        self.board.placed[cell] = self.palette.symbol(stype);
        self.log.push((cell, stype));
        for covered in self.covered_by(cell, stype).skip(1) {
            self.board.kept[covered] = true;
        }
    }

    /// Places one of the possible initial avatars in the cell, or as near as possible if the avatar is larger than a
    /// cell. If the board is surrounded by walls, no gap is made in them.
    pub(crate) fn put_avatar(&mut self, cell: usize) {
        let (stype, symbol) = *self.sampler.choose(&self.palette.avatars);
        let grid = self.board.grid;
        let (columns, rows) = self.analysis.facts(stype).span;
        let ring = usize::from(self.board.is_closed());
        let within = |at: usize, size: usize, cells: usize| at.min(cells.saturating_sub(size + ring));
        let cell =
            grid.at(within(grid.x(cell), columns, grid.columns), within(grid.y(cell), rows, grid.rows));
        self.board.placed[cell] = Some(symbol);
        self.board.start = cell;
        self.log.push((cell, stype));
        for covered in self.covered_by(cell, stype).skip(1) {
            self.board.wall[covered] = false;
            self.board.kept[covered] = true;
        }
    }

    /// Returns the cells covered by a sprite of the type, starting with the sprite's own cell.
    fn covered_by(&self, cell: usize, stype: SpriteType) -> impl Iterator<Item = usize> + use<> {
        self.board.grid.block(cell, self.analysis.facts(stype).span)
    }

    /// Returns `true` if all cells that a sprite of the type would cover are on the board and free.
    pub(crate) fn fits(&self, cell: usize, stype: SpriteType) -> bool {
        let (columns, rows) = self.analysis.facts(stype).span;
        if (columns, rows) == (1, 1) {
            return self.board.is_free(cell);
        }
        let mut covered = self.covered_by(cell, stype);
        covered.all(|cell| self.board.is_free(cell)) && self.covered_by(cell, stype).count() == columns * rows
    }

    /// Draws a free cell by weight, places a sprite in it, and returns the cell.
    pub(crate) fn put_where(
        &mut self,
        stype: SpriteType,
        weight: impl Fn(&Self, usize) -> u32,
    ) -> Option<usize> {
        if self.examples().is_some_and(|examples| examples.closed && examples.placement(stype).is_on_border())
            && let Some(cell) = self.put_in_border(stype)
        {
            return Some(cell);
        }
        if self.examples().is_some_and(|examples| examples.placement(stype).is_in_niches())
            && let Some(cell) = self.put_in_niche(stype)
        {
            return Some(cell);
        }
        let cells: Vec<usize> = self.board.free().filter(|&cell| self.fits(cell, stype)).collect();
        let weights: Vec<u32> = cells
            .iter()
            .map(|&cell| match weight(self, cell) {
                0 => 0,
                weight => weight.saturating_mul(self.example_weight(cell, stype)),
            })
            .collect();
        let cell = cells[self.sampler.weighted(&weights)?];
        self.put(cell, stype);
        Some(cell)
    }

    /// Places a sprite into the wall around the board, at a cell with an open neighbour. Returns the cell.
    fn put_in_border(&mut self, stype: SpriteType) -> Option<usize> {
        let grid = self.board.grid;
        let open = |cell: usize| !self.board.wall[cell] && !grid.on_border(cell);
        let suits =
            |cell: usize| grid.on_border(cell) && self.board.wall[cell] && grid.beside(cell).any(open);
        let cells: Vec<usize> = (0..grid.len()).filter(|&cell| suits(cell)).collect();
        let sides = |cell: usize| {
            self.examples().map_or(0, |examples| examples.placement(stype).on_border(grid, cell))
        };
        let weights: Vec<u32> =
            cells.iter().map(|&cell| sides(cell) * self.example_weight(cell, stype)).collect();
        let cell = cells[self.sampler.weighted(&weights)?];
        self.board.wall[cell] = false;
        self.put(cell, stype);
        Some(cell)
    }

    /// Places a sprite in a niche far from the start and away from other sprites. If there is no niche, carves one out
    /// of a wall. Returns the cell.
    fn put_in_niche(&mut self, stype: SpriteType) -> Option<usize> {
        self.palette.wall?;
        let grid = self.board.grid;
        let steps = self.steps();
        let suits = |&cell: &usize| {
            let hollow = self.board.wall[cell] && !grid.on_border(cell);
            let reached = grid.beside(cell).any(|next| steps[next] != FAR && self.board.is_free(next));
            (hollow || self.board.is_free(cell))
                && nook(grid, &self.board.wall, cell) == NICHE
                && reached
                && grid.manhattan(cell, self.board.start) >= 3
        };
        let cells: Vec<usize> = (0..grid.len()).filter(suits).collect();
        let weight = |&cell: &usize| {
            let wards = self.apart_from(cell, Role::Ward) >= 4;
            let apart = self.apart(cell, |other| other == stype).min(8) as u32;
            if wards { self.example_weight(cell, stype).saturating_mul(apart) } else { 0 }
        };
        let weights: Vec<u32> = cells.iter().map(weight).collect();
        let cell = cells[self.sampler.weighted(&weights)?];
        self.board.wall[cell] = false;
        self.put(cell, stype);
        Some(cell)
    }

    /// Returns the example levels, if there are any.
    pub(crate) fn examples(&self) -> Option<&Examples> {
        self.config.like.as_deref()
    }

    /// Returns the weight of a cell for a sprite of the type, according to the positions of such sprites in the
    /// examples.
    pub(crate) fn example_weight(&self, cell: usize, stype: SpriteType) -> u32 {
        let (Some(examples), Some(target)) = (self.examples(), &self.target) else { return 1 };
        let grid = self.board.grid;
        let placement = examples.placement(stype);
        let mut weight = placement.weigh(grid, &self.board.wall, cell, &examples.nooks, target.model);
        for (way, other) in placement.companions() {
            if grid.shift(cell, way).is_some_and(|next| self.log.contains(&(next, other))) {
                weight = weight.saturating_mul(COMPANION_WEIGHT);
            }
        }
        // Sprites already on the board may need this sprite next to them.
        for &(there, kind) in &self.log {
            let wants = |&(way, other): &((i32, i32), SpriteType)| {
                other == stype && grid.shift(there, way) == Some(cell)
            };
            if examples.placement(kind).companions().any(|companion| wants(&companion)) {
                weight = weight.saturating_mul(COMPANION_WEIGHT);
            }
        }
        if placement.is_lined_up() {
            let in_row =
                |&(other, kind): &(usize, SpriteType)| kind == stype && grid.y(other) == grid.y(cell);
            if self.log.iter().any(in_row) {
                weight = weight.saturating_mul(LINE_WEIGHT);
            }
        }
        weight
    }

    /// Returns the types that the level should contain according to the examples, if there are any.
    pub(crate) fn expected(&self) -> Vec<SpriteType> {
        let Some(target) = &self.target else { return Vec::new() };
        self.analysis.game().sprite_types().filter(|stype| target.counts[stype.index()].0 > 0).collect()
    }

    /// Decides at random whether a sprite must stand next to another sprite of its type, with the probability found in
    /// the examples. Returns `None` if the position does not matter.
    pub(crate) fn draw_group(&mut self, stype: SpriteType) -> Option<bool> {
        let share = self.examples()?.placement(stype).grouped();
        let first = self.log.iter().all(|(_, kind)| *kind != stype);
        (!first).then(|| self.sampler.unit() < 0.8 * share)
    }

    /// Returns the mirror image of the cell from left to right, if it is free and sprites of the type occur in mirrored
    /// pairs in the examples.
    pub(crate) fn twin(&self, cell: usize, stype: SpriteType) -> Option<usize> {
        self.examples().filter(|examples| examples.placement(stype).is_mirrored())?;
        let grid = self.board.grid;
        let twin = grid.at(grid.columns - 1 - grid.x(cell), grid.y(cell));
        (self.fits(twin, stype) && !self.cuts(twin, stype)).then_some(twin)
    }

    /// Decides the number of sprites of each type, from the configuration and from either the types' roles or the
    /// examples.
    pub(crate) fn wishes(&mut self) -> Vec<Wish> {
        let (analysis, palette) = (self.analysis, self.palette);
        let (area, difficulty) = (self.board.area(), self.difficulty());
        let mut wishes = match &self.target {
            Some(target) => plan::wishes_like(analysis, palette, target, area, difficulty, &mut self.sampler),
            None => plan::wishes(analysis, palette, area, difficulty, &mut self.sampler),
        };
        for &(stype, count) in &self.config.counts {
            match wishes.iter_mut().find(|wish| wish.stype == stype) {
                Some(wish) => wish.count = count,
                None if palette.symbol(stype).is_some() => {
                    wishes.push(Wish { stype, role: analysis.role(stype), count });
                }
                None => {}
            }
        }
        wishes
    }

    /// Returns `true` if the avatar falls, so that most sprites should stand on the ground.
    pub(crate) fn avatar_falls(&self) -> bool {
        self.analysis.start_avatar().is_some_and(|avatar| avatar.steering == Steering::Jumping)
    }

    /// Returns `true` if there is support directly below the cell.
    pub(crate) fn has_footing(&self, cell: usize) -> bool {
        self.board.grid.shift(cell, (0, 1)).is_none_or(|below| self.board.wall[below])
    }

    pub(crate) fn difficulty(&self) -> f64 {
        self.config.difficulty
    }

    pub(crate) fn role(&self, stype: SpriteType) -> Role {
        self.analysis.role(stype)
    }

    /// Returns the number of steps from the avatar's start to each cell.
    pub(crate) fn steps(&self) -> Vec<u32> {
        self.board.steps(self.palette)
    }

    /// Returns the distance in cells, ignoring obstacles, to the nearest sprite accepted by `like`, or a large number
    /// if there is no such sprite.
    pub(crate) fn apart(&self, cell: usize, like: impl Fn(SpriteType) -> bool) -> usize {
        let distances = self.log.iter().filter(|(_, stype)| like(*stype));
        distances.map(|(other, _)| self.board.grid.manhattan(cell, *other)).min().unwrap_or(99)
    }

    /// Returns the distance in cells, ignoring obstacles, to the nearest sprite with the given role, or a large number
    /// if there is no such sprite.
    pub(crate) fn apart_from(&self, cell: usize, role: Role) -> usize {
        self.apart(cell, |stype| self.analysis.role(stype) == role)
    }

    /// Returns `true` if a sprite of the type in the given cell would be an obstacle that cuts off other cells.
    pub(crate) fn cuts(&self, cell: usize, stype: SpriteType) -> bool {
        let in_the_way = self
            .palette
            .symbol(stype)
            .is_some_and(|symbol| !matches!(self.palette.walk(symbol), Walk::Open | Walk::Breakable));
        in_the_way && self.board.would_cut(self.palette, cell)
    }

    /// Returns the number of cells ahead of `cell` in the given direction before the next wall or obstacle.
    pub(crate) fn run(&self, cell: usize, way: (i32, i32)) -> usize {
        let mut length = 0;
        let mut at = cell;
        while let Some(next) = self.board.grid.shift(at, way) {
            let blocked = self.board.wall[next]
                || self.board.placed[next].is_some_and(|symbol| {
                    matches!(self.palette.walk(symbol), Walk::Blocked | Walk::Locked(_) | Walk::Pushed)
                });
            if blocked {
                break;
            }
            length += 1;
            at = next;
        }
        length
    }

    /// Returns `true` if the avatar's start is ahead of `cell` in the given direction, with no obstacle in between.
    pub(crate) fn aims_at_start(&self, cell: usize, way: (i32, i32)) -> bool {
        let (dx, dy) = self.board.grid.offset(cell, self.board.start);
        let ahead = if way.0 != 0 { dy == 0 && dx * way.0 > 0 } else { dx == 0 && dy * way.1 > 0 };
        ahead && self.run(cell, way) >= (dx.abs() + dy.abs()) as usize
    }

    /// Returns the direction in which sprites of the type move straight ahead or shoot by themselves.
    pub(crate) fn heading(&self, stype: SpriteType) -> Option<(i32, i32)> {
        if let Motion::Straight(direction) = self.analysis.facts(stype).motion {
            return way(direction);
        }
        self.analysis.launches(stype).and_then(|(_, direction)| way(direction))
    }

    /// Returns the minimum distance in cells between the avatar's start and a sprite that can harm the avatar.
    pub(crate) fn min_distance(&self, stype: SpriteType) -> usize {
        let facts = self.analysis.facts(stype);
        let near = match facts.motion {
            Motion::Still => 2.0,
            Motion::Chasing(_) => 3.0 + 11.0 * facts.pace,
            Motion::Straight(_) => 4.0,
            _ => 3.0 + 4.0 * facts.pace,
        };
        // Difficulty changes the distance by at most a tenth, so that hard levels stay fair.
        let near = near * (1.1 - 0.2 * self.difficulty());
        let room = (self.board.grid.columns + self.board.grid.rows) as f64 * 0.45;
        near.min(room) as usize
    }

    /// Returns the largest number of steps to any reachable cell.
    pub(crate) fn radius(&self, steps: &[u32]) -> u32 {
        steps.iter().copied().filter(|&steps| steps != FAR).max().unwrap_or(0).max(1)
    }
}

/// Converts an axis direction to a step.
pub(crate) fn way(direction: Direction) -> Option<(i32, i32)> {
    WAYS.into_iter().find(|&(x, y)| direction == Direction { x: f64::from(x), y: f64::from(y) })
}

/// Returns the opposite direction.
pub(crate) fn back((x, y): (i32, i32)) -> (i32, i32) {
    (-x, -y)
}
