//! The timetable of the carts in a yard, and a fastest win. Both are exact, because the avatar does not influence the
//! carts.

use super::yard::{RIGHT, Sign, Yard, opposite};
use crate::levels::grid::WAYS;
use std::collections::BTreeSet;

/// The cells with carts after each tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Timetable {
    cells: usize,
    /// For each tick and cell, `true` if the cell contains a cart after the tick.
    is_busy: Vec<bool>,
    /// For each cell, the number of ticks after which a cart is in the cell.
    pub(super) visits: Vec<u32>,
}

/// The value of the load (the carried parcel) if nothing is carried.
const EMPTY: usize = 0;
/// The minimum number of distinct cart states (cell and direction) at the end, as a fraction of the number of carts.
const APART: f64 = 0.75;

impl Timetable {
    /// Runs the carts for a number of ticks. Returns `None` if two carts enter the same points in the same tick,
    /// because the outcome would then depend on the order of rules. Also returns `None` if too many carts end up
    /// running together. Cost: O(ticks · carts²).
    pub(super) fn of(yard: &Yard, ticks: usize) -> Option<Timetable> {
        let cells = yard.grid.len();
        let mut signs = yard.signs.clone();
        let mut carts: Vec<(usize, usize)> = yard.carts.iter().map(|cart| (cart.start, RIGHT)).collect();
        let mut timetable = Timetable { cells, is_busy: vec![false; ticks * cells], visits: vec![0; cells] };
        for tick in 0..ticks {
            for ((cell, way), cart) in carts.iter_mut().zip(&yard.carts) {
                // Carts rest in the first tick, and wagons move in every second tick.
                if tick > 0 && (!cart.is_wagon || tick % 2 == 1) {
                    *cell = yard.grid.shift(*cell, WAYS[*way])?;
                }
            }
            for at in 0..carts.len() {
                let (cell, _) = carts[at];
                match signs[cell] {
                    Some(Sign::Fixed(way)) => carts[at].1 = way,
                    Some(Sign::Points(way)) => {
                        if carts.iter().filter(|(other, _)| *other == cell).count() > 1 {
                            return None;
                        }
                        carts[at].1 = way;
                        signs[cell] = Some(Sign::Points(opposite(way)));
                    }
                    None => {}
                }
                timetable.is_busy[tick * cells + cell] = true;
                timetable.visits[cell] += 1;
            }
        }
        let apart: BTreeSet<_> = carts.iter().collect();
        (apart.len() as f64 >= APART * carts.len() as f64).then_some(timetable)
    }

    /// Returns the number of ticks in the timetable.
    pub(super) fn ticks(&self) -> usize {
        self.is_busy.len() / self.cells
    }

    /// Returns `true` if a cart is in the given cell after the given tick.
    fn is_busy(&self, tick: usize, cell: usize) -> bool {
        self.is_busy[tick * self.cells + cell]
    }

    /// Returns the fraction of a walk's ticks from which staying in place for the next `wait` ticks would be fatal. The
    /// walk is given by the cell after each tick.
    pub(super) fn exposure(&self, way: &[usize], wait: usize) -> f64 {
        let ends = |tick: usize| (tick + 1 + wait).min(self.ticks());
        let deadly =
            |(tick, cell): (usize, &usize)| (tick + 1..ends(tick)).any(|later| self.is_busy(later, *cell));
        way.iter().enumerate().filter(|&at| deadly(at)).count() as f64 / way.len().max(1) as f64
    }

    /// Returns the steps of a fastest win within the timetable's first `most` ticks, and the cell after each tick.
    /// Steps are indices into [`WAYS`], or `None` for a tick of rest. Cost: O(ticks · cells · 2^parcels), or much less
    /// if few walks are fast enough.
    pub(super) fn fastest(&self, yard: &Yard, most: usize) -> Option<(Vec<Option<usize>>, Vec<usize>)> {
        let most = most.min(self.ticks());
        let remaining = Remaining::of(yard);
        let errands = Errands::new(yard);
        let mut seen = vec![u32::MAX; errands.states()];
        // For each tick, the states found, each with the index of its predecessor and the step that led to it.
        let mut layers: Vec<Vec<(u32, u32, Option<usize>)>> = vec![vec![(errands.start() as u32, 0, None)]];
        for tick in 0..most {
            let mut layer = Vec::new();
            for (from, &(state, _, _)) in layers[tick].iter().enumerate() {
                for (way, after) in errands.ways(state as usize) {
                    let (cell, load, taken) = errands.unpack(after);
                    if self.is_busy(tick, cell) || tick + 1 + remaining.least(taken, load, cell) > most {
                        continue;
                    }
                    if seen[after] != tick as u32 {
                        seen[after] = tick as u32;
                        layer.push((after as u32, from as u32, way));
                        if errands.is_won(after) {
                            layers.push(layer);
                            return Some(back(&layers, self.cells));
                        }
                    }
                }
            }
            layers.push(layer);
        }
        None
    }
}

/// The moves of a yard's avatar. A state consists of the avatar's cell, the load, and the set of parcels already taken.
struct Errands<'a> {
    yard: &'a Yard,
    /// For each cell, the index and the kind of its parcel; `None` for cells without a parcel.
    parcels: Vec<Option<(usize, usize)>>,
}

impl<'a> Errands<'a> {
    fn new(yard: &'a Yard) -> Errands<'a> {
        let mut parcels = vec![None; yard.grid.len()];
        for (number, &(cell, kind)) in yard.parcels.iter().enumerate() {
            parcels[cell] = Some((number, kind));
        }
        Errands { yard, parcels }
    }

    /// Returns the number of possible loads: one for no load, and one for each kind of parcel.
    fn loads(&self) -> usize {
        self.yard.depots.len() + 1
    }

    fn all(&self) -> usize {
        (1 << self.yard.parcels.len()) - 1
    }

    fn pack(&self, cell: usize, load: usize, taken: usize) -> usize {
        (taken * self.loads() + load) * self.yard.grid.len() + cell
    }

    /// Splits a state into the cell, the load and the set of taken parcels.
    fn unpack(&self, state: usize) -> (usize, usize, usize) {
        let rest = state / self.yard.grid.len();
        (self.cell(state), rest % self.loads(), rest / self.loads())
    }

    /// Returns the number of states.
    fn states(&self) -> usize {
        (self.all() + 1) * self.loads() * self.yard.grid.len()
    }

    /// Returns the initial state.
    fn start(&self) -> usize {
        self.pack(self.yard.start, EMPTY, 0)
    }

    /// Returns the avatar's cell in a state.
    fn cell(&self, state: usize) -> usize {
        state % self.yard.grid.len()
    }

    /// Returns `true` if a state is won, which means that all parcels are at their depots (destinations).
    fn is_won(&self, state: usize) -> bool {
        let (_, load, taken) = self.unpack(state);
        taken == self.all() && load == EMPTY
    }

    /// Returns the possible steps in a state, each with the state after the step. A step is an index into [`WAYS`], or
    /// `None` for a rest. Carts are ignored.
    fn ways(&self, state: usize) -> impl Iterator<Item = (Option<usize>, usize)> {
        let (cell, load, taken) = self.unpack(state);
        (0..WAYS.len()).map(Some).chain([None]).filter_map(move |way| {
            let next = match way {
                Some(way) => {
                    self.yard.grid.shift(cell, WAYS[way]).filter(|&next| self.yard.is_floor[next])?
                }
                None => cell,
            };
            let (mut load, mut taken) = (load, taken);
            if let Some((number, kind)) = self.parcels[next]
                && load == EMPTY
                && taken & (1 << number) == 0
            {
                (load, taken) = (kind + 1, taken | 1 << number);
            }
            if load != EMPTY && self.yard.depots[load - 1] == next {
                load = EMPTY;
            }
            Some((way, self.pack(next, load, taken)))
        })
    }
}

/// A lower bound on the remaining steps.
struct Remaining {
    /// For each set of taken parcels, the total length of the walks from the remaining parcels to their depots and from
    /// the nearest depots to these parcels.
    tours: Vec<usize>,
    /// For each depot (destination of parcels), the number of steps from each cell.
    steps: Vec<Vec<u32>>,
}

impl Remaining {
    fn of(yard: &Yard) -> Remaining {
        let flood = |&depot: &usize| yard.grid.flood(&[depot], |cell| yard.is_floor[cell]);
        let steps: Vec<Vec<u32>> = yard.depots.iter().map(flood).collect();
        let nearest = |cell: usize| steps.iter().map(|steps| steps[cell]).min().unwrap_or(0);
        let tour = |&(cell, kind): &(usize, usize)| (steps[kind][cell] + nearest(cell)) as usize;
        let tours: Vec<usize> = yard.parcels.iter().map(tour).collect();
        let left = |taken: usize| -> usize {
            tours.iter().enumerate().filter(|(at, _)| taken & (1 << at) == 0).map(|(_, tour)| tour).sum()
        };
        let tours = (0..1 << tours.len()).map(left).collect();
        Remaining { tours, steps }
    }

    /// Returns the lower bound for a state. If the avatar has no load, the first walk to a parcel begins at the avatar
    /// instead of a depot. By the triangle inequality, this saves at most the distance between the avatar and the
    /// nearest depot.
    fn least(&self, taken: usize, load: usize, cell: usize) -> usize {
        let tours = self.tours[taken];
        match load {
            EMPTY => {
                let nearest = self.steps.iter().map(|steps| steps[cell]).min().unwrap_or(0);
                tours.saturating_sub(nearest as usize)
            }
            _ => tours + self.steps[load - 1][cell] as usize,
        }
    }
}

/// Returns the steps and cells on the path to the last state in the last layer.
fn back(layers: &[Vec<(u32, u32, Option<usize>)>], cells: usize) -> (Vec<Option<usize>>, Vec<usize>) {
    let mut at = layers[layers.len() - 1].len() - 1;
    let (mut ways, mut visited) = (Vec::new(), Vec::new());
    for layer in layers[1..].iter().rev() {
        let (state, before, way) = layer[at];
        ways.push(way);
        visited.push(state as usize % cells);
        at = before as usize;
    }
    ways.reverse();
    visited.reverse();
    (ways, visited)
}
