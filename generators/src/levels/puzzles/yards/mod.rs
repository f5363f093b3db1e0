//! Yards, which are puzzles about carrying parcels, generated to meet a target. The player carries parcels past carts
//! whose paths must be predicted, with little time to spare.

mod timetable;
mod yard;

use super::fuse;
use crate::games::YardRules;
use crate::levels::grid::{ACTIONS, Grid};
use base::Seed;
use engine::Action;
use timetable::Timetable;
use yard::{Furniture, Sign, Yard};

base::with_defaults! {
    /// The configuration for yards, in which the avatar carries parcels past moving carts.
    #[derive(Clone, Debug, PartialEq)]
    pub struct YardConfig {
        /// The minimum and maximum number of columns.
        pub columns: (usize, usize) = (11, 12),
        /// The minimum and maximum number of rows, including the row of the fuse that limits the time.
        pub rows: (usize, usize) = (11, 12),
        /// The range of the number of key presses in a fastest win. The upper end is exclusive.
        pub decisions: (usize, usize) = (50, 120),
        /// The number of carts on a board of typical size.
        pub carts: usize = 4,
        /// The minimum fraction of the win's ticks from which staying in place for ten ticks would be fatal.
        pub exposure: f64 = 0.2,
        /// The maximum number of yards to draw per level.
        pub yards: u64 = 2_000,
    }
}

/// The minimum side length of a board, in cells, including the row of the fuse (the time limit). Smaller boards have no
/// room for tracks.
const LEAST_SIDE: usize = 6;
/// The number of inner cells on a board of typical size, which gets the configured number of carts.
const USUAL: f64 = 80.0;
/// The waiting time, in ticks, to which [`YardConfig::exposure`] refers.
const WAIT: usize = 10;
/// The number of ticks in the fastest win per spare tick.
const DETOURS: usize = 6;
/// The maximum number of carts. Prompts list the directions of at most that many sprites per type.
const CARTS: usize = 8;
/// The maximum number of parcels. Each parcel doubles the time of the win search.
const PARCELS: usize = 6;
/// The number of attempts to place sprites on each layout of tracks.
const FURNISHED: usize = 4;
/// The maximum length of a fastest win in ticks, as a multiple of the number of steps that it would take without carts.
const DELAY: f64 = 1.5;

/// A yard (a puzzle about carrying parcels) with a winning sequence of actions. Its text uses the level characters of
/// [`YardRules::game`].
#[derive(Clone, Debug, PartialEq)]
pub struct YardLevel {
    /// The level, as text.
    pub text: String,
    /// The actions that win in the minimum number of ticks.
    pub solution: Vec<Action>,
}

impl YardConfig {
    /// Generates the level for a seed, by drawing yards until one meets the target. Returns `None` if all drawn yards
    /// miss the target, or if a side has fewer than 6 cells. Cost: a hundredth of a second per yard whose carts run
    /// without conflict.
    pub fn level(&self, rules: YardRules, seed: Seed) -> Option<YardLevel> {
        let mut sampler = seed.child("size", 0).sampler();
        let mut side = |(least, most): (usize, usize)| sampler.between(least, most.max(least));
        let (columns, rows) = (side(self.columns), side(self.rows));
        if columns.min(rows) < LEAST_SIDE {
            return None;
        }
        // The fuse has its own row.
        let grid = Grid { columns, rows: rows - 1 };
        (0..self.yards).find_map(|draw| self.draw(rules, grid, seed.child("yard", draw)))
    }

    fn draw(&self, rules: YardRules, grid: Grid, seed: Seed) -> Option<YardLevel> {
        let furniture = self.furniture(rules, grid);
        let mut sampler = seed.sampler();
        let tracks = Yard::draw(rules, grid, furniture.carts, &mut sampler)?;
        let ticks = (furniture.steps as f64 * DELAY) as usize + YardRules::BURN + WAIT;
        let timetable = Timetable::of(&tracks, ticks)?;
        (0..FURNISHED).find_map(|_| {
            let mut yard = tracks.clone();
            yard.furnish(rules, furniture, &timetable.visits, &mut sampler)?;
            self.finish(&yard, &timetable)
        })
    }

    /// Turns a yard into a level, if it meets the target.
    fn finish(&self, yard: &Yard, timetable: &Timetable) -> Option<YardLevel> {
        // The time limit set by the longest fuse.
        let most = YardRules::BURN * (yard.grid.columns - 1) - 1;
        let (ways, cells) = timetable.fastest(yard, most)?;
        let decisions = ways.iter().flatten().count();
        if !(self.decisions.0..self.decisions.1).contains(&decisions)
            || timetable.exposure(&cells, WAIT) < self.exposure
        {
            return None;
        }
        // The keg explodes in the tick in which the last cell of the fuse burns down.
        let fuse = (ways.len() + ways.len() / DETOURS).div_ceil(YardRules::BURN).min(yard.grid.columns - 1);
        let action = |way: Option<usize>| way.map_or(Action::Nil, |way| ACTIONS[way]);
        Some(YardLevel { text: text(yard, fuse), solution: ways.into_iter().map(action).collect() })
    }

    /// Returns the numbers of objects for a board of the given size.
    fn furniture(&self, rules: YardRules, grid: Grid) -> Furniture {
        let inner = (grid.columns - 2) * (grid.rows - 2);
        let carts = (self.carts as f64 * inner as f64 / USUAL).round().max(1.0) as usize;
        // If there are more kinds of depots (destinations of parcels), the avatar takes fewer steps without a load.
        let steps = self.decisions.0.max(8) * (2 + rules.kinds()) / 3;
        // Parcels and their depots are about half of the board's perimeter apart.
        let way = grid.columns + grid.rows - 6;
        let parcels = steps.div_ceil(way).clamp(1, PARCELS);
        Furniture { carts: carts.min(CARTS), parcels, steps }
    }
}

/// Returns a level with a fuse of `length` cells.
fn text(yard: &Yard, length: usize) -> String {
    let symbol = |cell: usize| {
        if let Some(cart) = yard.carts.iter().find(|cart| cart.start == cell) {
            return YardRules::CARTS[usize::from(cart.is_wagon)];
        }
        if let Some((_, kind)) = yard.parcels.iter().find(|(at, _)| *at == cell) {
            return YardRules::PARCELS[*kind];
        }
        if let Some(kind) = yard.depots.iter().position(|&at| at == cell) {
            return YardRules::DEPOTS[kind];
        }
        match yard.signs[cell] {
            _ if cell == yard.start => YardRules::AVATAR,
            Some(Sign::Fixed(way)) => YardRules::SIGNS[way],
            Some(Sign::Points(way)) => YardRules::POINTS[usize::from(way != 0)],
            None if yard.is_floor[cell] => YardRules::FLOOR,
            None => YardRules::WALL,
        }
    };
    let columns = yard.grid.columns;
    let first = fuse::row(columns, length, &YardRules::FUSE_SYMBOLS);
    let row =
        |row: usize| (0..columns).map(|column| symbol(yard.grid.at(column, row))).collect::<String>() + "\n";
    std::iter::once(first).chain((0..yard.grid.rows).map(row)).collect()
}
