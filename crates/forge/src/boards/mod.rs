//! Boards for any game, found by a player-guided search. [`generators::boards`] composes the boards. The search then
//! changes them until a shortest win needs every interaction, wrong choices have a cost, and no piece is superfluous.

mod deviations;
mod judge;
pub(crate) mod likeness;
mod make;
mod necessity;
mod order;
mod replay;
mod shortest;

pub use make::make_board;
pub(crate) use make::search_boards;
pub(crate) use necessity::Ablations;
pub use order::{BoardBudget, BoardMeasures, BoardOrder, MadeBoard};
pub(crate) use replay::first_executions;
