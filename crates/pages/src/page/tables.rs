//! Tables on report pages.

use super::words;
use report::{Table, TableCell};
use serde::Serialize;

/// The maximum number of table rows to show on a page. The table's file contains all rows.
const MOST: usize = 150;

/// A table in the form that the template `table` requires.
#[derive(Serialize)]
pub(crate) struct Shown {
    pub(crate) id: String,
    title: String,
    note: String,
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: Vec<Row>,
    /// A phrase stating the number of omitted rows. Empty if no rows are omitted.
    more: String,
    /// `true` if a narrow page shows each row as a list of cells. This layout suits tables with long texts.
    stack: bool,
}

/// A table column. The flag is `true` if the column contains numbers and is right-aligned.
#[derive(Serialize)]
pub(crate) struct Column {
    pub(crate) name: String,
    figures: bool,
}

#[derive(Serialize)]
pub(crate) struct Row {
    pub(crate) cells: Vec<String>,
    /// `true` if the row is less prominent than the others.
    pub(crate) mark: bool,
}

impl Shown {
    pub(crate) fn of(table: &Table) -> Shown {
        let column = |(at, name): (usize, &String)| {
            let figures = !table.rows.iter().any(|row| matches!(row[at], TableCell::Text(_)));
            Column { name: name.clone(), figures }
        };
        let row = |row: &Vec<TableCell>| {
            let cells = row.iter().map(TableCell::plain).collect();
            Row { cells, mark: false }
        };
        Shown {
            id: table.id.clone(),
            title: table.title.clone(),
            note: table.note.clone(),
            columns: table.columns.iter().enumerate().map(column).collect(),
            rows: table.rows.iter().map(row).collect(),
            more: String::new(),
            stack: false,
        }
    }

    #[must_use]
    pub(crate) fn stacked(self) -> Shown {
        Shown { stack: true, ..self }
    }

    /// Truncates a long table to its first rows, and sets `mark` for the rows for which `is_marked` returns
    /// `true`.
    pub(crate) fn cut(mut self, is_marked: impl Fn(&[String]) -> bool) -> Shown {
        let more = self.rows.len().saturating_sub(MOST) as u64;
        self.more = if more == 0 { String::new() } else { words::many(more, "row") };
        self.rows.truncate(MOST);
        self.rows.iter_mut().for_each(|row| row.mark = is_marked(&row.cells));
        self
    }
}
