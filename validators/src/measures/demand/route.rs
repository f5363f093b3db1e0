//! The route of a win, and the sprites that come next to it.

use engine::analysis::{Motion, Role};
use engine::{Analysis, Episode, Level, SpriteType, State};
use std::collections::BTreeSet;

/// The cells that the avatar enters during a win.
pub(super) struct Route {
    pub(super) cells: BTreeSet<(i32, i32)>,
    /// The number of self-moving sprites, not counting the player's shots, that enter or come next to one of the
    /// cells.
    pub(super) movers: usize,
}

impl Route {
    /// Computes the route. Costs two replays of the win, inspecting all sprites in each tick.
    pub(super) fn of(analysis: &Analysis, level: &Level, win: &Episode) -> Route {
        let game = analysis.game();
        let moves = |stype: SpriteType| {
            !matches!(analysis.facts(stype).motion, Motion::Still | Motion::Steered)
                && !matches!(analysis.role(stype), Role::Shot | Role::Avatar)
        };
        let moves: Vec<bool> = game.sprite_types().map(moves).collect();
        let mut cells = BTreeSet::new();
        each_state(analysis, level, win, |state| cells.extend(avatar_cell(state)));
        let mut near = BTreeSet::new();
        if moves.contains(&true) {
            each_state(analysis, level, win, |state| {
                let block = state.block();
                let movers =
                    game.records(state).into_iter().filter(|record| moves[usize::from(record.stype)]);
                for mover in movers {
                    let (x, y) = (mover.rect.x.div_euclid(block), mover.rect.y.div_euclid(block));
                    let beside = (-1..=1).any(|dx| (-1..=1).any(|dy| cells.contains(&(x + dx, y + dy))));
                    if beside {
                        near.insert(mover.id);
                    }
                }
            });
        }
        Route { cells, movers: near.len() }
    }

    /// Returns the number of steps from a cell to the nearest cell on the route.
    pub(super) fn distance(&self, (x, y): (i32, i32)) -> i32 {
        self.cells.iter().map(|&(column, row)| (column - x).abs() + (row - y).abs()).min().unwrap_or(0)
    }
}

/// Returns the avatar's cell, or `None` if the avatar is dead.
pub(super) fn avatar_cell(state: &State) -> Option<(i32, i32)> {
    let block = state.block();
    state.avatar_place().map(|(x, y)| (x.div_euclid(block), y.div_euclid(block)))
}

fn each_state(analysis: &Analysis, level: &Level, win: &Episode, mut look: impl FnMut(&State)) {
    let game = analysis.game();
    let mut state = game.start(level, win.seed);
    look(&state);
    for &action in &win.actions {
        game.step(&mut state, action);
        look(&state);
    }
}
