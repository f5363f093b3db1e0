//! Games and levels for Python.

use crate::errors::{described, failed, invalid, malformed};
use crate::picture;
use crate::state::State;
use base::Seed;
use engine::describe::{self, Guide};
use engine::{Action, Analysis, Outcome};
use evaluation::is_of_use;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use render::{Looks, Symbols};
use serde_json::json;
use std::sync::Arc;

/// A game, with everything that is derived from its rules.
pub(crate) struct Rules {
    pub(crate) name: String,
    pub(crate) source: String,
    pub(crate) as_reference: bool,
    pub(crate) game: engine::Game,
    pub(crate) analysis: Analysis,
    pub(crate) looks: Looks,
    pub(crate) symbols: Symbols,
    /// The actions that can have an effect, starting with doing nothing.
    pub(crate) actions: Vec<Action>,
}

/// A compiled game.
#[pyclass(frozen, module = "infinite_arcade")]
#[derive(Clone)]
pub(crate) struct Game(pub(crate) Arc<Rules>);

/// A level of a specific game. A clone shares the game and the level.
#[pyclass(frozen, module = "infinite_arcade")]
#[derive(Clone)]
pub(crate) struct Level {
    pub(crate) game: Game,
    pub(crate) name: Arc<str>,
    pub(crate) level: Arc<engine::Level>,
}

/// Parses an action from its name.
pub(crate) fn action_named(name: &str) -> PyResult<Action> {
    let found = Action::ALL.into_iter().find(|action| action.name() == name);
    found.ok_or_else(|| {
        let names = Action::ALL.map(|action| action.name()).join(", ");
        invalid(format_args!("there is no action `{name}`; the actions are {names}"))
    })
}

/// Converts a text to a seed. A text of 64 hexadecimal digits is the seed itself, and any other text is
/// hashed to a seed.
pub(crate) fn seed_of(text: &str) -> Seed {
    text.parse().unwrap_or_else(|_| Seed::from_text(text))
}

/// The names of the outcomes.
pub(crate) const OUTCOMES: [&str; 5] = ["ongoing", "won", "lost", "ended", "stopped"];

/// Returns an outcome's name.
pub(crate) fn outcome_name(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Ongoing => OUTCOMES[0],
        Outcome::Won => OUTCOMES[1],
        Outcome::Lost => OUTCOMES[2],
        Outcome::Ended => OUTCOMES[3],
        Outcome::Stopped(_) => OUTCOMES[4],
    }
}

/// Returns the seed derived from a text, as 64 hexadecimal digits.
#[pyfunction]
pub(crate) fn seed_from_text(text: &str) -> String {
    Seed::from_text(text).to_string()
}

/// Derives a seed from `seed`, a `purpose` and an `index`.
#[pyfunction]
pub(crate) fn seed_child(seed: &str, purpose: &str, index: u64) -> String {
    seed_of(seed).child(purpose, index).to_string()
}

#[pymethods]
impl Game {
    #[new]
    #[pyo3(signature = (source, *, name = "game.vgdl", as_reference = false))]
    fn new(py: Python<'_>, source: String, name: &str, as_reference: bool) -> PyResult<Game> {
        let load =
            if as_reference { engine::Game::from_source_as_reference } else { engine::Game::from_source };
        let game = load(&source).map_err(|problems| malformed(py, name, &source, &problems.0))?;
        let analysis = Analysis::of(&game);
        let looks = Looks::of(&analysis);
        let symbols = Symbols::of(&analysis, &looks);
        let actions = Action::ALL.into_iter().filter(|&action| is_of_use(&analysis, action)).collect();
        let name = name.to_owned();
        Ok(Game(Arc::new(Rules { name, source, as_reference, game, analysis, looks, symbols, actions })))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    #[getter]
    fn source(&self) -> &str {
        &self.0.source
    }

    #[getter]
    fn as_reference(&self) -> bool {
        self.0.as_reference
    }

    #[getter]
    fn digest(&self) -> String {
        self.0.game.digest().to_string()
    }

    #[getter]
    fn actions(&self) -> Vec<&'static str> {
        self.0.actions.iter().map(|action| action.name()).collect()
    }

    #[getter]
    fn time_limit(&self) -> u64 {
        self.0.game.time_limit()
    }

    #[getter]
    fn is_deterministic(&self) -> bool {
        self.0.game.is_deterministic()
    }

    /// The names of the sprite types visible to players, in the order of the planes.
    #[getter]
    fn types(&self) -> Vec<&str> {
        self.0.looks.shown().map(|stype| self.0.game.name(stype)).collect()
    }

    /// The visible sprite types, each with the character that represents it on boards of symbols.
    #[getter]
    fn symbols(&self) -> Vec<(String, char)> {
        let rules = &self.0;
        rules
            .looks
            .shown()
            .map(|stype| (rules.game.name(stype).to_owned(), rules.symbols.symbol(stype)))
            .collect()
    }

    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let Rules { name, source, game, .. } = &*self.0;
        game.warnings().iter().map(|warning| described(py, name, source, warning)).collect()
    }

    #[pyo3(signature = (text, *, name = "level"))]
    fn level(&self, py: Python<'_>, text: &str, name: &str) -> PyResult<Level> {
        let level = self.0.game.level(text).map_err(|problems| malformed(py, name, text, &problems.0))?;
        Ok(Level { game: self.clone(), name: name.into(), level: Arc::new(level) })
    }

    /// Returns the game's rules in plain English.
    fn describe(&self) -> String {
        Guide::from_analysis(&self.0.analysis).to_string()
    }

    /// Returns the kind of the game and the facts proven from its rules, as JSON.
    fn facts(&self) -> PyResult<String> {
        let analysis = &self.0.analysis;
        let facts = json!({
            "digest": self.0.game.digest(),
            "taxonomy": analysis.taxonomy(),
            "kind": Guide::from_analysis(analysis).kind,
            "can_win": analysis.can_win(),
            "can_lose": analysis.can_lose(),
            "time_limit": self.0.game.time_limit(),
            "deterministic": self.0.game.is_deterministic(),
        });
        serde_json::to_string(&facts).map_err(failed)
    }

    fn __repr__(&self) -> String {
        format!("<Game {} {}>", self.0.name, &self.0.game.digest().to_string()[..8])
    }
}

#[pymethods]
impl Level {
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn game(&self) -> Game {
        self.game.clone()
    }

    #[getter]
    fn digest(&self) -> String {
        self.level.digest().to_string()
    }

    #[getter]
    fn columns(&self) -> usize {
        self.level.columns()
    }

    #[getter]
    fn rows(&self) -> usize {
        self.level.rows()
    }

    #[getter]
    fn text(&self) -> String {
        self.level.to_string()
    }

    /// Returns the facts proven about the level, one sentence per fact.
    fn describe(&self) -> Vec<String> {
        let analysis = &self.game.0.analysis;
        describe::level(analysis, &self.level, &analysis.reach(&self.level))
    }

    fn start(&self, seed: &str) -> State {
        State::start(self, seed_of(seed))
    }

    /// Renders an episode as an animated GIF.
    fn gif<'py>(
        &self,
        py: Python<'py>,
        seed: &str,
        actions: Vec<String>,
        cell: u32,
        delay: u16,
        caption: bool,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let actions = actions.iter().map(|name| action_named(name)).collect::<PyResult<Vec<_>>>()?;
        let rules = &*self.game.0;
        let style = render::Style { cell, caption, legend: false };
        let state = rules.game.start(&self.level, seed_of(seed));
        let drawn = py.detach(|| {
            picture::animation((&rules.game, &rules.looks), state, &actions, &style, delay).map_err(invalid)
        });
        Ok(PyBytes::new(py, &drawn?))
    }

    fn __repr__(&self) -> String {
        format!("<Level {} of {}>", self.name, self.game.0.name)
    }
}
