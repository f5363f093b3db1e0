//! Levels from maps. A graph of rooms is laid out on a board, the rooms are built, and sprites are placed in them.

mod cell;
mod embedding;
mod furniture;
mod room;
mod stretch;

use crate::kernels::file::kernel::Kernel;
use crate::kernels::file::map::Map;
use base::{Sampler, Seed};
use cell::Cell;
use embedding::Embedding;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of columns and rows in a level.
const LARGEST: (usize, usize) = (24, 14);
/// The number of layouts to draw per map.
const DRAWS: u64 = 24;

/// The board sizes to which a game's levels may be stretched; `None` for games without a fixed size.
const BOARDS: [Option<Cell>; 6] = [None, None, None, None, Some((18, 10)), Some((20, 11))];
/// The fraction of boards to stretch in games with a fixed board size.
const STRETCHED: (usize, usize) = (3, 4);

/// The facts about a game's types that level builders need.
#[derive(Clone, Debug, Default)]
pub(crate) struct Traits {
    /// The types that occur in the game.
    pub(crate) present: BTreeSet<String>,
    /// The types that stop the avatar or that the avatar pushes.
    pub(crate) solid: BTreeSet<String>,
    /// The types that kill the avatar on contact.
    pub(crate) deadly: BTreeSet<String>,
    /// The types that move back and forth; `true` for those that move vertically.
    pub(crate) lanes: BTreeMap<String, bool>,
}

/// The size and shape of the space that a game's levels occupy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Space {
    /// The number of columns and rows by which rooms exceed their required size.
    pub(crate) spare: usize,
    /// The target ratio of columns to rows, as far as rooms can be laid out to match it.
    pub(crate) shape: f64,
    /// The numbers of columns and rows to which boards are stretched where possible.
    pub(crate) board: Option<Cell>,
}

impl Default for Space {
    fn default() -> Space {
        Space { spare: 0, shape: 1.6, board: None }
    }
}

impl Space {
    pub(crate) fn draw(sampler: &mut Sampler) -> Space {
        let (spare, shape) = (*sampler.choose(&[0, 0, 0, 1]), *sampler.choose(&[1.0, 1.6, 1.6, 2.4]));
        Space { spare, shape, board: *sampler.choose(&BOARDS) }
    }
}

/// A board whose cells contain type names; `None` is floor.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Board {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    cells: Vec<Option<String>>,
}

impl Board {
    fn walls(columns: usize, rows: usize) -> Board {
        Board { columns, rows, cells: vec![Some("wall".to_owned()); columns * rows] }
    }

    /// Returns the type in a cell; `None` is floor.
    pub(crate) fn at(&self, (x, y): Cell) -> Option<&str> {
        self.cells[y * self.columns + x].as_deref()
    }

    fn put(&mut self, (x, y): Cell, stype: Option<&str>) {
        self.cells[y * self.columns + x] = stype.map(str::to_owned);
    }

    fn is_wall(&self, cell: Cell) -> bool {
        self.at(cell) == Some("wall")
    }

    fn is_floor(&self, cell: Cell) -> bool {
        self.at(cell).is_none()
    }

    /// Returns the board without its outermost cells.
    pub(crate) fn without_ring(&self) -> Board {
        let mut inner = Board::walls(self.columns - 2, self.rows - 2);
        for y in 0..inner.rows {
            for x in 0..inner.columns {
                inner.put((x, y), self.at((x + 1, y + 1)));
            }
        }
        inner
    }

    /// Returns the board with columns and rows exchanged.
    fn transposed(&self) -> Board {
        let mut turned = Board::walls(self.rows, self.columns);
        for y in 0..self.rows {
            for x in 0..self.columns {
                turned.put((y, x), self.at((x, y)));
            }
        }
        turned
    }

    /// Returns the orthogonal neighbours of a cell within the board.
    fn beside(&self, (x, y): Cell) -> impl Iterator<Item = Cell> + use<> {
        let (columns, rows) = (self.columns, self.rows);
        let steps = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        steps.into_iter().filter_map(move |(dx, dy): (isize, isize)| {
            let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
            (x < columns && y < rows).then_some((x, y))
        })
    }

    /// Returns the number of steps from `start` to every cell reachable through cells that `open` accepts.
    fn steps_from(&self, start: Cell, open: impl Fn(Cell) -> bool) -> BTreeMap<Cell, usize> {
        let mut steps = BTreeMap::from([(start, 0)]);
        let mut front = vec![start];
        let mut step = 0;
        while !front.is_empty() {
            step += 1;
            let mut next = Vec::new();
            for cell in front {
                for beside in self.beside(cell) {
                    if open(beside) && !steps.contains_key(&beside) {
                        steps.insert(beside, step);
                        next.push(beside);
                    }
                }
            }
            front = next;
        }
        steps
    }
}

/// Lays out a map; `None` if no drawn layout has room for everything.
pub(crate) fn lay_out(
    map: &Map,
    kernel: &Kernel,
    traits: &Traits,
    space: Space,
    seed: Seed,
) -> Option<Board> {
    (0..DRAWS).find_map(|draw| {
        let sampler = &mut seed.child("layout", draw).sampler();
        let needs: Vec<(usize, usize)> =
            map.rooms.iter().map(|room| room::size(room, kernel, space.spare, sampler)).collect();
        let embedding = Embedding::draw(map, &needs, LARGEST, space.shape, sampler)?;
        let mut board = Board::walls(embedding.columns, embedding.rows);
        let openings = room::build(map, kernel, traits, &embedding, &mut board, sampler)?;
        furniture::furnish(map, traits, &embedding, &openings, &mut board, sampler)?;
        let size = space.board.filter(|_| sampler.ratio(STRETCHED.0, STRETCHED.1));
        Some(match size {
            None => board,
            Some(size) => stretch::stretch(board, size, sampler),
        })
    })
}
