//! Episode states, with functions for stepping, hashing and observing them.

use crate::errors::{failed, invalid};
use crate::game::{Level, action_named, outcome_name, seed_of};
use crate::picture;
use base::Seed;
use engine::{Action, Outcome, Planes};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

/// An episode's state.
#[pyclass(module = "infinite_arcade")]
#[derive(Clone)]
pub(crate) struct State {
    level: Level,
    pub(crate) state: engine::State,
    history: History,
}

/// The part of a history between two seeds: a seed, and the actions played with it.
type Played = (Seed, Vec<Action>);

/// The parts of an episode that lead to a state. The first seed starts the level, and each further seed is
/// that of a fork.
#[derive(Clone)]
struct History(Vec<Played>);

impl History {
    fn record(&mut self, action: Action) {
        let (_, actions) = self.0.last_mut().expect("a history starts with a seed");
        actions.push(action);
    }
}

impl State {
    /// Starts a level.
    pub(crate) fn start(level: &Level, seed: Seed) -> State {
        let state = level.game.0.game.start(&level.level, seed);
        State::of_episode(level.clone(), state, seed, Vec::new())
    }

    /// Creates the state to which a seed and actions have led.
    pub(crate) fn of_episode(level: Level, state: engine::State, seed: Seed, actions: Vec<Action>) -> State {
        State { level, state, history: History(vec![(seed, actions)]) }
    }

    /// Returns the compiled game of the state.
    pub(crate) fn rules(&self) -> &engine::Game {
        &self.level.game.0.game
    }

    /// Plays one tick. Does nothing if the episode is over.
    fn advance(&mut self, action: Action) -> Outcome {
        if !self.state.is_over() {
            self.history.record(action);
        }
        let outcome = self.level.game.0.game.step(&mut self.state, action);
        self.state.settle_hash();
        outcome
    }
}

#[pymethods]
impl State {
    #[getter]
    fn level(&self) -> Level {
        self.level.clone()
    }

    /// The seeds and actions that lead to the state. The first seed starts the level, and each further seed is
    /// that of a fork.
    #[getter]
    fn history(&self) -> Vec<(String, Vec<&'static str>)> {
        let names = |actions: &[Action]| actions.iter().map(|action| action.name()).collect();
        self.history.0.iter().map(|(seed, actions)| (seed.to_string(), names(actions))).collect()
    }

    /// The number of ticks played so far.
    #[getter]
    fn ticks(&self) -> i32 {
        self.state.tick() + 1
    }

    #[getter]
    fn score(&self) -> f64 {
        self.state.score()
    }

    #[getter]
    fn outcome(&self) -> &'static str {
        outcome_name(self.state.outcome())
    }

    /// The limit that stopped the episode, if any.
    #[getter]
    fn stopped_by(&self) -> Option<String> {
        match self.state.outcome() {
            Outcome::Stopped(limit) => Some(limit.to_string()),
            _ => None,
        }
    }

    #[getter]
    fn is_over(&self) -> bool {
        self.state.is_over()
    }

    /// The number of columns and the number of rows of the board.
    #[getter]
    fn size(&self) -> (i32, i32) {
        self.state.size()
    }

    #[getter]
    fn actions(&self) -> Vec<&'static str> {
        self.level.game.0.game.actions(&self.state).iter().map(|action| action.name()).collect()
    }

    /// Plays one tick with the given action, and returns the outcome.
    fn step(&mut self, action: &str) -> PyResult<&'static str> {
        let action = action_named(action)?;
        Ok(outcome_name(self.advance(action)))
    }

    /// Plays one action per tick, and returns the state hash after each tick. Stops when the episode ends.
    fn play(&mut self, py: Python<'_>, actions: Vec<String>) -> PyResult<Vec<String>> {
        let actions = actions.iter().map(|name| action_named(name)).collect::<PyResult<Vec<_>>>()?;
        Ok(py.detach(|| {
            let mut hashes = Vec::with_capacity(actions.len());
            for action in actions {
                if self.state.is_over() {
                    break;
                }
                self.advance(action);
                hashes.push(self.state.state_hash().to_string());
            }
            hashes
        }))
    }

    fn state_hash(&self) -> String {
        self.state.state_hash().to_string()
    }

    fn copy(&self) -> State {
        self.clone()
    }

    fn fork(&self, seed: &str) -> State {
        let seed = seed_of(seed);
        let mut history = self.history.clone();
        history.0.push((seed, Vec::new()));
        State { level: self.level.clone(), state: self.state.fork(seed), history }
    }

    /// Returns a player's observation as a dictionary.
    fn observe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let seen = self.level.game.0.game.observe(&self.state);
        let shown = PyDict::new(py);
        shown.set_item("ticks", seen.ticks)?;
        shown.set_item("score", seen.score)?;
        shown.set_item("outcome", outcome_name(seen.outcome))?;
        shown.set_item("columns", seen.columns)?;
        shown.set_item("rows", seen.rows)?;
        shown.set_item(
            "cells",
            seen.cells.chunks(seen.columns.max(1)).map(<[_]>::to_vec).collect::<Vec<_>>(),
        )?;
        shown.set_item("resources", seen.resources.into_iter().collect::<Vec<_>>())?;
        let avatar = seen.avatar.map(|avatar| {
            (avatar.name, avatar.column, avatar.row, (avatar.facing.x, avatar.facing.y), avatar.health)
        });
        shown.set_item("avatar", avatar)?;
        Ok(shown)
    }

    /// Returns the board's planes as flat bytes, in the format used by `Lanes`.
    fn planes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        let rules = &self.level.game.0;
        let (columns, rows) = self.state.size();
        let planes = Planes::new(&rules.game, rules.looks.shown(), columns as usize, rows as usize);
        let mut board = vec![0; planes.size()];
        planes.draw(&mut self.state.clone(), &mut engine::Drawn::default(), &mut board);
        PyArray1::from_vec(py, board)
    }

    /// Returns the board as lines of characters.
    fn text(&self) -> String {
        render::rows(&self.level.game.0.looks, &self.level.game.0.symbols, &self.state)
    }

    /// Returns the board, the tick, the score, the held resources and the legend as text.
    fn full_text(&self) -> String {
        render::text(&self.level.game.0.looks, &self.level.game.0.symbols, &self.state)
    }

    /// Returns an image of the board: its height, its width and its flat RGB bytes.
    fn rgb<'py>(&self, py: Python<'py>, cell: u32) -> PyResult<(u32, u32, Bound<'py, PyArray1<u8>>)> {
        let image = picture::pixels(&self.level.game.0.looks, &self.state, cell).map_err(invalid)?;
        let bytes = image.pixels.iter().flat_map(|colour| colour.0).collect();
        let array = PyArray1::from_vec(py, bytes);
        Ok((image.height, image.width, array))
    }

    #[pyo3(signature = (cell, *, caption = false, legend = false))]
    fn png<'py>(
        &self,
        py: Python<'py>,
        cell: u32,
        caption: bool,
        legend: bool,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let style = render::Style { cell, caption, legend };
        let drawn = render::picture(&self.level.game.0.looks, &self.state, &style).map_err(invalid)?;
        Ok(PyBytes::new(py, &render::png(&drawn).map_err(failed)?))
    }

    #[pyo3(signature = (cell, *, caption = false, legend = false))]
    fn svg(&self, cell: u32, caption: bool, legend: bool) -> PyResult<String> {
        let style = render::Style { cell, caption, legend };
        Ok(render::svg(&render::picture(&self.level.game.0.looks, &self.state, &style).map_err(invalid)?))
    }

    fn __repr__(&self) -> String {
        let (ticks, score) = (self.ticks(), self.score());
        format!(
            "<State of {} after {}, score {score}, {}>",
            self.level.game.0.name,
            base::count(ticks as usize, "tick"),
            self.outcome()
        )
    }
}
