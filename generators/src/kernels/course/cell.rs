//! A cell of a board.

/// A cell, as column and row.
pub(crate) type Cell = (usize, usize);
