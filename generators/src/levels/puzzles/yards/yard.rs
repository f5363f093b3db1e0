//! The board of a yard: its walls, the signs that carts follow, and its other objects.

use crate::games::YardRules;
use crate::levels::grid::{Grid, WAYS};
use base::Sampler;

/// The index of the rightward step in [`WAYS`].
pub(super) const RIGHT: usize = 3;
/// The fraction of the inner cells that are walls.
const WALLS: f64 = 0.14;

/// The minimum number of cart visits at which a cell counts as busy.
const OFTEN: u32 = 6;

/// A sign that turns carts entering its cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sign {
    /// Turns carts in one direction, given as an index into [`WAYS`].
    Fixed(usize),
    /// Turns the first cart in one direction, the next in the opposite direction, and so on.
    Points(usize),
}

impl Sign {
    /// Returns the directions in which carts can leave the sign.
    fn exits(self) -> impl Iterator<Item = usize> {
        let (one, other) = match self {
            Sign::Fixed(way) => (way, None),
            Sign::Points(way) => (way, Some(opposite(way))),
        };
        std::iter::once(one).chain(other)
    }
}

/// Returns the opposite direction.
pub(super) fn opposite(way: usize) -> usize {
    (way + 2) % WAYS.len()
}

/// A cart at its start, where a sign turns it to the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cart {
    pub(super) start: usize,
    /// `true` if the cart takes two ticks per cell.
    pub(super) is_wagon: bool,
}

/// The numbers of objects in a yard.
#[derive(Clone, Copy, Debug)]
pub(super) struct Furniture {
    pub(super) carts: usize,
    pub(super) parcels: usize,
    /// The minimum total length, in steps, of the walks from each parcel to its depot and back.
    pub(super) steps: usize,
}

/// The board of a yard, with a border of walls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Yard {
    pub(super) grid: Grid,
    pub(super) is_floor: Vec<bool>,
    pub(super) signs: Vec<Option<Sign>>,
    pub(super) carts: Vec<Cart>,
    /// The avatar's initial cell.
    pub(super) start: usize,
    /// The cell and the kind of each parcel.
    pub(super) parcels: Vec<(usize, usize)>,
    /// The cells of the depots (destinations of parcels), by kind.
    pub(super) depots: Vec<usize>,
}

impl Yard {
    /// Draws a yard that contains only carts. The carts never run into a wall. Returns `None` if the draw fails.
    pub(super) fn draw(rules: YardRules, grid: Grid, carts: usize, sampler: &mut Sampler) -> Option<Yard> {
        let mut yard = Yard {
            grid,
            is_floor: (0..grid.len()).map(|cell| !grid.on_border(cell)).collect(),
            signs: vec![None; grid.len()],
            carts: Vec::new(),
            start: 0,
            parcels: Vec::new(),
            depots: Vec::new(),
        };
        let walls = (yard.floor().len() as f64 * WALLS).round() as usize;
        grid.wall_off(&mut yard.is_floor, walls, sampler);
        yard.lay_tracks(rules, carts, sampler)?;
        Some(yard)
    }

    fn floor(&self) -> Vec<usize> {
        (0..self.grid.len()).filter(|&cell| self.is_floor[cell]).collect()
    }

    /// Returns the cells ahead of a cell, up to the next wall.
    fn ahead(&self, cell: usize, way: usize) -> Vec<usize> {
        let mut cells = Vec::new();
        let mut at = cell;
        while let Some(next) = self.grid.shift(at, WAYS[way]).filter(|&next| self.is_floor[next]) {
            cells.push(next);
            at = next;
        }
        cells
    }

    /// Places signs such that every exit of a sign leads to a sign.
    fn lay_tracks(&mut self, rules: YardRules, carts: usize, sampler: &mut Sampler) -> Option<()> {
        let most = 3 * carts + 4;
        let mut floor = self.floor();
        sampler.shuffle(&mut floor);
        let mut open = Vec::new();
        for cell in floor {
            if self.carts.len() == carts {
                break;
            }
            if self.ahead(cell, RIGHT).len() >= 2 {
                self.signs[cell] = Some(Sign::Fixed(RIGHT));
                let is_wagon = rules.has_wagons() && self.carts.len() % 3 == 2;
                self.carts.push(Cart { start: cell, is_wagon });
                open.push((cell, RIGHT));
            }
        }
        let mut laid = self.carts.len();
        while let Some((cell, way)) = open.pop() {
            let ahead = self.ahead(cell, way);
            if ahead.iter().any(|&next| self.signs[next].is_some()) {
                continue;
            }
            if laid == most || ahead.is_empty() {
                return None;
            }
            let at = ahead[sampler.between(ahead.len().min(2), ahead.len()) - 1];
            let sign = self.sign(rules, at, way, sampler)?;
            self.signs[at] = Some(sign);
            laid += 1;
            open.extend(sign.exits().map(|exit| (at, exit)));
        }
        (self.carts.len() == carts).then_some(())
    }

    /// Draws a sign for carts travelling in the given direction, preferring signs that lead to existing signs.
    fn sign(&self, rules: YardRules, cell: usize, way: usize, sampler: &mut Sampler) -> Option<Sign> {
        let fixed = (0..WAYS.len()).filter(|&exit| exit != way).map(Sign::Fixed);
        let points = rules.has_points().then_some([Sign::Points(0), Sign::Points(RIGHT)]);
        let signs: Vec<Sign> = fixed.chain(points.into_iter().flatten()).collect();
        let weight = |sign: &Sign| {
            let ways: Vec<Vec<usize>> = sign.exits().map(|exit| self.ahead(cell, exit)).collect();
            if ways.iter().any(Vec::is_empty) {
                return 0;
            }
            let leads = |ahead: &Vec<usize>| ahead.iter().any(|&next| self.signs[next].is_some());
            let closed = ways.iter().filter(|ahead| leads(ahead)).count() as u32;
            let base = match sign {
                Sign::Fixed(exit) if *exit == opposite(way) => 1,
                Sign::Fixed(_) => 4,
                Sign::Points(_) => 9,
            };
            base * (1 + 3 * closed)
        };
        let weights: Vec<u32> = signs.iter().map(weight).collect();
        Some(signs[sampler.weighted(&weights)?])
    }

    /// Places depots, the avatar, and parcels far from their depots, preferably in cells that carts visit often.
    /// `visits` contains the number of cart visits per cell.
    pub(super) fn furnish(
        &mut self,
        rules: YardRules,
        furniture: Furniture,
        visits: &[u32],
        sampler: &mut Sampler,
    ) -> Option<()> {
        let mut free: Vec<usize> =
            self.floor().into_iter().filter(|&cell| self.signs[cell].is_none()).collect();
        sampler.shuffle(&mut free);
        free.sort_by_key(|&cell| visits[cell] < OFTEN);
        for _ in 0..rules.kinds() {
            // Among a few drawn cells, use the cell farthest from the middle.
            let middle = self.grid.at(self.grid.columns / 2, self.grid.rows / 2);
            let far = (0..free.len().min(4)).max_by_key(|&at| self.grid.manhattan(middle, free[at]))?;
            self.depots.push(free.remove(far));
        }
        self.start = free.pop()?;
        let mut missing = furniture.steps;
        for number in 0..furniture.parcels {
            let kind = number % rules.kinds();
            let steps = self.grid.flood(&[self.depots[kind]], |cell| self.is_floor[cell]);
            // The target distance is the mean of the missing steps, or slightly more.
            let mean = missing.div_ceil(2 * (furniture.parcels - number)) as u32;
            let fits = |cell: &usize| (mean..mean + 3).contains(&steps[*cell]);
            let at = free.iter().position(fits)?;
            let cell = free.remove(at);
            missing = missing.saturating_sub(2 * steps[cell] as usize);
            self.parcels.push((cell, kind));
        }
        Some(())
    }
}
