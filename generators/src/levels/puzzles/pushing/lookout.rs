//! A simulated player among wandering deadly sprites. The player's win rate shows how often a level can be won by
//! looking at the board often enough.

use super::trail::Trail;
use crate::levels::grid::{ACTIONS, Grid, WAYS};
use base::{Sampler, Seed};
use engine::{Action, Game, Level, Outcome, SpriteType};
use std::ops::RangeInclusive;

/// The minimum number of ticks covered by a plan.
const AHEAD: usize = 12;
/// The number of spare ticks with which a state is worth half as much as with unlimited time.
const HALF: f64 = 3.0;
/// The number of ticks after the player's next look in which a collision counts in full. Later collisions can usually
/// be dodged, so the fourth root of the probability of avoiding them is used.
const BLIND: usize = 2;
/// The approximate probability of surviving each tick beyond the plan.
const SURVIVAL: f64 = 0.95;
/// The survival probabilities per tick for further episodes of a game, played by a more and by a less patient player.
const OTHERS: [f64; 2] = [0.98, 0.9];
/// The value for states from which a win is impossible.
const NEVER: u16 = u16::MAX;

/// The wandering deadly sprites at the start of a level, and the floor on which they wander. Only walls stop them.
#[derive(Clone, Debug)]
pub(crate) struct Strays {
    pub(crate) grid: Grid,
    pub(crate) is_floor: Vec<bool>,
    pub(crate) cells: Vec<usize>,
    /// The number of ticks that a wandering sprite takes to move one cell.
    pub(crate) cooldown: usize,
}

impl Strays {
    /// Returns `true` if the wandering sprites move in the given tick. If they do not move in every tick, they rest in
    /// the first tick.
    fn move_in(&self, tick: usize) -> bool {
        (tick + 1).is_multiple_of(self.cooldown)
    }
}

/// A player that knows everything except the future random moves of the wandering sprites. It plans the path with the
/// highest probability of avoiding them, taking the remaining time into account. Collisions in different ticks are
/// treated as independent. The resulting win rate is a lower bound on the win rate of an optimal player.
pub(crate) struct Lookout {
    strays: Strays,
    trail: Trail,
    /// For each state, the states after each step, with their cells.
    steps: Vec<Vec<(usize, usize)>>,
    /// The number of ticks until the time runs out.
    ticks: usize,
    /// For each tick and each state before it, the earliest tick at which the player could win without wandering
    /// sprites, or [`NEVER`].
    finish: Vec<u16>,
    /// For each number of ticks, the probability of surviving that long.
    survival: Vec<f64>,
}

impl Lookout {
    /// Creates a player. Cost: O(ticks · states) in time and memory.
    pub(crate) fn new(strays: Strays, trail: Trail, ticks: usize) -> Lookout {
        let states = trail.states();
        let with_cell = |next: usize| (next, trail.cell(next));
        let steps: Vec<Vec<(usize, usize)>> =
            (0..states).map(|state| trail.ways(state).map(|(_, next)| with_cell(next)).collect()).collect();
        let mut finish = vec![NEVER; (ticks + 1) * states];
        for tick in (0..=ticks).rev() {
            let (now, later) = finish[tick * states..].split_at_mut(states);
            for (state, finish) in now.iter_mut().enumerate() {
                *finish = if trail.is_won(state) {
                    tick as u16
                } else if tick == ticks {
                    NEVER
                } else {
                    steps[state].iter().map(|(next, _)| later[*next]).min().unwrap_or(NEVER)
                };
            }
        }
        Lookout { strays, trail, steps, ticks, finish, survival: survival(SURVIVAL, ticks) }
    }

    /// Returns the avatar's initial cell.
    pub(crate) fn start(&self) -> usize {
        self.trail.cell(self.trail.start())
    }

    /// Places wandering deadly sprites in the first of the `cells`. Uses the largest number in the range such that this
    /// number and all smaller ones are fair. A number is fair if a player that looks before every tick wins at least a
    /// fraction `share` of `plays` episodes. Returns the number, or `None` if even the smallest one is not fair.
    pub(crate) fn most_fair(
        &mut self,
        cells: &[usize],
        numbers: RangeInclusive<usize>,
        share: f64,
        plays: usize,
        sampler: &mut Sampler,
    ) -> Option<usize> {
        let is_fair = |number: &usize| {
            let Some(cells) = cells.get(..*number) else { return false };
            self.strays.cells = cells.to_vec();
            self.wins(share, plays, sampler)
        };
        let number = numbers.take_while(is_fair).last()?;
        self.strays.cells = cells[..number].to_vec();
        Some(number)
    }

    /// Returns the fraction of `plays` episodes that the player wins if it looks at the wandering sprites every
    /// `commit` ticks.
    pub(crate) fn rate(&self, commit: usize, plays: usize, sampler: &mut Sampler) -> f64 {
        let won = (0..plays).filter(|_| self.play(commit, sampler)).count();
        won as f64 / plays.max(1) as f64
    }

    /// Returns `true` if the player wins at least a fraction `share` of `plays` episodes when it looks before every
    /// tick. Stops as soon as the result is certain.
    fn wins(&self, share: f64, plays: usize, sampler: &mut Sampler) -> bool {
        let needed = ((share * plays as f64).ceil() as usize).min(plays);
        let (mut won, mut lost) = (0, 0);
        while won < needed && lost <= plays - needed {
            if self.play(1, sampler) { won += 1 } else { lost += 1 }
        }
        won >= needed
    }

    fn play(&self, commit: usize, sampler: &mut Sampler) -> bool {
        let mut strays = self.strays.cells.clone();
        let (mut tick, mut state) = (0, self.trail.start());
        while tick < self.ticks {
            let Some(plan) = self.plan(tick, state, &strays, commit) else { return false };
            for next in plan {
                state = next;
                if self.strays.move_in(tick) {
                    for stray in &mut strays {
                        let way = WAYS[sampler.below(WAYS.len())];
                        *stray = self.walked(*stray, way);
                    }
                }
                tick += 1;
                if strays.contains(&self.trail.cell(state)) {
                    return false;
                }
                if self.trail.is_won(state) {
                    return true;
                }
            }
        }
        false
    }

    /// Plays the game, looking before every tick. `stray` is the type of the wandering sprites. If the first episode is
    /// lost, retries with a more patient and a less patient player. Returns a winning sequence of actions; `None` if
    /// all episodes are lost.
    pub(crate) fn win_game(
        &mut self,
        game: &Game,
        level: &Level,
        stray: SpriteType,
        seed: Seed,
    ) -> Option<Vec<Action>> {
        let won = self.play_game(game, level, stray, 1, seed);
        OTHERS.into_iter().fold(won, |won, patience| {
            won.or_else(|| {
                self.survival = survival(patience, self.ticks);
                self.play_game(game, level, stray, 1, seed)
            })
        })
    }

    /// Plays the game once, looking every `commit` ticks. Returns the actions if they win.
    pub(crate) fn play_game(
        &self,
        game: &Game,
        level: &Level,
        stray: SpriteType,
        commit: usize,
        seed: Seed,
    ) -> Option<Vec<Action>> {
        let grid = self.strays.grid;
        let mut state = game.start(level, seed);
        let block = state.block();
        // There may be rows above the grid that contain other things.
        let above = level.rows() - grid.rows;
        let cell = |(x, y): (i32, i32)| grid.at((x / block) as usize, (y / block) as usize - above);
        let mut place = self.trail.start();
        let mut actions = Vec::new();
        while actions.len() < self.ticks {
            let strays: Vec<usize> = state.places(stray).map(cell).collect();
            let plan = self.plan(actions.len(), place, &strays, commit)?;
            for action in self.keys(place, &plan)? {
                actions.push(action);
                let outcome = game.step(&mut state, action);
                if outcome != Outcome::Ongoing {
                    return (outcome == Outcome::Won).then_some(actions);
                }
            }
            place = *plan.last()?;
        }
        None
    }

    /// Returns the actions of the plan with the highest probability of winning without looking again; `None` if no path
    /// wins in time.
    pub(crate) fn blind_plan(&self) -> Option<Vec<Action>> {
        let start = self.trail.start();
        self.keys(start, &self.plan(0, start, &self.strays.cells, self.ticks)?)
    }

    /// Returns the actions that lead from a state through the states of a plan.
    fn keys(&self, mut place: usize, plan: &[usize]) -> Option<Vec<Action>> {
        let key = |&next: &usize| {
            let way = self.trail.ways(place).find(|(_, after)| *after == next)?.0;
            place = next;
            Some(way.map_or(Action::Nil, |way| ACTIONS[way]))
        };
        plan.iter().map(key).collect()
    }

    /// Returns the states in the best plan for the next `commit` ticks, or until the plan wins; `None` if no path wins
    /// in time.
    fn plan(&self, tick: usize, state: usize, strays: &[usize], commit: usize) -> Option<Vec<usize>> {
        let last = (tick + commit.max(AHEAD)).min(self.ticks);
        let clear = self.clear(tick, last, strays);
        let states = self.trail.states();
        // For each tick, the possible states. Each state has its possible steps, as indices into the next layer.
        let mut layers: Vec<Vec<(usize, Vec<usize>)>> = vec![vec![(state, Vec::new())]];
        let mut places = vec![usize::MAX; states];
        for now in tick..last {
            let mut next_layer: Vec<(usize, Vec<usize>)> = Vec::new();
            let layer = layers.last_mut()?;
            for (state, steps) in layer.iter_mut().filter(|(state, _)| !self.trail.is_won(*state)) {
                for &(next, _) in &self.steps[*state] {
                    if self.finish[(now + 1) * states + next] == NEVER {
                        continue;
                    }
                    if next_layer.get(places[next]).is_none_or(|(at, _)| *at != next) {
                        places[next] = next_layer.len();
                        next_layer.push((next, Vec::new()));
                    }
                    steps.push(places[next]);
                }
            }
            layers.push(next_layer);
        }
        // The value of each state and the best step from it, computed from the last tick back.
        let mut worth: Vec<Vec<(f64, usize)>> = vec![Vec::new(); layers.len()];
        for (depth, layer) in layers.iter().enumerate().rev() {
            let now = tick + depth;
            let (head, tail) = worth.split_at_mut(depth + 1);
            let later = tail.first().map_or(&[][..], Vec::as_slice);
            head[depth] = layer
                .iter()
                .map(|(state, steps)| {
                    let mut clear = if depth == 0 { 1.0 } else { clear[depth - 1][self.trail.cell(*state)] };
                    if depth > commit + BLIND {
                        clear = clear.sqrt().sqrt();
                    }
                    if self.trail.is_won(*state) {
                        return (clear, usize::MAX);
                    }
                    if now == last {
                        let finish = self.finish[now * states + state];
                        let finish = usize::from(finish);
                        let spare = self.ticks.saturating_sub(finish) as f64;
                        let survives = self.survival[finish.saturating_sub(last).min(self.ticks)];
                        return (clear * survives * (spare + 1.0) / (spare + 1.0 + HALF), usize::MAX);
                    }
                    let best = steps.iter().map(|&step| (later[step].0, step));
                    let (value, step) =
                        best.max_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or((0.0, usize::MAX));
                    (clear * value, step)
                })
                .collect();
        }
        let mut plan = Vec::new();
        let mut at = 0;
        for depth in 0..layers.len() - 1 {
            let (_, step) = worth[depth][at];
            if step == usize::MAX || plan.len() == commit {
                break;
            }
            at = step;
            plan.push(layers[depth + 1][at].0);
        }
        (!plan.is_empty()).then_some(plan)
    }

    /// Returns, for each tick after `tick` up to `last` and for each cell, the probability that the cell contains no
    /// wandering sprite.
    fn clear(&self, tick: usize, last: usize, strays: &[usize]) -> Vec<Vec<f64>> {
        let cells = self.strays.grid.len();
        let one = |&stray: &usize| {
            let mut at = vec![0.0; cells];
            at[stray] = 1.0;
            at
        };
        let mut each: Vec<Vec<f64>> = strays.iter().map(one).collect();
        (tick..last)
            .map(|now| {
                if self.strays.move_in(now) {
                    for at in &mut each {
                        let mut moved = vec![0.0; cells];
                        for cell in (0..cells).filter(|&cell| at[cell] > 0.0) {
                            for way in WAYS {
                                moved[self.walked(cell, way)] += at[cell] / WAYS.len() as f64;
                            }
                        }
                        *at = moved;
                    }
                }
                (0..cells).map(|cell| each.iter().map(|at| 1.0 - at[cell]).product()).collect()
            })
            .collect()
    }

    /// Returns a wandering sprite's cell after a step in the given direction.
    fn walked(&self, cell: usize, way: (i32, i32)) -> usize {
        self.strays.grid.shift(cell, way).filter(|&next| self.strays.is_floor[next]).unwrap_or(cell)
    }
}

/// Returns, for each number of ticks, the probability of surviving that long.
fn survival(each: f64, ticks: usize) -> Vec<f64> {
    std::iter::successors(Some(1.0), |last| Some(last * each)).take(ticks + 1).collect()
}
