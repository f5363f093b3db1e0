//! Layouts of lock puzzles, and changes to layouts.

use crate::Variation;
use crate::levels::grid::Grid;
use base::{Sampler, Seed};

/// A cell's content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tile {
    Floor,
    Wall,
    /// Floor that carries the avatar only once.
    Plank,
    /// A key of the given kind.
    Key(usize),
    /// A door of the given kind.
    Door(usize),
    /// The exit or a gem.
    Goal,
}

/// A board with a border of walls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) grid: Grid,
    pub(super) tiles: Vec<Tile>,
    /// The avatar's cell, which is floor.
    pub(super) start: usize,
}

/// The numbers of items in a layout.
#[derive(Clone, Copy, Debug)]
pub(super) struct Furniture {
    pub(super) kinds: usize,
    /// The number of keys of each kind, which is also the number of doors of each kind.
    pub(super) locks: usize,
    pub(super) planks: usize,
    pub(super) goals: usize,
}

/// A generator of layouts with a fixed size and fixed contents.
pub(super) struct Layouts {
    pub(super) grid: Grid,
    pub(super) furniture: Furniture,
}

/// The maximum fraction of the inner cells that are dug as corridors.
const CARVED: f64 = 0.62;

impl Layouts {
    fn inner(&self) -> Vec<usize> {
        (0..self.grid.len()).filter(|&cell| !self.grid.on_border(cell)).collect()
    }

    /// Digs corridors. At first, no cell is dug that would connect floor cells that are already connected. A few more
    /// cells are dug afterwards.
    fn dig(&self, sampler: &mut Sampler) -> Vec<Tile> {
        let mut tiles = vec![Tile::Wall; self.grid.len()];
        let mut inner = self.inner();
        let first = *sampler.choose(&inner);
        tiles[first] = Tile::Floor;
        let most = (inner.len() as f64 * CARVED) as usize;
        let mut dug = 1;
        for _ in 0..12 {
            sampler.shuffle(&mut inner);
            for &cell in &inner {
                let beside = self.grid.beside(cell).filter(|&next| tiles[next] == Tile::Floor).count();
                if dug < most && tiles[cell] == Tile::Wall && beside == 1 {
                    tiles[cell] = Tile::Floor;
                    dug += 1;
                }
            }
        }
        for &cell in inner.iter().take(3) {
            tiles[cell] = Tile::Floor;
        }
        tiles
    }

    /// Returns the items to place, starting with the goals.
    fn things(&self) -> Vec<Tile> {
        let Furniture { kinds, locks, planks, goals } = self.furniture;
        let of_kinds =
            (0..kinds).flat_map(|kind| (0..locks).flat_map(move |_| [Tile::Key(kind), Tile::Door(kind)]));
        std::iter::repeat_n(Tile::Goal, goals)
            .chain(of_kinds)
            .chain(std::iter::repeat_n(Tile::Plank, planks))
            .collect()
    }
}

/// Returns `true` if a cell is part of a corridor, where two opposite neighbours are floor and the other two are walls.
fn is_corridor(grid: Grid, tiles: &[Tile], cell: usize) -> bool {
    let is_wall = |way| grid.shift(cell, way).is_none_or(|next| tiles[next] == Tile::Wall);
    let [up, left, down, right] = [(0, -1), (-1, 0), (0, 1), (1, 0)].map(is_wall);
    (up && down && !left && !right) || (left && right && !up && !down)
}

impl Variation for Layouts {
    type Candidate = Layout;

    fn create(&self, seed: Seed) -> Option<Layout> {
        let mut sampler = seed.sampler();
        let mut tiles = self.dig(&mut sampler);
        let mut free: Vec<usize> = (0..tiles.len()).filter(|&cell| tiles[cell] == Tile::Floor).collect();
        sampler.shuffle(&mut free);
        let start = free.pop()?;
        for thing in self.things() {
            // Doors and planks stand in corridors, where no path leads around them.
            let at = match thing {
                Tile::Door(_) | Tile::Plank => {
                    free.iter().position(|&cell| is_corridor(self.grid, &tiles, cell)).unwrap_or(0)
                }
                _ => 0,
            };
            if free.is_empty() {
                return None;
            }
            tiles[free.remove(at)] = thing;
        }
        Some(Layout { grid: self.grid, tiles, start })
    }

    fn mutate(&self, parent: &Layout, sampler: &mut Sampler) -> Layout {
        let mut child = parent.clone();
        let inner = self.inner();
        for _ in 0..1 + sampler.below(3) {
            let cell = *sampler.choose(&inner);
            let other = *sampler.choose(&inner);
            let is_ground = |layout: &Layout, cell: usize| {
                matches!(layout.tiles[cell], Tile::Floor | Tile::Wall) && cell != layout.start
            };
            match sampler.below(8) {
                // Swaps a thing with the content of a different cell.
                0..=2 => {
                    let is_thing = |cell: usize| !matches!(child.tiles[cell], Tile::Floor | Tile::Wall);
                    let things: Vec<usize> = inner.iter().copied().filter(|&cell| is_thing(cell)).collect();
                    let from = *sampler.choose(&things);
                    if other != child.start {
                        child.tiles.swap(from, other);
                    }
                }
                // Swaps a cell with its neighbour.
                3 => {
                    let beside: Vec<usize> =
                        self.grid.beside(cell).filter(|&next| !self.grid.on_border(next)).collect();
                    let next = *sampler.choose(&beside);
                    if cell != child.start && next != child.start {
                        child.tiles.swap(cell, next);
                    }
                }
                // Moves the avatar's start.
                4 if child.tiles[other] == Tile::Floor => child.start = other,
                _ if is_ground(&child, cell) => {
                    let is_wall = child.tiles[cell] == Tile::Wall;
                    child.tiles[cell] = if is_wall { Tile::Floor } else { Tile::Wall };
                }
                _ => {}
            }
        }
        child
    }

    fn cross(&self, one: &Layout, _: &Layout, sampler: &mut Sampler) -> Layout {
        self.mutate(one, sampler)
    }
}
