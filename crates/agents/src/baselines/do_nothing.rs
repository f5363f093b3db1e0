//! A player that never presses a key.

use crate::planner::{Budget, Planner};
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

/// A planner that always returns [`Action::Nil`].
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct DoNothing;

impl Planner for DoNothing {
    fn plan(&mut self, _: &Game, _: &State, _: Budget) -> (Action, u64) {
        (Action::Nil, 0)
    }
}
