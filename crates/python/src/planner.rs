//! Planners for Python.

use crate::errors::invalid;
use crate::game::seed_of;
use crate::state::State;
use agents::{Budget, OpenLoop, PLANNERS, PlannerSpec, Player};
use pyo3::prelude::*;

/// Returns the names of all planners, from weakest to strongest.
#[pyfunction]
pub(crate) fn planner_names() -> Vec<&'static str> {
    PLANNERS.to_vec()
}

/// A planner with its own random streams.
#[pyclass(module = "infinite_arcade")]
pub(crate) struct Planner {
    player: OpenLoop<Player>,
    spec: PlannerSpec,
}

#[pymethods]
impl Planner {
    #[new]
    #[pyo3(signature = (name, *, seed, budget = 1000))]
    fn new(name: &str, seed: &str, budget: u64) -> PyResult<Planner> {
        let spec: PlannerSpec = name.parse().map_err(invalid)?;
        let (seed, budget) = (seed_of(seed), spec.budget().unwrap_or(Budget(budget)));
        if budget > Budget::MOST {
            return Err(invalid(format!("budget={} exceeds the limit of {}", budget.0, Budget::MOST.0)));
        }
        Ok(Planner { player: OpenLoop::new(spec.player(seed), budget, seed), spec })
    }

    /// Returns the next actions, and the number of forward-model calls made to choose them.
    #[pyo3(signature = (state, count = 1))]
    fn plan(&mut self, py: Python<'_>, state: &State, count: u64) -> (Vec<&'static str>, u64) {
        let (game, state, player) = (&state.game.0.game, &state.state, &mut self.player);
        let (actions, calls) = py.detach(|| player.plan(game, state, count));
        (actions.into_iter().map(|action| action.name()).collect(), calls)
    }

    fn __repr__(&self) -> String {
        format!("<Planner {}>", self.spec)
    }
}
