//! The touch-everything player, which experiments instead of reading the rules.

mod beliefs;

pub use beliefs::Experience;

use crate::planner::{Budget, Planner};
use crate::route::{self, Board, Routes};
use base::{Sampler, Seed};
use beliefs::{Beliefs, Circumstances, Passed, circumstances};
use engine::{Action, Game, Observation, State};
use std::collections::BTreeMap;

/// The number of key presses towards a sprite after which the sprite counts as touched, even if they had no effect.
const MOST_PRESSES: u32 = 4;

/// The odds of a random step: one decision in `RANDOM_STEP_ODDS`. Without random steps, the player could repeat a
/// fruitless path forever.
const RANDOM_STEP_ODDS: usize = 16;

/// The odds of pressing the use key: one decision in `USE_ODDS`, until the key has had no effect `MOST_IDLE_USES`
/// times in the same context.
const USE_ODDS: usize = 6;
const MOST_IDLE_USES: u32 = 3;

/// The extra cost, in steps, of a step next to a deadly kind.
const DANGER_COST: u32 = 8;
/// The extra cost, in steps, of a push.
const PUSH_COST: u32 = 5;

/// A player that does not know the rules. It walks to the nearest kind of sprite that it has not touched yet,
/// preferring motionless kinds. By observation, it learns which contacts end the game, bring a reward or block the
/// avatar. It takes rewarding kinds first, avoids deadly kinds, and tries blocking kinds again when the avatar holds
/// different resources.
///
/// The player sees only observations, even when used as a [`Planner`]. It uses no other information about the
/// game or the state, and makes no forward-model calls. Its knowledge persists from level to level, until
/// [`forget`](TouchEverything::forget) is called.
#[derive(Clone, Debug)]
pub struct TouchEverything {
    choices: Sampler,
    beliefs: Beliefs,
    /// The last observation, and the actions chosen for it; `None` at the start of an episode.
    last: Option<(Observation, Vec<Action>)>,
    /// The number of key presses towards each kind since the kind was last touched.
    presses: BTreeMap<String, u32>,
    /// The number of presses of the use key that had no visible effect (nothing appeared, disappeared or
    /// changed), by context.
    idle_uses: BTreeMap<Circumstances, u32>,
}

impl TouchEverything {
    /// Creates a player with its own random-number stream.
    pub fn new(seed: Seed) -> TouchEverything {
        TouchEverything {
            choices: seed.child("choices", 0).sampler(),
            beliefs: Beliefs::default(),
            last: None,
            presses: BTreeMap::new(),
            idle_uses: BTreeMap::new(),
        }
    }

    /// Chooses at least one action, and at most `due` actions. If several actions are due, the player assumes that
    /// nothing but the avatar moves. Cost: O(cells log cells) per target.
    pub fn act(&mut self, seen: &Observation, actions: &[Action], due: usize) -> Vec<Action> {
        self.learn(seen);
        let mut imagined = seen.clone();
        let mut beliefs = self.beliefs.clone();
        let mut chosen = Vec::new();
        while chosen.len() < due.max(1) {
            let action = self.choose(&imagined, &beliefs, actions);
            chosen.push(action);
            if chosen.len() < due {
                imagine(&mut imagined, &mut beliefs, action);
            }
        }
        self.last = Some((seen.clone(), chosen.clone()));
        chosen
    }

    /// Learns from the end of an episode.
    pub fn end(&mut self, last: &Observation) {
        self.learn(last);
        self.last = None;
        self.presses.clear();
    }

    /// Forgets everything. The player must forget before it plays a different game.
    pub fn forget(&mut self) {
        (self.beliefs, self.last) = (Beliefs::default(), None);
        self.presses.clear();
        self.idle_uses.clear();
    }

    /// Returns the experience with a kind of sprite, if that kind was touched.
    pub fn experience(&self, kind: &str) -> Option<&Experience> {
        self.beliefs.of(kind)
    }

    /// Learns from the effects of the last actions.
    fn learn(&mut self, now: &Observation) {
        let Some((before, actions)) = self.last.take() else { return };
        let is_same = (before.columns, before.rows) == (now.columns, now.rows) && now.ticks >= before.ticks;
        let Some(from) = cell(&before).filter(|_| is_same) else { return };
        if actions == [Action::Use] && before.resources == now.resources && kinds(&before) == kinds(now) {
            *self.idle_uses.entry(circumstances(&before)).or_default() += 1;
        }
        let board = Board::of(&before);
        let mut passed = Passed {
            before: &before,
            now,
            touched: &[],
            beside: &[],
            in_the_way: &[],
            entered: &[],
            pushed: &[],
        };
        let here = cell(now);
        let mut cells = vec![from];
        for action in &actions {
            let at = cells[cells.len() - 1];
            cells.extend(route::way(*action).and_then(|way| board.beside(at, way)));
        }
        let target = (actions.len() == 1 && cells.len() == 2).then(|| cells[1]);
        let others = |seen: &Observation, cell: usize| -> Vec<String> {
            let is_own = |name: &&String| [&before, now].iter().any(|seen| is_avatar(seen, name));
            seen.cells[cell].iter().filter(|name| !is_own(name)).cloned().collect()
        };
        let mut touched: Vec<String> = cells.iter().flat_map(|&cell| others(&before, cell)).collect();
        let arrived: Vec<String> =
            here.or(Some(cells[cells.len() - 1])).iter().flat_map(|&cell| others(now, cell)).collect();
        touched.extend(arrived);
        let around = cells.iter().flat_map(|&cell| board.around(cell));
        let beside: Vec<String> = around.flat_map(|cell| others(&before, cell)).collect();
        let facing = |seen: &Observation| seen.avatar.as_ref().map(|avatar| avatar.facing);
        let is_stuck = here == Some(from) && facing(&before) == facing(now);
        let at_target: Vec<String> = target.map(|cell| others(&before, cell)).unwrap_or_default();
        let (mut in_the_way, mut entered, mut pushed) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(target) = target {
            let still_there = others(now, target);
            if is_stuck {
                in_the_way = at_target.iter().filter(|kind| still_there.contains(kind)).cloned().collect();
                // A kind that is also under the avatar does not block it.
                in_the_way.retain(|kind| !others(now, from).contains(kind));
            } else if here == Some(target) {
                let beyond = route::way(actions[0]).and_then(|way| board.beside(target, way));
                let is_beyond = |kind: &&String| {
                    beyond.is_some_and(|cell| {
                        others(now, cell).contains(kind) && !others(&before, cell).contains(kind)
                    })
                };
                pushed = at_target.iter().filter(is_beyond).cloned().collect();
                entered = at_target.clone();
            }
            // If the avatar only turned, it touched nothing.
            if here == Some(from) && !is_stuck {
                touched.retain(|kind| !at_target.contains(kind));
            }
        }
        touched.sort();
        touched.dedup();
        self.presses.retain(|kind, _| touched.binary_search(kind).is_err());
        passed.touched = &touched;
        passed.beside = &beside;
        passed.in_the_way = &in_the_way;
        passed.entered = &entered;
        passed.pushed = &pushed;
        self.beliefs.learn(&passed);
    }

    fn choose(&mut self, seen: &Observation, beliefs: &Beliefs, actions: &[Action]) -> Action {
        let keys: Vec<Action> = actions.iter().copied().filter(|&action| action != Action::Nil).collect();
        let Some(from) = cell(seen).filter(|_| !keys.is_empty()) else {
            return if keys.is_empty() { Action::Nil } else { *self.choices.choose(&keys) };
        };
        let idle_uses = self.idle_uses.get(&circumstances(seen)).copied().unwrap_or_default();
        let is_use = keys.contains(&Action::Use) && idle_uses < MOST_IDLE_USES;
        if is_use && self.choices.below(USE_ODDS) == 0 {
            return Action::Use;
        }
        let keys: Vec<Action> = keys.into_iter().filter(|&key| is_use || key != Action::Use).collect();
        if keys.is_empty() {
            return Action::Nil;
        }
        let view = View { seen, beliefs, board: Board::of(seen), from, circumstances: circumstances(seen) };
        let routes =
            Routes::from(view.board, from, &keys, |cell, _| view.cost(cell), |cell| view.passes(cell));
        let cells = (0..seen.cells.len()).filter(|&cell| cell != from);
        let reached = cells.filter_map(|cell| Some((view.rank(cell)?, routes.to(cell)?, cell)));
        let best = reached.min_by_key(|&(rank, (cost, _), cell)| (rank, cost, cell));
        let Some((_, (_, first), target)) = best else { return self.random_step(&view, &keys) };
        let is_next = route::way(first).and_then(|way| view.board.beside(from, way)) == Some(target);
        if is_next {
            for kind in view.others(target) {
                let presses = self.presses.entry(kind.to_owned()).or_default();
                *presses += 1;
                if *presses > MOST_PRESSES {
                    self.beliefs.give_up(kind, &view.circumstances);
                    self.presses.remove(kind);
                }
            }
            return first;
        }
        if self.choices.below(RANDOM_STEP_ODDS) == 0 { self.random_step(&view, &keys) } else { first }
    }

    /// Returns a random step that leads to no known danger or obstacle.
    fn random_step(&mut self, view: &View<'_>, keys: &[Action]) -> Action {
        let is_safe = |action: &Action| match route::way(*action) {
            Some(way) => view
                .board
                .beside(view.from, way)
                .is_some_and(|next| view.cost(next).is_some_and(|cost| cost < DANGER_COST)),
            None => true,
        };
        let safe: Vec<Action> = keys.iter().copied().filter(is_safe).collect();
        *self.choices.choose(if safe.is_empty() { keys } else { &safe })
    }
}

impl Planner for TouchEverything {
    fn plan(&mut self, game: &Game, state: &State, _: Budget) -> (Action, u64) {
        (self.act(&game.observe(state), game.actions(state), 1)[0], 0)
    }
}

/// A board with the player's beliefs about its cells.
struct View<'a> {
    seen: &'a Observation,
    beliefs: &'a Beliefs,
    board: Board,
    from: usize,
    circumstances: Circumstances,
}

impl View<'_> {
    fn others(&self, cell: usize) -> impl Iterator<Item = &str> {
        self.seen.cells[cell].iter().filter(|name| !is_avatar(self.seen, name)).map(String::as_str)
    }

    fn is_blocked_by(&self, kind: &str) -> bool {
        let known = self.beliefs.of(kind);
        known.is_some_and(|known| known.blocked.contains(&self.circumstances) && !known.is_good())
    }

    /// Returns `true` for a cell that the avatar is known to be able to cross.
    fn passes(&self, cell: usize) -> bool {
        self.others(cell).all(|kind| self.beliefs.of(kind).is_some()) && self.cost(cell).is_some()
    }

    /// Returns the cost of entering a cell, or `None` if entering is deadly or known to be impossible.
    fn cost(&self, cell: usize) -> Option<u32> {
        let is_closed = |kind: &str| {
            (self.beliefs.is_deadly(kind) && !self.is_worth_another_try(kind)) || self.is_blocked_by(kind)
        };
        if self.others(cell).any(is_closed) {
            return None;
        }
        let is_near_danger = self
            .board
            .around(cell)
            .any(|beside| self.others(beside).any(|kind| self.beliefs.is_deadly(kind)));
        let is_pushed =
            self.others(cell).any(|kind| self.beliefs.of(kind).is_some_and(|known| known.pushed > 0));
        Some(1 + if is_near_danger { DANGER_COST } else { 0 } + if is_pushed { PUSH_COST } else { 0 })
    }

    /// Returns `true` if the avatar holds something, and has never touched the kind with its current type and
    /// resources.
    fn is_worth_another_try(&self, kind: &str) -> bool {
        self.beliefs.of(kind).is_none_or(|known| !known.touched.contains(&self.circumstances))
            && !self.circumstances.1.is_empty()
    }

    /// Returns the rank of a cell as a target, where 0 is best; `None` if the cell is not a target.
    fn rank(&self, cell: usize) -> Option<u32> {
        let is_mover = |kind: &str| self.seen.movers.iter().any(|mover| mover.name == kind);
        let rank = |kind: &str| {
            let Some(known) = self.beliefs.of(kind) else {
                return Some(if is_mover(kind) { 2 } else { 1 });
            };
            let is_tried = known.touched.contains(&self.circumstances);
            match () {
                () if known.is_good() => Some(0),
                () if known.gain < 0 => (!is_tried).then_some(6),
                () if known.is_deadly() => (!is_tried && self.is_worth_another_try(kind)).then_some(5),
                () if known.pushed > 0 => Some(7),
                () if is_tried => None,
                () if known.is_blocking() => Some(3),
                () => (!known.entered).then_some(4),
            }
        };
        self.others(cell).filter_map(rank).min()
    }
}

/// Returns the avatar's cell; `None` without an avatar.
fn cell(seen: &Observation) -> Option<usize> {
    let avatar = seen.avatar.as_ref()?;
    let column = usize::try_from(avatar.column).ok().filter(|&column| column < seen.columns)?;
    let row = usize::try_from(avatar.row).ok().filter(|&row| row < seen.rows)?;
    Some(row * seen.columns + column)
}

/// Returns the number of cells that contain each kind of sprite.
fn kinds(seen: &Observation) -> BTreeMap<&str, usize> {
    let mut kinds = BTreeMap::new();
    for kind in seen.cells.iter().flatten() {
        *kinds.entry(kind.as_str()).or_default() += 1;
    }
    kinds
}

fn is_avatar(seen: &Observation, name: &str) -> bool {
    seen.avatar.as_ref().is_some_and(|avatar| avatar.name == name)
}

/// Moves the avatar in an observation as if nothing else moved, and removes the sprites that the avatar is
/// likely to take.
fn imagine(seen: &mut Observation, beliefs: &mut Beliefs, action: Action) {
    let Some(from) = cell(seen) else { return };
    let board = Board::of(seen);
    let Some(to) = route::way(action).and_then(|way| board.beside(from, way)) else { return };
    let now = circumstances(seen);
    let name = seen.avatar.as_ref().map(|avatar| avatar.name.clone()).unwrap_or_default();
    let mut is_closed = false;
    seen.cells[to].retain(|kind| {
        let known = beliefs.of(kind).cloned().unwrap_or_default();
        is_closed |= known.blocked.contains(&now) && !known.is_good();
        beliefs.give_up(kind, &now);
        !known.is_good()
    });
    if is_closed {
        return;
    }
    seen.cells[from].retain(|kind| *kind != name);
    seen.cells[to].push(name);
    if let Some(avatar) = &mut seen.avatar {
        (avatar.column, avatar.row) = ((to % board.columns) as i32, (to / board.columns) as i32);
    }
}
