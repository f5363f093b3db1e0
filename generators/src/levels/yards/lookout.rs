//! A careful player of yards with strays: how often can a level be won by whoever looks often enough?

use super::timetable::Errands;
use super::yard::Yard;
use crate::levels::grid::WAYS;
use engine::Sampler;

/// Ticks that a plan looks ahead, at least.
const AHEAD: usize = 12;
/// With so many ticks to spare, a state is worth half of one with any number.
const HALF: f64 = 3.0;
/// No win from here.
const NEVER: u16 = u16::MAX;

/// A player that knows the carts exactly, and of the strays where they are and how they move: it plans the way on which it
/// meets none with the greatest probability, as if they were independent from tick to tick, and keeps an eye on the fuse. Its
/// wins are a lower bound of what looking can win, not the best play.
pub(super) struct Lookout<'a> {
    yard: &'a Yard,
    errands: Errands<'a>,
    /// By state: the states after each step, whatever the carts, with their cells.
    steps: Vec<Vec<(usize, usize)>>,
    /// The ticks that the fuse leaves.
    ticks: usize,
    /// By tick and state before it: the least tick of a win without strays, or [`NEVER`].
    finish: Vec<u16>,
}

impl<'a> Lookout<'a> {
    /// Cost: O(ticks · cells · 2^parcels) in time and memory.
    pub(super) fn new(yard: &'a Yard, errands: Errands<'a>, ticks: usize) -> Lookout<'a> {
        let (states, ticks) = (errands.states(), ticks.min(errands.ticks()));
        let with_cell = |next: usize| (next, errands.cell(next));
        let steps: Vec<Vec<(usize, usize)>> =
            (0..states).map(|state| errands.ways(state).map(|(_, next)| with_cell(next)).collect()).collect();
        let mut finish = vec![NEVER; (ticks + 1) * states];
        for tick in (0..=ticks).rev() {
            let (now, later) = finish[tick * states..].split_at_mut(states);
            for (state, finish) in now.iter_mut().enumerate() {
                *finish = if errands.is_won(state) {
                    tick as u16
                } else if tick == ticks {
                    NEVER
                } else {
                    let free = steps[state].iter().filter(|(_, cell)| !errands.is_busy(tick, *cell));
                    free.map(|(next, _)| later[*next]).min().unwrap_or(NEVER)
                };
            }
        }
        Lookout { yard, errands, steps, ticks, finish }
    }

    /// The share of `plays` that are won with a look at the strays before every `commit` ticks.
    pub(super) fn rate(&self, commit: usize, plays: usize, sampler: &mut Sampler) -> f64 {
        let won = (0..plays).filter(|_| self.play(commit, sampler)).count();
        won as f64 / plays.max(1) as f64
    }

    /// Returns `true` if at least this share of `plays` is won with a look before every tick; stops as soon as that is settled.
    pub(super) fn wins(&self, share: f64, plays: usize, sampler: &mut Sampler) -> bool {
        let needed = ((share * plays as f64).ceil() as usize).min(plays);
        let (mut won, mut lost) = (0, 0);
        while won < needed && lost <= plays - needed {
            if self.play(1, sampler) { won += 1 } else { lost += 1 }
        }
        won >= needed
    }

    fn play(&self, commit: usize, sampler: &mut Sampler) -> bool {
        let mut strays = self.yard.strays.clone();
        let (mut tick, mut state) = (0, self.errands.start());
        while tick < self.ticks {
            let Some(plan) = self.plan(tick, state, &strays, commit) else { return false };
            for next in plan {
                state = next;
                if moves(tick) {
                    for stray in &mut strays {
                        let way = WAYS[sampler.below(WAYS.len())];
                        *stray = self.walked(*stray, way);
                    }
                }
                tick += 1;
                if strays.contains(&self.errands.cell(state)) {
                    return false;
                }
                if self.errands.is_won(state) {
                    return true;
                }
            }
        }
        false
    }

    /// The states of the best plan for the next `commit` ticks, or until it wins; `None` if no way wins in time.
    fn plan(&self, tick: usize, state: usize, strays: &[usize], commit: usize) -> Option<Vec<usize>> {
        let last = (tick + commit.max(AHEAD)).min(self.ticks);
        let clear = self.clear(tick, last, strays);
        let states = self.errands.states();
        // By tick: states, each with its steps on as places in the next layer.
        let mut layers: Vec<Vec<(usize, Vec<usize>)>> = vec![vec![(state, Vec::new())]];
        let mut places = vec![usize::MAX; states];
        for now in tick..last {
            let mut next_layer: Vec<(usize, Vec<usize>)> = Vec::new();
            let layer = layers.last_mut()?;
            for (state, steps) in layer.iter_mut().filter(|(state, _)| !self.errands.is_won(*state)) {
                for &(next, cell) in &self.steps[*state] {
                    if self.errands.is_busy(now, cell) || self.finish[(now + 1) * states + next] == NEVER {
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
        // From the last tick back: the probability of a way, and the step to it.
        let mut worth: Vec<Vec<(f64, usize)>> = vec![Vec::new(); layers.len()];
        for (depth, layer) in layers.iter().enumerate().rev() {
            let now = tick + depth;
            let (head, tail) = worth.split_at_mut(depth + 1);
            let later = tail.first().map_or(&[][..], Vec::as_slice);
            head[depth] = layer
                .iter()
                .map(|(state, steps)| {
                    let clear = if depth == 0 { 1.0 } else { clear[depth - 1][self.errands.cell(*state)] };
                    if self.errands.is_won(*state) {
                        return (clear, usize::MAX);
                    }
                    if now == last {
                        let finish = self.finish[now * states + state];
                        let spare = self.ticks.saturating_sub(usize::from(finish)) as f64;
                        return (clear * (spare + 1.0) / (spare + 1.0 + HALF), usize::MAX);
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

    /// For each tick after `tick` up to `last`, by cell, the probability that no stray is there.
    fn clear(&self, tick: usize, last: usize, strays: &[usize]) -> Vec<Vec<f64>> {
        let cells = self.yard.grid.len();
        let one = |&stray: &usize| {
            let mut at = vec![0.0; cells];
            at[stray] = 1.0;
            at
        };
        let mut each: Vec<Vec<f64>> = strays.iter().map(one).collect();
        (tick..last)
            .map(|now| {
                if moves(now) {
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

    /// The cell of a stray after a step this way.
    fn walked(&self, cell: usize, way: (i32, i32)) -> usize {
        self.yard.grid.shift(cell, way).filter(|&next| self.yard.is_floor[next]).unwrap_or(cell)
    }
}

/// Strays rest in every second tick, and in the first.
fn moves(tick: usize) -> bool {
    tick % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::super::timetable::Timetable;
    use super::super::yard::Furniture;
    use super::super::{ACTIONS, text};
    use super::*;
    use crate::games::YardRules;
    use crate::levels::grid::Grid;
    use engine::{Action, Outcome, Seed};

    /// In the game, strays move as here, and as many plays are won.
    #[test]
    fn plays_of_the_game_agree() {
        const FUSE: usize = 6;
        let rules = YardRules::ALL.into_iter().find(|rules| rules.has_strays()).unwrap();
        let grid = Grid { columns: 11, rows: 10 };
        let furniture = Furniture { carts: 3, parcels: 2, strays: 4, steps: 40 };
        let drawn = |number: u64| {
            let mut sampler = Seed::from_text("lookout").child("yard", number).sampler();
            let mut yard = Yard::draw(rules, grid, furniture.carts, &mut sampler)?;
            let timetable = Timetable::of(&yard, YardRules::BURN * FUSE)?;
            yard.furnish(rules, furniture, &timetable.visits, &mut sampler)?;
            timetable.fastest(&yard, YardRules::BURN * (FUSE - 1))?;
            Some((yard, timetable))
        };
        let (yard, timetable) = (0..200).find_map(drawn).unwrap();
        let lookout = Lookout::new(&yard, Errands::new(&yard, &timetable), YardRules::BURN * FUSE - 1);
        let expected = lookout.rate(1, 200, &mut Seed::from_text("plays").sampler());
        assert!((0.2..0.95).contains(&expected), "{expected}");

        let game = rules.game();
        let level = game.level(&text(&yard, FUSE)).unwrap();
        let stray = game.sprite_types().find(|stype| game.name(*stype) == "stray").unwrap();
        const PLAYS: u64 = 40;
        let mut won = 0;
        for play in 0..PLAYS {
            let mut state = game.start(&level, Seed::from_text("dice").child("play", play));
            let block = state.block();
            // The fuse has a row of its own.
            let cell = |(x, y): (i32, i32)| grid.at((x / block) as usize, (y / block) as usize - 1);
            let mut place = lookout.errands.start();
            for tick in 0.. {
                let strays: Vec<usize> = state.places(stray).map(cell).collect();
                let Some(plan) = lookout.plan(tick, place, &strays, 1) else { break };
                let (from, to) = (lookout.errands.cell(place), lookout.errands.cell(plan[0]));
                let way = (0..WAYS.len()).find(|&way| grid.shift(from, WAYS[way]) == Some(to));
                let outcome = game.step(&mut state, way.map_or(Action::Nil, |way| ACTIONS[way]));
                let moved: Vec<usize> = state.places(stray).map(cell).collect();
                let is_step =
                    |(from, to): (&usize, &usize)| grid.manhattan(*from, *to) <= usize::from(moves(tick));
                assert!(strays.iter().zip(&moved).all(is_step), "tick {tick}");
                place = plan[0];
                assert_eq!(outcome == Outcome::Won, lookout.errands.is_won(place) && !moved.contains(&to));
                if outcome != Outcome::Ongoing {
                    won += u64::from(outcome == Outcome::Won);
                    break;
                }
            }
        }
        let rate = won as f64 / PLAYS as f64;
        assert!((rate - expected).abs() < 0.2, "{rate} in the game, {expected} here");
    }
}
