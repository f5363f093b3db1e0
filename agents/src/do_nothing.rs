//! The player who never touches a key.

use crate::planner::{Budget, Planner};
use engine::{Action, Game, State};

/// Always [`Action::Nil`].
#[derive(Clone, Copy, Debug, Default)]
pub struct DoNothing;

impl Planner for DoNothing {
    fn plan(&mut self, _: &Game, _: &State, _: Budget) -> (Action, u64) {
        (Action::Nil, 0)
    }
}
