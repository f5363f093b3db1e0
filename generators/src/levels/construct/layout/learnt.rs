//! Layouts of walls learnt from examples. Every 3×3 window of a layout occurs in an example.
//!
//! This is the overlapping model of wave function collapse (Karth and Smith 2017, "WaveFunctionCollapse is Constraint
//! Solving in the Wild"). In this implementation, border cells have their own classes, so that windows learnt at an
//! edge stay at that edge. Before a board is restarted, its last decisions are undone.

use crate::levels::grid::Grid;
use base::Sampler;
use std::collections::{BTreeMap, VecDeque};

/// A window's side length, in cells.
const SIDE: usize = 3;
/// The number of cells in a window.
const CELLS: usize = SIDE * SIDE;
/// The maximum number of distinct windows. The most frequent windows are retained. Time and memory grow with the square
/// of this number.
const MOST: usize = 320;
/// The maximum number of boards to attempt.
const RESTARTS: usize = 2;
/// The maximum number of windows to examine per board.
const WORK: usize = 1_500_000;
/// The number of reversible decisions per board.
const MEMORY: usize = 24;

/// The classes of a window's cells. Classes 0 and 2 are open, and classes 1 and 3 are walls. Classes 2 and 3 are border
/// cells.
type Window = [u8; CELLS];

/// The windows in the examples.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Patterns {
    /// The windows, with their frequencies.
    seen: BTreeMap<Window, u32>,
    /// The model of the most frequent windows; see [`Patterns::conclude`].
    model: Model,
}

fn class(grid: Grid, cell: usize, wall: bool) -> u8 {
    2 * u8::from(grid.on_border(cell)) + u8::from(wall)
}

impl Patterns {
    /// Adds the windows of a board and of its left-right mirror image, because mirroring does not change a wall's
    /// purpose.
    pub(crate) fn learn(&mut self, grid: Grid, wall: &[bool]) {
        for mirrored in [false, true] {
            for y in 0..(grid.rows + 1).saturating_sub(SIDE) {
                for x in 0..(grid.columns + 1).saturating_sub(SIDE) {
                    let window = std::array::from_fn(|at| {
                        let (dx, dy) = (at % SIDE, at / SIDE);
                        let cell = grid.at(x + if mirrored { SIDE - 1 - dx } else { dx }, y + dy);
                        class(grid, cell, wall[cell])
                    });
                    *self.seen.entry(window).or_default() += 1;
                }
            }
        }
    }

    /// Returns `true` if there is a structure to learn: several distinct windows with inner walls.
    pub(crate) fn has_structure(&self) -> bool {
        self.seen.keys().filter(|window| window.contains(&1)).count() >= 8
    }

    /// Computes which windows may overlap. Must be called after all boards have been learnt. Cost: quadratic in
    /// [`MOST`].
    pub(crate) fn conclude(&mut self) {
        let mut windows: Vec<(u32, Window)> =
            self.seen.iter().map(|(window, &count)| (count, *window)).collect();
        windows.sort_by_key(|&(count, window)| (std::cmp::Reverse(count), window));
        windows.truncate(MOST);
        self.model = Model::new(windows);
    }

    /// Returns the fraction of a board's windows that occur in the examples.
    pub(crate) fn familiar(&self, grid: Grid, wall: &[bool]) -> f64 {
        let mut own = Patterns::default();
        own.learn(grid, wall);
        let all: u32 = own.seen.values().sum();
        let known = own.seen.iter().filter(|(window, _)| self.seen.contains_key(*window));
        f64::from(known.map(|(_, count)| count).sum::<u32>()) / f64::from(all.max(1))
    }

    /// Assembles walls for a board; `None` if the search reaches its limits.
    pub(crate) fn assemble(&self, grid: Grid, sampler: &mut Sampler) -> Option<Vec<bool>> {
        if grid.columns <= SIDE || grid.rows <= SIDE {
            return None;
        }
        let wave = Wave::new(&self.model, grid)?;
        (0..RESTARTS).find_map(|_| wave.clone().collapse(sampler))
    }
}

/// The windows that may overlap.
#[derive(Clone, Debug, Default, PartialEq)]
struct Model {
    windows: Vec<(u32, Window)>,
    /// For each window, its frequency times the logarithm of its frequency.
    logs: Vec<f64>,
    /// For each window, the sets of windows that fit one cell to the right, below, to the left, and above.
    fits: [Vec<Vec<u64>>; 4],
}

/// The steps from a window to its neighbours, in [`Model::fits`] order.
const STEPS: [(i32, i32); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

impl Model {
    fn new(windows: Vec<(u32, Window)>) -> Model {
        let words = windows.len().div_ceil(64);
        let agree = |one: &Window, two: &Window, (dx, dy): (usize, usize)| {
            let inner = (0..SIDE - dx).flat_map(|x| (0..SIDE - dy).map(move |y| (x, y)));
            inner.into_iter().all(|(x, y)| one[(y + dy) * SIDE + x + dx] == two[y * SIDE + x])
        };
        let fits = STEPS.map(|(dx, dy)| {
            let fitting = |(_, one): &(u32, Window)| {
                let mut set = vec![0u64; words];
                for (at, (_, two)) in windows.iter().enumerate() {
                    let fits = if dx + dy > 0 {
                        agree(one, two, (dx as usize, dy as usize))
                    } else {
                        agree(two, one, (-dx as usize, -dy as usize))
                    };
                    set[at / 64] |= u64::from(fits) << (at % 64);
                }
                set
            };
            windows.iter().map(fitting).collect()
        });
        let log = |&(count, _): &(u32, Window)| f64::from(count) * libm::log(f64::from(count));
        let logs = windows.iter().map(log).collect();
        Model { windows, logs, fits }
    }
}

/// A partly decided board, with the windows that are still possible at each position.
#[derive(Clone)]
struct Wave<'a> {
    model: &'a Model,
    /// The board's size.
    grid: Grid,
    /// The grid of window positions. The position of a window is its upper left cell.
    places: Grid,
    possible: Vec<u64>,
    /// The number of machine words in a set of windows.
    words: usize,
    /// The entropy of the choice at each position.
    entropy: Vec<u64>,
    work: usize,
}

fn members(set: &[u64]) -> impl Iterator<Item = usize> + '_ {
    set.iter().enumerate().flat_map(|(word, &bits)| {
        (0..64).filter(move |bit| bits >> bit & 1 == 1).map(move |bit| word * 64 + bit)
    })
}

fn size(set: &[u64]) -> u32 {
    set.iter().map(|bits| bits.count_ones()).sum()
}

impl<'a> Wave<'a> {
    /// Creates a wave in which every window whose border cells match the board's is possible. Returns `None` if this
    /// leaves a position without a window.
    fn new(model: &'a Model, grid: Grid) -> Option<Wave<'a>> {
        let places = Grid { columns: grid.columns + 1 - SIDE, rows: grid.rows + 1 - SIDE };
        let suits = |place: usize, window: &Window| {
            (0..CELLS).all(|at| {
                let cell = grid.at(places.x(place) + at % SIDE, places.y(place) + at / SIDE);
                (window[at] >= 2) == grid.on_border(cell)
            })
        };
        let words = model.windows.len().div_ceil(64);
        let mut possible = vec![0; places.len() * words];
        for place in 0..places.len() {
            for (at, (_, window)) in model.windows.iter().enumerate() {
                possible[place * words + at / 64] |= u64::from(suits(place, window)) << (at % 64);
            }
        }
        let entropy = vec![0; places.len()];
        let mut wave = Wave { model, grid, places, possible, words, entropy, work: 0 };
        let all: Vec<usize> = (0..places.len()).collect();
        wave.propagate(all)?;
        Some(wave)
    }

    /// Repeatedly decides the position with the lowest entropy.
    fn collapse(mut self, sampler: &mut Sampler) -> Option<Vec<bool>> {
        // A random order breaks ties.
        let mut order: Vec<usize> = (0..self.places.len()).collect();
        sampler.shuffle(&mut order);
        // The possible windows before each decision, with the position and the window that were chosen.
        let mut before: VecDeque<(Vec<u64>, usize, usize)> = VecDeque::new();
        loop {
            let open = order.iter().copied().filter(|&place| self.entropy[place] > 0);
            let Some(place) = open.min_by_key(|&place| self.entropy[place]) else { break };
            let options: Vec<usize> = members(self.set(place)).collect();
            let weights: Vec<u32> = options.iter().map(|&at| self.model.windows[at].0).collect();
            let chosen = options[sampler.weighted(&weights)?];
            before.push_back((self.possible.clone(), place, chosen));
            if before.len() > MEMORY {
                before.pop_front();
            }
            let first = place * self.words;
            self.possible[first..first + self.words].fill(0);
            self.possible[first + chosen / 64] = 1 << (chosen % 64);
            let mut done = self.propagate(vec![place]);
            while done.is_none() {
                if self.work > WORK {
                    return None;
                }
                let (possible, place, wrong) = before.pop_back()?;
                self.possible = possible;
                self.possible[place * self.words + wrong / 64] &= !(1 << (wrong % 64));
                self.entropy = (0..self.places.len()).map(|place| self.measure(place)).collect();
                done = if size(self.set(place)) == 0 { None } else { self.propagate(vec![place]) };
            }
        }
        let mut wall = vec![false; self.grid.len()];
        for place in 0..self.places.len() {
            let window = self.model.windows[members(self.set(place)).next()?].1;
            for (at, class) in window.into_iter().enumerate() {
                let (x, y) = (self.places.x(place) + at % SIDE, self.places.y(place) + at / SIDE);
                wall[self.grid.at(x, y)] = class % 2 == 1;
            }
        }
        Some(wall)
    }

    /// Returns the windows possible at a position.
    fn set(&self, place: usize) -> &[u64] {
        &self.possible[place * self.words..][..self.words]
    }

    /// Returns the entropy of a position, which is the Shannon entropy of the window frequencies in thousandths of a
    /// nat, plus one. Returns 0 if there is no choice.
    fn measure(&self, place: usize) -> u64 {
        let (mut sum, mut logs, mut options) = (0.0, 0.0, 0);
        for at in members(self.set(place)) {
            sum += f64::from(self.model.windows[at].0);
            logs += self.model.logs[at];
            options += 1;
        }
        if options < 2 { 0 } else { ((libm::log(sum) - logs / sum) * 1000.0) as u64 + 1 }
    }

    /// Rules out all windows that are incompatible with every window at a neighbouring position. Starts from the
    /// changed positions. Returns `None` if a position is left without a window.
    fn propagate(&mut self, mut changed: Vec<usize>) -> Option<()> {
        let mut waiting = vec![false; self.places.len()];
        for &place in &changed {
            waiting[place] = true;
        }
        while let Some(place) = changed.pop() {
            waiting[place] = false;
            self.entropy[place] = self.measure(place);
            for (fits, step) in self.model.fits.iter().zip(STEPS) {
                let Some(next) = self.places.shift(place, step) else { continue };
                let mut allowed = vec![0u64; self.words];
                let mut work = 0;
                for at in members(self.set(place)) {
                    work += 1;
                    let mut missing = 0;
                    for ((word, fit), possible) in allowed.iter_mut().zip(&fits[at]).zip(self.set(next)) {
                        *word |= fit;
                        missing |= possible & !*word;
                    }
                    // In most cases, a few windows are enough to allow all possible windows.
                    if missing == 0 {
                        break;
                    }
                }
                self.work += work;
                if self.work > WORK {
                    return None;
                }
                let mut fewer = false;
                for (word, allowed) in
                    self.possible[next * self.words..][..self.words].iter_mut().zip(&allowed)
                {
                    fewer |= *word & !allowed != 0;
                    *word &= allowed;
                }
                if !fewer {
                    continue;
                }
                if size(self.set(next)) == 0 {
                    return None;
                }
                if !std::mem::replace(&mut waiting[next], true) {
                    changed.push(next);
                }
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use std::collections::BTreeSet;

    fn board(text: &str) -> (Grid, Vec<bool>) {
        let columns = text.lines().next().map_or(0, str::len);
        let wall: Vec<bool> = text.bytes().filter(|&c| c != b'\n').map(|c| c == b'#').collect();
        (Grid { columns, rows: wall.len() / columns }, wall)
    }

    fn windows(grid: Grid, wall: &[bool]) -> BTreeSet<Window> {
        let mut patterns = Patterns::default();
        patterns.learn(grid, wall);
        patterns.seen.into_keys().collect()
    }

    /// Every window on an assembled board occurs in the examples.
    #[test]
    fn assembled_boards_consist_of_windows_of_the_example() {
        let boards = [
            "############\n#....#.....#\n#..........#\n#....#..##.#\n##.###..##.#\n#.......##.#\n#..##......#\n#..##..#...#\n\
             ############\n",
            "##########\n#........#\n#.##..##.#\n#.#....#.#\n#........#\n#.#....#.#\n#.##..##.#\n#........#\n##########\n",
            "###########\n#.........#\n#.###.###.#\n#.#.....#.#\n#.........#\n#.........#\n###########\n",
        ];
        let mut patterns = Patterns::default();
        let mut known = BTreeSet::new();
        for (grid, wall) in boards.map(board) {
            patterns.learn(grid, &wall);
            known.extend(windows(grid, &wall));
        }
        patterns.conclude();
        assert!(patterns.has_structure());
        let mut made = 0;
        for index in 0..20 {
            let mut sampler = Seed::from_text("learnt").child("board", index).sampler();
            let size = Grid { columns: sampler.between(8, 16), rows: sampler.between(6, 12) };
            if let Some(wall) = patterns.assemble(size, &mut sampler) {
                made += 1;
                assert!(windows(size, &wall).is_subset(&known));
                assert_eq!(patterns.familiar(size, &wall), 1.0);
            }
        }
        assert!(made >= 10, "{made}");
    }
}
