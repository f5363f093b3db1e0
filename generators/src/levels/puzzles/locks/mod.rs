//! Lock puzzles that meet a target: long sequences of keys, doors and planks, with tempting wrong sequences.

mod layout;
mod walk;

use crate::games::LockRules;
use crate::levels::grid::{ACTIONS, Grid};
use crate::{Annealing, AnnealingConfig, Evaluation, Search};
use base::Seed;
use engine::Action;
use layout::{Furniture, Layout, Layouts, Tile};
use walk::Walk;

base::with_defaults! {
    /// The configuration of lock puzzles.
    #[derive(Clone, Debug, PartialEq)]
    pub struct LockConfig {
        /// The minimum and maximum number of columns.
        pub columns: (usize, usize) = (10, 11),
        /// The minimum and maximum number of rows.
        pub rows: (usize, usize) = (10, 11),
        /// The minimum number of actions in a shortest win.
        pub decisions: usize = 60,
        /// The minimum fraction of dead ends among the states that are one step off the shortest win. A dead end is a
        /// state from which no win exists.
        pub dead_ends: f64 = 0.05,
        /// The maximum number of layouts to examine per level.
        pub layouts: usize = 20_000,
    }
}

/// The maximum number of states per layout, which keeps an exhaustive search of the level feasible.
const MOST_STATES: usize = 15_000;
/// The number of layouts to request at a time. They are then rated one by one.
const BATCH: usize = 8;
/// The number of inner cells on a board of typical size, for which [`furniture`] returns the default numbers of items.
const USUAL: f64 = 64.0;

/// A lock puzzle with a winning sequence of actions. Its text uses the level characters of [`LockRules::game`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LockLevel {
    /// The level, as text.
    pub text: String,
    /// A win with the minimum number of actions.
    pub solution: Vec<Action>,
}

impl LockConfig {
    /// Generates the level for a seed. Layouts are annealed until an exhaustive search shows that one meets the target.
    /// Returns `None` if no layout does. Cost: about a millisecond per layout.
    pub fn level(&self, rules: LockRules, seed: Seed) -> Option<LockLevel> {
        let mut sampler = seed.child("size", 0).sampler();
        let mut side = |(least, most): (usize, usize)| sampler.between(least, most.max(least));
        let grid = Grid { columns: side(self.columns), rows: side(self.rows) };
        let layouts = Layouts { grid, furniture: furniture(rules, grid) };
        let config = AnnealingConfig::of(self.layouts);
        let mut search = Annealing::new(&layouts, config, seed.child("layouts", 0));
        loop {
            let asked = search.ask(BATCH);
            if asked.is_empty() {
                return None;
            }
            let rated: Vec<(Layout, Evaluation)> = asked
                .into_iter()
                .map(|layout| {
                    let rated = self.rate(&layout);
                    (layout, rated)
                })
                .collect();
            if let Some((layout, _)) = rated.iter().find(|(_, rated)| rated.objective >= 1.0) {
                let walk = Walk::of(layout, MOST_STATES)?;
                return Some(LockLevel {
                    text: text(layout),
                    solution: walk.ways.iter().map(|&way| ACTIONS[way]).collect(),
                });
            }
            search.tell(rated);
        }
    }

    /// Rates a layout. A rating of 1 means that the layout meets the target.
    fn rate(&self, layout: &Layout) -> Evaluation {
        let Some(walk) = Walk::of(layout, MOST_STATES) else {
            return Evaluation { feasibility: 0.5, objective: 0.0, measures: Vec::new() };
        };
        let long = (walk.ways.len() as f64 / self.decisions.max(1) as f64).min(1.0);
        let dead = (walk.dead_share() / self.dead_ends.max(1e-9)).min(1.0);
        Evaluation { feasibility: 1.0, objective: 0.8 * long + 0.2 * dead, measures: Vec::new() }
    }
}

/// Returns the numbers of items for a board of the given size.
fn furniture(rules: LockRules, grid: Grid) -> Furniture {
    let share = ((grid.columns - 2) * (grid.rows - 2)) as f64 / USUAL;
    let of = |number: f64| (number * share).round() as usize;
    Furniture {
        kinds: rules.kinds(),
        locks: of(if rules.kinds() == 1 { 6.0 } else { 4.0 }),
        planks: if rules.has_planks() { of(6.0) } else { 0 },
        goals: if rules.has_gems() { 3 } else { 1 },
    }
}

fn text(layout: &Layout) -> String {
    let symbol = |cell: usize| match layout.tiles[cell] {
        _ if cell == layout.start => LockRules::AVATAR,
        Tile::Floor => LockRules::FLOOR,
        Tile::Wall => LockRules::WALL,
        Tile::Plank => LockRules::PLANK,
        Tile::Key(kind) => LockRules::KEYS[kind],
        Tile::Door(kind) => LockRules::DOORS[kind],
        Tile::Goal => LockRules::GOAL,
    };
    let row = |row: usize| -> String {
        (0..layout.grid.columns).map(|column| symbol(layout.grid.at(column, row))).collect()
    };
    (0..layout.grid.rows).map(|at| row(at) + "\n").collect()
}
