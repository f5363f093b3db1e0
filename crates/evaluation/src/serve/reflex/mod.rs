//! A player that reads the board and the rules from the prompt, and takes the shortest path to a good target.
//!
//! The player does not look ahead. It plans a path from one target to the next as if nothing else moved, and
//! avoids deadly sprites. The best targets are sprites whose removal wins the game. Next come sprites that
//! can be collected or that change something, followed by sprites not known to be harmful. The player shoots
//! at sprites that its shots remove.

mod beliefs;

use super::shown::{Shown, You};
use super::{Unanswerable, actions_except_nil};
use agents::route::{Board, DIRECTIONS, Routes};
use base::{Sampler, Seed};
use beliefs::{Beliefs, same_thing};
use engine::describe::Guide;
use engine::{Action, Game};
use std::collections::BTreeMap;

/// The extra cost, in steps, of a step to a cell next to a deadly moving sprite.
const DANGER_COST: u32 = 8;

/// The cost of pushing a sprite, in steps.
const PUSH_COST: u32 = 20;

/// The reciprocal of the probability of a random step. The player has no memory, so without random steps it
/// could repeat a useless path forever.
const RANDOM_STEP_ODDS: usize = 16;

/// Chooses the next steps, up to the number of actions due.
///
/// # Errors
/// Returns an error if the prompt shows no board, or no rules in English or VGDL.
pub(super) fn choose(mut shown: Shown<'_>, seed: Seed) -> Result<Vec<Action>, Unanswerable> {
    // Rules in VGDL are converted to English first.
    let game = shown.vgdl.and_then(|vgdl| Game::from_source(vgdl).ok());
    let guide = game.map(|game| sentences(Guide::of(&game))).unwrap_or_default();
    let rules: Vec<&str> = shown.rules.iter().copied().chain(guide.iter().map(String::as_str)).collect();
    if shown.cells.is_empty() || rules.is_empty() {
        let what = "`reflex` needs the board as a grid, and the rules in words or as VGDL: enable `grid` and the rules";
        return Err(Unanswerable(what.to_owned()));
    }
    let mut choices = seed.sampler();
    let Some(mut you) = shown.you else {
        let keys = actions_except_nil(&shown.actions);
        return Ok((0..shown.due).map(|_| *choices.choose(&keys)).collect());
    };
    let board = Board { columns: shown.columns, rows: shown.cells.len() / shown.columns };
    let held = shown.held.take().unwrap_or_default();
    let beliefs = Beliefs::of(&rules, you.name);
    let mut actions = Vec::new();
    for _ in 0..shown.due {
        let player = Reflex { shown: &shown, you, board, held: &held, beliefs: &beliefs };
        let fire = player.fire();
        let action =
            fire.or_else(|| player.go(&mut choices)).unwrap_or_else(|| player.random_step(&mut choices));
        let entered = player.imagine(action);
        actions.push(action);
        you.facing = if action == Action::Use { you.facing } else { Some(action) };
        if let Some((cell, is_taken)) = entered {
            you.cell = cell;
            let mut is_taken = is_taken.into_iter();
            shown.cells[cell].retain(|_| !is_taken.next().unwrap_or(false));
        }
    }
    Ok(actions)
}

/// Collects all of a guide's sentences about the rules.
fn sentences(guide: Guide) -> Vec<String> {
    let Guide { controls, winning, losing, sprites, groups, timed_effects, meetings, .. } = guide;
    [controls, winning, losing, sprites, groups, timed_effects, meetings].into_iter().flatten().collect()
}

struct Reflex<'a> {
    shown: &'a Shown<'a>,
    you: You<'a>,
    board: Board,
    held: &'a BTreeMap<&'a str, i32>,
    beliefs: &'a Beliefs<'a>,
}

impl Reflex<'_> {
    /// Returns the cell that a step would enter, with one flag per sprite in the cell: `true` if the step
    /// would take the sprite. Other moves and pushes are ignored.
    fn imagine(&self, action: Action) -> Option<(usize, Vec<bool>)> {
        let (_, way) = DIRECTIONS.into_iter().find(|(known, _)| *known == action)?;
        let cell = self.board.beside(self.you.cell, way).filter(|&cell| !self.is_blocked(cell))?;
        Some((cell, self.shown.cells[cell].iter().map(|name| self.is_taken(name)).collect()))
    }

    fn others(&self, cell: usize) -> impl Iterator<Item = &str> {
        self.shown.cells[cell].iter().copied().filter(|name| *name != self.you.name)
    }

    fn is_deadly(&self, cell: usize) -> bool {
        self.others(cell).any(|name| self.beliefs.is_deadly(name, self.held))
    }

    fn is_near_danger(&self, cell: usize) -> bool {
        let moves_and_kills =
            |name: &str| self.beliefs.moves.contains(name) && self.beliefs.is_deadly(name, self.held);
        let beside = DIRECTIONS.into_iter().filter_map(|(_, way)| self.board.beside(cell, way));
        beside.into_iter().any(|beside| self.others(beside).any(moves_and_kills))
    }

    fn is_taken(&self, name: &str) -> bool {
        self.beliefs.is_taken(name, self.held) && !self.beliefs.must_keep.contains(name)
    }

    /// Returns `true` if a cell contains an obstacle that cannot be removed by touching it.
    fn is_blocked(&self, cell: usize) -> bool {
        self.others(cell)
            .any(|name| self.beliefs.blocks.contains(name) && !self.beliefs.is_taken(name, self.held))
    }

    /// Returns a cell's rank as a target, where 0 is best. Returns `None` if the cell is not a target.
    fn rank(&self, cell: usize) -> Option<u32> {
        let rank = |name: &str| {
            let (beliefs, taken) = (self.beliefs, self.is_taken(name));
            if beliefs.is_wanted(name) && taken {
                return Some(0);
            }
            if taken || beliefs.changes.contains(name) {
                return Some(1);
            }
            let known = beliefs.blocks.contains(name)
                || beliefs.pushed.contains(name)
                || beliefs.must_keep.contains(name);
            (!known && !beliefs.is_taken(name, &BTreeMap::new())).then_some(2)
        };
        self.others(cell).filter_map(rank).min()
    }

    /// Returns the cost of entering a cell in a given direction. Returns `None` if the cell kills or cannot
    /// be entered.
    fn entry_cost(&self, cell: usize, way: (isize, isize)) -> Option<u32> {
        if self.is_deadly(cell) || (self.is_blocked(cell) && self.rank(cell).is_none_or(|rank| rank > 1)) {
            return None;
        }
        let near = if self.is_near_danger(cell) { DANGER_COST } else { 0 };
        if self.others(cell).any(|name| self.beliefs.pushed.contains(name)) {
            let free = |beyond: usize| self.others(beyond).next().is_none();
            return self.board.beside(cell, way).is_some_and(free).then_some(PUSH_COST + near);
        }
        Some(1 + near)
    }

    /// Returns the use key if a target is in the line of fire. Otherwise, returns a turn towards a
    /// target in a different direction, if any.
    fn fire(&self) -> Option<Action> {
        let shot = self.beliefs.shot.as_ref()?;
        let has_ammo = |ammo: &&str| {
            let own = |name: &str| same_thing(name, ammo);
            self.held.iter().any(|(name, amount)| *amount > 0 && own(name))
        };
        if !self.shown.actions.contains(&Action::Use)
            || !(shot.ammo.is_empty() || shot.ammo.iter().any(has_ammo))
        {
            return None;
        }
        let always = shot.flight.flatten();
        let reach = if shot.flight.is_some() { usize::MAX } else { 1 };
        let facing =
            always.and_then(|way| DIRECTIONS.into_iter().find(|(action, _)| action.to_string() == way));
        let facing =
            facing.or_else(|| DIRECTIONS.into_iter().find(|(action, _)| Some(*action) == self.you.facing));
        if let Some((_, way)) = facing
            && self.target(way, reach).is_some()
        {
            return Some(Action::Use);
        }
        let turns = DIRECTIONS
            .into_iter()
            .filter(|(action, _)| self.shown.actions.contains(action) && always.is_none());
        let mut seen = turns.filter_map(|(action, way)| Some((self.target(way, reach)?, action)));
        // A target in the adjacent cell is skipped, because it is too close for a turn.
        seen.find(|(distance, _)| *distance > 1).map(|(_, action)| action)
    }

    /// Returns the distance to the nearest target in a given direction; `None` if no target is in sight within `reach`
    /// cells.
    fn target(&self, way: (isize, isize), reach: usize) -> Option<usize> {
        let mut cell = self.you.cell;
        for distance in 1..=reach {
            cell = self.board.beside(cell, way)?;
            let foe = |name: &str| self.beliefs.is_shot(name) && !self.beliefs.must_keep.contains(name);
            if self.others(cell).any(foe) {
                return Some(distance);
            }
            if self
                .others(cell)
                .any(|name| self.beliefs.stops_shots(name) || self.beliefs.blocks.contains(name))
            {
                return None;
            }
        }
        None
    }

    /// Returns the first step to the best reachable target; `None` if no target is reachable. Among equally good
    /// targets, the nearest is chosen.
    fn go(&self, choices: &mut Sampler) -> Option<Action> {
        let enter = |cell: usize, way| self.entry_cost(cell, way);
        let routes = Routes::from(self.board, self.you.cell, &self.shown.actions, enter, |cell| {
            !self.is_blocked(cell)
        });
        let cells = 0..self.shown.cells.len();
        let reached = cells.filter_map(|cell| Some((self.rank(cell)?, routes.to(cell)?)));
        let (_, (cost, first)) = reached.min_by_key(|(rank, (cost, _))| (*rank, *cost))?;
        // The last step to the target is never replaced by a random step.
        (cost == 1 || choices.below(RANDOM_STEP_ODDS) != 0).then_some(first)
    }

    /// Returns a random step that has no known disadvantage.
    fn random_step(&self, choices: &mut Sampler) -> Action {
        let safe = |(action, way): (Action, (isize, isize))| {
            let next = self.board.beside(self.you.cell, way)?;
            let offered = self.shown.actions.contains(&action);
            (offered && self.entry_cost(next, way).is_some() && !self.is_near_danger(next)).then_some(action)
        };
        let safe: Vec<Action> = DIRECTIONS.into_iter().filter_map(safe).collect();
        *choices.choose(&if safe.is_empty() { actions_except_nil(&self.shown.actions) } else { safe })
    }
}
