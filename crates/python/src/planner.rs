//! Planners for Python.

use crate::errors::{failed, invalid};
use crate::game::seed_of;
use crate::interrupt::interruptible;
use crate::state::State;
use agents::{Budget, OpenLoop, PLANNERS, PlannerSpec, Player};
use engine::Action;
use pyo3::prelude::*;

/// Returns the names of all planners, from weakest to strongest.
#[pyfunction]
pub(crate) fn planner_names() -> Vec<&'static str> {
    PLANNERS.to_vec()
}

/// The number of forward-model calls at which planning starts to take a noticeable time.
const QUICK: u64 = 100_000;

/// A planner with its own random-number streams.
#[pyclass(module = "infinite_arcade")]
pub(crate) struct Planner {
    player: OpenLoop<Player>,
    budget: Budget,
    spec: PlannerSpec,
}

impl Planner {
    /// Plans with a copy of the player, so that an interrupted plan leaves the planner unchanged.
    fn plan_slowly(&mut self, py: Python<'_>, state: &State, count: u64) -> PyResult<(Vec<Action>, u64)> {
        let (game, state, mut player) = (state.rules().clone(), state.state.clone(), self.player.clone());
        let (player, plan) = interruptible(py, move |_| {
            let plan = player.plan(&game, &state, count);
            Ok((player, plan))
        })?;
        self.player = player;
        Ok(plan)
    }
}

#[pymethods]
impl Planner {
    #[new]
    #[pyo3(signature = (name, *, seed, budget = 1000))]
    fn new(name: &str, seed: &str, budget: u64) -> PyResult<Planner> {
        let spec: PlannerSpec = name.parse().map_err(invalid)?;
        let (seed, budget) = (seed_of(seed), spec.budget().unwrap_or(Budget(budget)));
        if budget.0 == 0 {
            return Err(invalid(format!(
                "the planner {name} needs a budget of at least 1 forward-model call"
            )));
        }
        if budget > Budget::MOST {
            return Err(invalid(format!("budget={} exceeds the limit of {}", budget.0, Budget::MOST.0)));
        }
        Ok(Planner { player: OpenLoop::new(spec.player(seed), budget, seed), budget, spec })
    }

    /// Returns the planner as JSON, from which [`Planner::load`] makes a planner that continues in the same way.
    fn save(&self) -> PyResult<String> {
        serde_json::to_string(&(self.spec.to_string(), self.budget, &self.player)).map_err(failed)
    }

    /// Creates a planner from the text that [`Planner::save`] returned.
    #[staticmethod]
    fn load(saved: &str) -> PyResult<Planner> {
        let (name, budget, player): (String, _, _) = serde_json::from_str(saved).map_err(invalid)?;
        Ok(Planner { player, budget, spec: name.parse().map_err(invalid)? })
    }

    /// Returns the next actions, and the number of forward-model calls made to choose them.
    #[pyo3(signature = (state, count = 1))]
    fn plan(&mut self, py: Python<'_>, state: &State, count: u64) -> PyResult<(Vec<&'static str>, u64)> {
        let (actions, calls) = match self.budget.0.saturating_mul(count) {
            0..QUICK => {
                let (game, state, player) = (state.rules(), &state.state, &mut self.player);
                py.detach(|| player.plan(game, state, count))
            }
            _ => self.plan_slowly(py, state, count)?,
        };
        Ok((actions.into_iter().map(|action| action.name()).collect(), calls))
    }

    fn __repr__(&self) -> String {
        format!("<Planner {}>", self.spec)
    }
}
