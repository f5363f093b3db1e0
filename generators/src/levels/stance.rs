//! Where sprites of one type stand in examples: in which part of the board, in what kind of nook, beside what, in what order.

use super::grid::{Grid, WAYS};
use engine::{Game, SpriteType};
use std::collections::BTreeMap;

/// Parts into which a board is divided each way.
const BANDS: usize = 5;
/// The weight of a cell to which nothing speaks for or against.
pub(crate) const USUAL: u32 = 16;
/// Ways in which walls can lie beside a cell: see [`nook`].
pub(crate) const NOOKS: usize = 6;

/// Where sprites of one type stand.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Stance {
    seen: usize,
    bands: Bands,
    /// The same in each example by itself.
    each: Vec<Bands>,
    /// On the border of closed boards, by its side, in the order of [`WAYS`].
    sides: [usize; 4],
    nooks: [usize; NOOKS],
    /// What stands beside them, in which direction, by its place in [`WAYS`].
    beside: BTreeMap<(usize, SpriteType), usize>,
    /// Of `beside`, what is hardly ever missing.
    companions: Vec<(usize, SpriteType)>,
    /// How many have another one in the same place on the other side, left and right.
    mirrored: usize,
    /// How many have another one right beside them.
    grouped: usize,
    /// Boards with at least three of them, and rows that they stand in there.
    crowds: usize,
    rows: usize,
}

/// How many stand in which part of the board.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bands {
    /// From left to right.
    across: [usize; BANDS],
    /// From top to bottom.
    down: [usize; BANDS],
}

impl Bands {
    fn see(&mut self, grid: Grid, cell: usize) {
        self.across[band(grid.x(cell), grid.columns)] += 1;
        self.down[band(grid.y(cell), grid.rows)] += 1;
    }

    /// How well a cell agrees; 1.0 on the mean.
    fn weigh(&self, grid: Grid, cell: usize) -> f64 {
        let share = |counts: &[usize; BANDS], at: usize| {
            let seen: usize = counts.iter().sum();
            (counts[at] as f64 + 0.3) * BANDS as f64 / (seen as f64 + 0.3 * BANDS as f64)
        };
        share(&self.across, band(grid.x(cell), grid.columns))
            * share(&self.down, band(grid.y(cell), grid.rows))
    }
}

/// An example.
pub(crate) struct Scene<'a> {
    pub(crate) grid: Grid,
    pub(crate) wall: &'a [bool],
    pub(crate) closed: bool,
    pub(crate) game: &'a Game,
    pub(crate) cells: &'a [u8],
}

impl Scene<'_> {
    fn holds(&self, cell: usize, stype: SpriteType) -> bool {
        self.game.places(self.cells[cell]).contains(&stype)
    }
}

impl Stance {
    /// Looks at all sprites of a type in one example.
    pub(crate) fn see(&mut self, scene: &Scene<'_>, stype: SpriteType) {
        let grid = scene.grid;
        let cells: Vec<usize> = (0..grid.len()).filter(|&cell| scene.holds(cell, stype)).collect();
        let mut own = Bands::default();
        let mut rows: Vec<usize> = cells.iter().map(|&cell| grid.y(cell)).collect();
        rows.dedup();
        if cells.len() >= 3 {
            self.rows += rows.len();
            self.crowds += 1;
        }
        for cell in cells {
            self.seen += 1;
            self.bands.see(grid, cell);
            own.see(grid, cell);
            self.grouped += usize::from(grid.beside(cell).any(|next| scene.holds(next, stype)));
            if let Some(side) = side(grid, cell).filter(|_| scene.closed) {
                self.sides[side] += 1;
            }
            self.nooks[nook(grid, scene.wall, cell)] += 1;
            for (at, way) in WAYS.into_iter().enumerate() {
                let Some(next) = grid.shift(cell, way) else { continue };
                for &other in scene.game.places(scene.cells[next]) {
                    *self.beside.entry((at, other)).or_default() += 1;
                }
            }
            let across = grid.at(grid.columns - 1 - grid.x(cell), grid.y(cell));
            self.mirrored += usize::from(scene.holds(across, stype) && across != cell);
        }
        self.each.push(own);
    }

    /// After all examples: what is beside them for a reason. `total` counts sprites in all `cells`; `plain` are types that are
    /// everywhere.
    pub(crate) fn conclude(
        &mut self,
        cells: usize,
        total: &dyn Fn(SpriteType) -> usize,
        plain: impl Fn(SpriteType) -> bool,
    ) {
        let seen = self.seen;
        let telling = |&(&(_, other), &count): &(&(usize, SpriteType), &usize)| {
            // Four of five times, and much more often than by chance: the fewer were seen, the more.
            let lift = if seen >= 3 { 3 } else { 10 };
            count * 5 >= seen * 4 && count * cells >= lift * total(other) * seen && !plain(other)
        };
        self.companions = self.beside.iter().filter(telling).map(|(companion, _)| *companion).collect();
        self.beside.clear();
    }

    /// What is hardly ever missing beside such a sprite, with the direction in which it stands.
    pub(crate) fn companions(&self) -> impl Iterator<Item = ((i32, i32), SpriteType)> + '_ {
        self.companions.iter().map(|&(at, stype)| (WAYS[at], stype))
    }

    /// How well a cell agrees with where the examples have such sprites; [`USUAL`] on the mean. Never 0: examples are few.
    /// `nooks`: how common the nooks are among open cells; `model`: the example that the board takes after.
    pub(crate) fn weigh(
        &self,
        grid: Grid,
        wall: &[bool],
        cell: usize,
        nooks: &[usize; NOOKS],
        model: usize,
    ) -> u32 {
        if self.seen == 0 {
            return USUAL;
        }
        // Where one thing stands often says where another does: mostly as in the one example, a little as in all.
        let own = self.each[model];
        let place = if own == Bands::default() { self.bands } else { own }.weigh(grid, cell) * 0.7
            + self.bands.weigh(grid, cell) * 0.3;
        let all: usize = nooks.iter().sum();
        let at = nook(grid, wall, cell);
        let own = (self.nooks[at] as f64 + 0.5) / (self.seen as f64 + 3.0);
        let usual = (nooks[at] as f64 + 0.5) / (all as f64 + 3.0);
        let lift = (own / usual).clamp(0.05, 10.0);
        ((f64::from(USUAL) * place * lift) as u32).max(1)
    }

    /// Where they stand on the mean, from the top at 0.0 to the bottom at 1.0; None if there are none.
    pub(crate) fn height(&self) -> Option<f64> {
        let sum: usize = self.bands.down.iter().enumerate().map(|(band, count)| band * count).sum();
        (self.seen > 0).then(|| sum as f64 / (self.seen * (BANDS - 1)) as f64)
    }

    /// How often such sprites are let into the walls on the side of the board that a cell is on.
    pub(crate) fn on_border(&self, grid: Grid, cell: usize) -> u32 {
        side(grid, cell).map_or(0, |side| self.sides[side] as u32)
    }

    /// Whether most such sprites are let into the walls around the board.
    pub(crate) fn is_on_border(&self) -> bool {
        self.sides.iter().sum::<usize>() * 2 > self.seen
    }

    /// Whether such sprites stand in niches, walls on three sides.
    pub(crate) fn is_in_niches(&self) -> bool {
        self.nooks[NICHE] * 10 >= self.seen * 8 && self.seen > 0
    }

    /// Whether such sprites stand in pairs, left and right.
    pub(crate) fn is_mirrored(&self) -> bool {
        self.mirrored >= 4 && self.mirrored * 10 >= self.seen * 7
    }

    /// Whether such sprites stand in one row or two.
    pub(crate) fn is_lined_up(&self) -> bool {
        self.crowds > 0 && self.rows <= 2 * self.crowds
    }

    /// The share of them that have another one right beside them.
    pub(crate) fn grouped(&self) -> f64 {
        self.grouped as f64 / self.seen.max(1) as f64
    }
}

fn band(at: usize, of: usize) -> usize {
    (at * BANDS / of.max(1)).min(BANDS - 1)
}

/// The side of the border that a cell is on, in the order of [`WAYS`].
fn side(grid: Grid, cell: usize) -> Option<usize> {
    WAYS.into_iter().position(|way| grid.shift(cell, way).is_none())
}

/// The index of niches among nooks.
pub(crate) const NICHE: usize = 4;

/// How walls, or the edge, lie beside a cell: none, one, two opposite, two at a corner, three, all around.
pub(crate) fn nook(grid: Grid, wall: &[bool], cell: usize) -> usize {
    let [up, left, down, right] = WAYS.map(|way| grid.shift(cell, way).is_none_or(|next| wall[next]));
    match u8::from(up) + u8::from(left) + u8::from(down) + u8::from(right) {
        0 => 0,
        1 => 1,
        2 if up == down => 2,
        2 => 3,
        3 => NICHE,
        _ => 5,
    }
}
