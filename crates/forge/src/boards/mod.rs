//! Boards for any game, searched for with players: composed by [`generators::boards`], then changed until a shortest win
//! needs every clause, wrong choices cost, and nothing is left over.

mod deviations;
mod judge;
mod make;
mod necessity;
mod order;
mod replay;
mod shortest;

pub use make::make_board;
pub(crate) use make::search_boards;
pub use order::{BoardBudget, BoardMeasures, BoardOrder, MadeBoard};
