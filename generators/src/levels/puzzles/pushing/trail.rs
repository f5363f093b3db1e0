//! The trail of a win in a pushing puzzle. Between the pushes of the win, the avatar may rest and walk around.

use crate::games::PushRules;
use crate::levels::grid::{ACTIONS, Grid, WAYS};
use base::Seed;
use engine::{Action, Game, Level, Outcome, SpriteType, State};

/// The pushes of a win, in the order of play. A state consists of the number of pushes so far and the avatar's cell.
pub(crate) struct Trail {
    grid: Grid,
    start: usize,
    /// For each number of pushes and each cell, `true` if the avatar can enter the cell.
    is_open: Vec<Vec<bool>>,
    /// The avatar's cell and the direction of each push.
    pushes: Vec<(usize, usize)>,
}

impl Trail {
    /// Plays a win in a [`PushRules`] level without wandering sprites. Returns `None` if the actions do not win. Costs
    /// one replay of the win.
    pub(crate) fn of(game: &Game, level: &Level, win: &[Action]) -> Option<Trail> {
        let named = |is_one: fn(&str) -> bool| -> Vec<SpriteType> {
            game.sprite_types().filter(|stype| is_one(game.name(*stype))).collect()
        };
        let (things, barriers) = (named(PushRules::is_pushed), named(PushRules::is_barrier));
        let grid = Grid { columns: level.columns(), rows: level.rows() };
        let mut state = game.start(level, Seed::from_text("no chance"));
        let cell = |state: &State, (x, y): (i32, i32)| {
            grid.at((x / state.block()) as usize, (y / state.block()) as usize)
        };
        let cells = |state: &State, stypes: &[SpriteType]| -> Vec<usize> {
            let mut cells: Vec<usize> = stypes
                .iter()
                .flat_map(|&stype| state.places(stype))
                .map(|place| cell(state, place))
                .collect();
            cells.sort_unstable();
            cells
        };
        let open = |state: &State| {
            let mut is_open = vec![true; grid.len()];
            for at in cells(state, &things).into_iter().chain(cells(state, &barriers)) {
                is_open[at] = false;
            }
            is_open
        };
        let start = cell(&state, state.avatar_place()?);
        let mut trail = Trail { grid, start, is_open: vec![open(&state)], pushes: Vec::new() };
        for &action in win {
            let before = (cells(&state, &things), cell(&state, state.avatar_place()?));
            let outcome = game.step(&mut state, action);
            if cells(&state, &things) != before.0 {
                trail.pushes.push((before.1, ACTIONS.iter().position(|&way| way == action)?));
                trail.is_open.push(open(&state));
            }
            if outcome != Outcome::Ongoing {
                return (outcome == Outcome::Won).then_some(trail);
            }
        }
        None
    }

    /// Returns the number of states.
    pub(super) fn states(&self) -> usize {
        (self.pushes.len() + 1) * self.grid.len()
    }

    /// Returns the initial state.
    pub(super) fn start(&self) -> usize {
        self.start
    }

    /// Returns the avatar's cell in a state.
    pub(super) fn cell(&self, state: usize) -> usize {
        state % self.grid.len()
    }

    /// Returns `true` if a state is won.
    pub(super) fn is_won(&self, state: usize) -> bool {
        state / self.grid.len() == self.pushes.len()
    }

    /// Returns the possible steps in a state, each with the state after the step. A step is an index into [`WAYS`], or
    /// `None` for a rest. The only possible push is the next push of the win.
    pub(super) fn ways(&self, state: usize) -> impl Iterator<Item = (Option<usize>, usize)> {
        let (pushed, cell) = (state / self.grid.len(), self.cell(state));
        (0..WAYS.len()).map(Some).chain([None]).filter_map(move |way| {
            let Some(step) = way else { return Some((way, state)) };
            let next = self.grid.shift(cell, WAYS[step])?;
            if self.pushes.get(pushed) == Some(&(cell, step)) {
                return Some((way, (pushed + 1) * self.grid.len() + next));
            }
            self.is_open[pushed][next].then_some((way, pushed * self.grid.len() + next))
        })
    }
}
