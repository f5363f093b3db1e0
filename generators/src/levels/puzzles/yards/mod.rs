//! Yards, which are puzzles about carrying parcels, generated to meet a target. The player carries parcels past carts
//! whose paths must be predicted, with little time to spare.

mod timetable;
mod yard;

use super::fuse;
use super::lookout::{ACTIONS, Lookout, Strays};
use crate::games::YardRules;
use crate::levels::grid::Grid;
use base::{Sampler, Seed};
use engine::Action;
use timetable::{Errands, Timetable};
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
        /// The minimum and maximum number of wandering deadly sprites. A level gets the largest number that keeps it
        /// fair.
        pub strays: (usize, usize) = (4, 10),
        /// The minimum fraction of the win's ticks from which staying in place for ten ticks would be fatal.
        pub exposure: f64 = 0.2,
        /// The minimum fraction of episodes won by a simulated player that looks at the board before every action.
        pub fairness: f64 = 0.4,
        /// The commitments for which the simulated player's win rate is measured. A commitment is the number of ticks
        /// between two looks at the board.
        pub commitments: Vec<usize> = Vec::new(),
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
/// The number of episodes played by the simulated player per fairness test.
const PLAYS: usize = 40;
/// The number of episodes played by the simulated player per measured commitment.
const MEASURED: usize = 200;
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
    /// The actions that win in the minimum number of ticks if no wandering sprite gets in the way.
    pub solution: Vec<Action>,
    /// The fraction of episodes won by a simulated player, for each commitment in the configuration.
    pub chances: Vec<f64>,
}

impl YardConfig {
    /// Generates the level for a seed, by drawing yards until one meets the target. Returns `None` if all drawn yards
    /// miss the target, or if a side has fewer than 6 cells. Cost: a hundredth of a second per yard whose carts run
    /// without conflict, and up to a second more for each yard that meets the rest of the target.
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
            self.finish(yard, &timetable, &mut sampler)
        })
    }

    /// Turns a yard into a level, if it meets the target.
    fn finish(&self, mut yard: Yard, timetable: &Timetable, sampler: &mut Sampler) -> Option<YardLevel> {
        // The time limit set by the longest fuse.
        let most = YardRules::BURN * (yard.grid.columns - 1) - 1;
        let (ways, cells) = timetable.fastest(&yard, most)?;
        let decisions = ways.iter().flatten().count();
        if !(self.decisions.0..self.decisions.1).contains(&decisions)
            || timetable.exposure(&cells, WAIT) < self.exposure
        {
            return None;
        }
        // The keg explodes in the tick in which the last cell of the fuse burns down.
        let fuse = (ways.len() + ways.len() / DETOURS).div_ceil(YardRules::BURN).min(yard.grid.columns - 1);
        let mut lookout = lookout(&yard, timetable, YardRules::BURN * fuse - 1);
        let (least, most) = self.strays;
        let number = lookout.most_fair(&yard.strays, least..=most, self.fairness, PLAYS, sampler)?;
        let chances =
            self.commitments.iter().map(|&commit| lookout.rate(commit, MEASURED, sampler)).collect();
        yard.strays.truncate(number);
        let action = |way: Option<usize>| way.map_or(Action::Nil, |way| ACTIONS[way]);
        Some(YardLevel { text: text(&yard, fuse), solution: ways.into_iter().map(action).collect(), chances })
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
        Furniture { carts: carts.min(CARTS), parcels, strays: self.strays.1, steps }
    }
}

/// Creates a simulated player for a yard, with a limit of `ticks` ticks.
fn lookout<'a>(yard: &'a Yard, timetable: &'a Timetable, ticks: usize) -> Lookout<Errands<'a>> {
    let strays = Strays {
        grid: yard.grid,
        is_floor: yard.is_floor.clone(),
        cells: yard.strays.clone(),
        cooldown: YardRules::COOLDOWN,
    };
    Lookout::new(strays, Errands::new(yard, timetable), ticks.min(timetable.ticks()))
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
        if yard.strays.contains(&cell) {
            return YardRules::STRAY;
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The simulated player's win rate is the same in the game as in the generator.
    #[test]
    fn plays_among_strays_agree_with_the_game() {
        const FUSE: usize = 6;
        let rules = YardRules::ALL[1];
        let grid = Grid { columns: 11, rows: 10 };
        let furniture = Furniture { carts: 3, parcels: 2, strays: 9, steps: 40 };
        let drawn = |number: u64| {
            let mut sampler = Seed::from_text("lookout").child("yard", number).sampler();
            let mut yard = Yard::draw(rules, grid, furniture.carts, &mut sampler)?;
            let timetable = Timetable::of(&yard, YardRules::BURN * FUSE)?;
            yard.furnish(rules, furniture, &timetable.visits, &mut sampler)?;
            timetable.fastest(&yard, YardRules::BURN * (FUSE - 1))?;
            Some((yard, timetable))
        };
        let (yard, timetable) = (0..200).find_map(drawn).unwrap();
        let lookout = lookout(&yard, &timetable, YardRules::BURN * FUSE - 1);
        let expected = lookout.rate(1, 200, &mut Seed::from_text("plays").sampler());
        assert!((0.2..0.95).contains(&expected), "{expected}");
        let game = rules.game();
        let level = game.level(&text(&yard, FUSE)).unwrap();
        let stray = game.sprite_types().find(|stype| game.name(*stype) == "stray").unwrap();
        const PLAYS: u64 = 40;
        let dice = |play: &u64| Seed::from_text("dice").child("play", *play);
        let won = (0..PLAYS)
            .filter(|play| lookout.play_game(&game, &level, stray, 1, dice(play)).is_some())
            .count();
        let rate = won as f64 / PLAYS as f64;
        assert!((rate - expected).abs() < 0.2, "{rate} in the game, {expected} here");
    }
}
