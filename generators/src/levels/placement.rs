//! The placement of one type's sprites in the examples: board region, nook, neighbours and order.

use super::grid::{Grid, WAYS};
use engine::{Game, SpriteType};
use std::collections::BTreeMap;

/// The number of bands into which a board is divided in each direction.
const BANDS: usize = 5;
/// The weight of a cell about which the statistics say nothing.
pub(crate) const USUAL: u32 = 16;
/// The number of classes of wall arrangements next to a cell; see [`nook`].
pub(crate) const NOOKS: usize = 6;

/// Statistics on the positions of one type's sprites.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Placement {
    seen: usize,
    bands: Bands,
    /// The number of sprites in each band, for each example separately.
    each: Vec<Bands>,
    /// The number of sprites on the border of closed boards, by side, in [`WAYS`] order.
    sides: [usize; 4],
    nooks: [usize; NOOKS],
    /// The number of neighbours, by direction (an index into [`WAYS`]) and type.
    beside: BTreeMap<(usize, SpriteType), usize>,
    /// The directions and types, as in `beside`, that almost always occur next to the type.
    companions: Vec<(usize, SpriteType)>,
    /// The number of sprites whose left-right mirror cell contains a sprite of the same type.
    mirrored: usize,
    /// The number of sprites next to a sprite of the same type.
    grouped: usize,
    /// The number of boards with at least three sprites of the type.
    crowds: usize,
    /// The number of rows with sprites of the type, on the boards counted in `crowds`.
    rows: usize,
}

/// The number of sprites in each board band.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Bands {
    /// The number of sprites in each vertical band, from left to right.
    across: [usize; BANDS],
    /// The number of sprites in each horizontal band, from top to bottom.
    down: [usize; BANDS],
}

impl Bands {
    fn see(&mut self, grid: Grid, cell: usize) {
        self.across[band(grid.x(cell), grid.columns)] += 1;
        self.down[band(grid.y(cell), grid.rows)] += 1;
    }

    /// Returns a cell's weight. The average weight is 1.0.
    fn weigh(&self, grid: Grid, cell: usize) -> f64 {
        let share = |counts: &[usize; BANDS], at: usize| {
            let seen: usize = counts.iter().sum();
            (counts[at] as f64 + 0.3) * BANDS as f64 / (seen as f64 + 0.3 * BANDS as f64)
        };
        share(&self.across, band(grid.x(cell), grid.columns))
            * share(&self.down, band(grid.y(cell), grid.rows))
    }
}

/// An example level, with the data for recording its sprites.
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

impl Placement {
    /// Records all sprites of a type in one example.
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

    /// Derives the companions, which are types that almost always stand next to each other. Must be called after all
    /// examples have been recorded. `total` counts the sprites of a type in all `cells`, and `plain` selects types that
    /// occur everywhere.
    pub(crate) fn conclude(
        &mut self,
        cells: usize,
        total: &dyn Fn(SpriteType) -> usize,
        plain: impl Fn(SpriteType) -> bool,
    ) {
        let seen = self.seen;
        let telling = |&(&(_, other), &count): &(&(usize, SpriteType), &usize)| {
            // A companion (a type that stands next to another type) must occur at least four times out of five, and
            // much more often than expected by chance. The margin is larger if there are few samples.
            let lift = if seen >= 3 { 3 } else { 10 };
            count * 5 >= seen * 4 && count * cells >= lift * total(other) * seen && !plain(other)
        };
        self.companions = self.beside.iter().filter(telling).map(|(companion, _)| *companion).collect();
        self.beside.clear();
    }

    /// Returns the types that almost always stand next to sprites of this type, with their directions.
    pub(crate) fn companions(&self) -> impl Iterator<Item = ((i32, i32), SpriteType)> + '_ {
        self.companions.iter().map(|&(at, stype)| (WAYS[at], stype))
    }

    /// Returns a cell's weight according to the positions of this type's sprites in the examples. The average weight
    /// is [`USUAL`]. The weight is never 0, because there are few examples. `nooks` contains the frequencies of nooks
    /// among open cells, and `model` is the example that the board follows.
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
        // The positions of different types are often correlated, so the example `model` counts most, and the others
        // count a little.
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

    /// Returns the average vertical position of this type's sprites, from 0.0 (top) to 1.0 (bottom); `None` if there
    /// are no such sprites.
    pub(crate) fn height(&self) -> Option<f64> {
        let sum: usize = self.bands.down.iter().enumerate().map(|(band, count)| band * count).sum();
        (self.seen > 0).then(|| sum as f64 / (self.seen * (BANDS - 1)) as f64)
    }

    /// Returns the number of this type's sprites that are set into the surrounding wall on the same side of the board
    /// as the cell.
    pub(crate) fn on_border(&self, grid: Grid, cell: usize) -> u32 {
        side(grid, cell).map_or(0, |side| self.sides[side] as u32)
    }

    /// Returns `true` if most of this type's sprites are set into the walls around the board.
    pub(crate) fn is_on_border(&self) -> bool {
        self.sides.iter().sum::<usize>() * 2 > self.seen
    }

    /// Returns `true` if this type's sprites stand in niches, with walls on three sides.
    pub(crate) fn is_in_niches(&self) -> bool {
        self.nooks[NICHE] * 10 >= self.seen * 8 && self.seen > 0
    }

    /// Returns `true` if sprites of this type stand in pairs that mirror each other from left to right.
    pub(crate) fn is_mirrored(&self) -> bool {
        self.mirrored >= 4 && self.mirrored * 10 >= self.seen * 7
    }

    /// Returns `true` if this type's sprites stand in one or two rows.
    pub(crate) fn is_lined_up(&self) -> bool {
        self.crowds > 0 && self.rows <= 2 * self.crowds
    }

    /// Returns the fraction of sprites next to a sprite of the same type.
    pub(crate) fn grouped(&self) -> f64 {
        self.grouped as f64 / self.seen.max(1) as f64
    }
}

fn band(at: usize, of: usize) -> usize {
    (at * BANDS / of.max(1)).min(BANDS - 1)
}

/// Returns the side of the border on which a cell lies, as an index into [`WAYS`]; `None` for inner cells.
fn side(grid: Grid, cell: usize) -> Option<usize> {
    WAYS.into_iter().position(|way| grid.shift(cell, way).is_none())
}

/// The index of niches among the nooks.
pub(crate) const NICHE: usize = 4;

/// Classifies the number and arrangement of walls next to a cell; board edges count as walls. The classes are none,
/// one, two on opposite sides, two at a corner, three, and four.
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
