//! The visible part of an observation, without floors and with the avatar in a single cell.

use crate::legend::Legend;
use engine::Observation;
use itertools::Itertools;

/// An observation in the form used by all encodings.
#[derive(Clone, Debug)]
pub(crate) struct Scene<'a> {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// The type names in each cell, in row-major order. Within a cell, the sprites are ordered from bottom to
    /// top, without floors. The avatar is only in the cell of its centre, above all other sprites.
    pub(crate) cells: Vec<Vec<&'a str>>,
    /// The avatar's column and row, if there is an avatar.
    pub(crate) avatar: Option<(usize, usize)>,
}

impl<'a> Scene<'a> {
    pub(crate) fn of(observation: &'a Observation, legend: &Legend) -> Scene<'a> {
        let avatar = observation.avatar.as_ref();
        let is_own = |name: &String| avatar.is_some_and(|avatar| avatar.name == *name);
        let shown = |names: &'a Vec<String>| {
            let shown = names.iter().filter(|name| !is_own(name) && legend.is_shown(name));
            shown.map(String::as_str).collect()
        };
        let mut cells: Vec<Vec<&str>> = observation.cells.iter().map(shown).collect();
        let place = avatar.and_then(|avatar| {
            let (column, row) = (usize::try_from(avatar.column).ok()?, usize::try_from(avatar.row).ok()?);
            (column < observation.columns && row < observation.rows).then_some((column, row))
        });
        if let (Some((column, row)), Some(avatar)) = (place, avatar) {
            cells[row * observation.columns + column].push(&avatar.name);
        }
        Scene { columns: observation.columns, rows: observation.rows, cells, avatar: place }
    }

    /// Returns the type names in a cell, from bottom to top.
    pub(crate) fn at(&self, column: usize, row: usize) -> &[&'a str] {
        &self.cells[row * self.columns + column]
    }

    /// Returns the cells that contain a sprite of the named type, row by row.
    pub(crate) fn places<'b>(&'b self, name: &'b str) -> impl Iterator<Item = (usize, usize)> + 'b {
        let holding = self.cells.iter().enumerate().filter(move |(_, names)| names.contains(&name));
        holding.map(|(cell, _)| (cell % self.columns, cell / self.columns))
    }
}

/// Formats a cell as `(3,4)`.
pub(crate) fn place((column, row): (usize, usize)) -> String {
    format!("({column},{row})")
}

/// Formats a list of cells as `(3,4) (5,4)`.
pub(crate) fn places(all: &[(usize, usize)]) -> String {
    all.iter().map(|&cell| place(cell)).join(" ")
}
