//! Tables on a page.

use super::words;
use report::{Table, TableCell};
use serde::Serialize;

/// Rows of a table in a page, at most; its file has all.
const MOST: usize = 150;

/// A table as the template part `table` shows it.
#[derive(Serialize)]
pub(crate) struct Shown {
    pub(crate) id: String,
    title: String,
    note: String,
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: Vec<Row>,
    /// The rows that are left out, in words; empty if none is.
    more: String,
    /// `true` if its rows stand as lists of cells where the page is narrow: for tables with long words.
    stack: bool,
}

/// A column: its name, and `true` if it holds figures, which are set to the right.
#[derive(Serialize)]
pub(crate) struct Column {
    pub(crate) name: String,
    figures: bool,
}

#[derive(Serialize)]
pub(crate) struct Row {
    pub(crate) cells: Vec<String>,
    /// `true` if it stands back behind the others.
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

    /// The table with its first rows only, where it has many, and with some marked.
    pub(crate) fn cut(mut self, is_marked: impl Fn(&[String]) -> bool) -> Shown {
        let more = self.rows.len().saturating_sub(MOST) as u64;
        self.more = if more == 0 { String::new() } else { words::many(more, "row") };
        self.rows.truncate(MOST);
        self.rows.iter_mut().for_each(|row| row.mark = is_marked(&row.cells));
        self
    }
}
