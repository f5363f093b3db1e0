//! Iterated width with replanning, for games of chance too.
//!
//! Each decision looks ahead breadth first from copies of the state, each with a chance of its own, and goes on only from
//! what is new: a sprite where none of its type has been in this look-ahead (IW(1): Lipovetzky and Geffner 2012, "Width and
//! serialization of classical planning problems"; Lipovetzky, Ramirez and Geffner 2015, "Classical planning with
//! simulators: results on the Atari video games"). So it sees far with few calls where random rollouts stay near. The best
//! plans found, one for each first action, are then played again with other chances, because one look at a game of chance
//! is luck; the plan that does best in the mean decides.

use crate::features::{Atoms, Features};
use crate::planner::{Budget, Decision, Planner, Streams};
use crate::progress::Progress;
use engine::analysis::Analysis;
use engine::{Action, Game, Outcome, Seed, State};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The parameters of the planner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WidthConfig {
    /// What a reward is worth one tick later.
    pub discount: f64,
    /// The share of the budget that is spent on looking ahead; the rest tries the plans again.
    pub look: f64,
    /// Ticks of a plan that are tried again at most.
    pub horizon: usize,
    /// What it is worth to come to a state with something that the episode has not had yet, in points.
    pub curiosity: f64,
}

impl Default for WidthConfig {
    fn default() -> WidthConfig {
        WidthConfig { discount: 0.98, look: 0.6, horizon: 20, curiosity: 0.1 }
    }
}

/// A win weighs as much as so many of the largest gains seen.
const WIN: f64 = 20.0;
/// A loss weighs half of that.
const LOSS: f64 = 10.0;

/// The planner.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Width {
    config: WidthConfig,
    streams: Streams,
    /// The largest change of the score in one tick seen so far, at least 1.
    unit: f64,
    /// What the episode has had.
    been: Option<(Features, Atoms)>,
    /// The rest of the last plan.
    plan: VecDeque<Action>,
    #[serde(skip)]
    analysis: Option<Analysis>,
    #[serde(skip)]
    pool: Vec<State>,
}

struct Node {
    state: Option<State>,
    parent: usize,
    action: Action,
    depth: u32,
    /// Discounted rewards on the way, curiosity left out.
    value: f64,
    /// What distinguishes it as an end of a plan.
    worth: f64,
}

impl Width {
    /// A planner of its own streams of choices and imagined chance.
    pub fn new(config: WidthConfig, seed: Seed) -> Width {
        Width {
            config,
            streams: Streams::new(seed),
            unit: 1.0,
            been: None,
            plan: VecDeque::new(),
            analysis: None,
            pool: Vec::new(),
        }
    }

    /// The reward of a step.
    fn reward(unit: &mut f64, progress: &Progress<'_>, before: &State, after: &State) -> f64 {
        let gain = after.score() - before.score();
        *unit = unit.max(gain.abs());
        let (had, has) = (progress.sprites_missing(before), progress.sprites_missing(after));
        let nearer = f64::from(had) - f64::from(has);
        let end = match after.outcome() {
            Outcome::Won => WIN * *unit,
            Outcome::Lost | Outcome::Stopped(_) => -LOSS * *unit,
            Outcome::Ongoing | Outcome::Ended => 0.0,
        };
        gain + nearer.clamp(-3.0, 3.0) * *unit + end
    }

    /// One look ahead: the tree of novel states. Returns the plans, the best one for each first action, and the calls.
    fn look(
        &mut self,
        analysis: &Analysis,
        root: &State,
        budget: u64,
        decision: &mut Decision,
        plans: &mut Vec<(f64, Vec<Action>)>,
    ) -> u64 {
        let game = analysis.game();
        let progress = Progress::of(analysis);
        let (features, been) = self.been.as_ref().expect("made before");
        let mut atoms = Atoms::new(features.len());
        features.each(root, |atom| _ = atoms.insert(atom));
        let mut nodes = vec![Node {
            state: Some(root.clone()),
            parent: 0,
            action: Action::Nil,
            depth: 0,
            value: 0.0,
            worth: 0.0,
        }];
        let mut queue = VecDeque::from([0]);
        let mut calls = 0;
        'look: while let Some(at) = queue.pop_front() {
            let state = nodes[at].state.take().expect("open nodes have one");
            let steps: f64 = discount(self.config.discount, nodes[at].depth);
            for action in choices(game, &state) {
                if calls >= budget {
                    self.pool.push(state);
                    break 'look;
                }
                let mut child = self.pool.pop().unwrap_or_else(|| state.clone());
                decision.imagine(&mut child, &state);
                game.step(&mut child, action);
                calls += 1;
                let reward = Width::reward(&mut self.unit, &progress, &state, &child);
                let value = nodes[at].value + steps * reward;
                let (mut new, mut fresh) = (false, false);
                features.each(&child, |atom| {
                    new |= atoms.insert(atom);
                    fresh |= !been.contains(atom);
                });
                let depth = nodes[at].depth + 1;
                let curious = if fresh && !child.is_over() {
                    self.config.curiosity * discount(self.config.discount, depth)
                } else {
                    0.0
                };
                let open = new && !child.is_over();
                nodes.push(Node { state: None, parent: at, action, depth, value, worth: value + curious });
                if open {
                    nodes.last_mut().expect("just pushed").state = Some(child);
                    queue.push_back(nodes.len() - 1);
                } else {
                    self.pool.push(child);
                }
            }
            self.pool.push(state);
        }
        self.pool.extend(nodes.iter_mut().filter_map(|node| node.state.take()));
        // The best end below each first action.
        let mut best: Vec<(Action, usize)> = Vec::new();
        let mut first: Vec<usize> = vec![0; nodes.len()];
        for (at, node) in nodes.iter().enumerate().skip(1) {
            first[at] = if node.parent == 0 { at } else { first[node.parent] };
            let action = nodes[first[at]].action;
            match best.iter_mut().find(|(known, _)| *known == action) {
                Some((_, end)) if node.worth > nodes[*end].worth => *end = at,
                Some(_) => {}
                None => best.push((action, at)),
            }
        }
        for (_, end) in best {
            let mut plan = Vec::new();
            let mut at = end;
            while at != 0 {
                plan.push(nodes[at].action);
                at = nodes[at].parent;
            }
            plan.reverse();
            plans.push((nodes[end].worth, plan));
        }
        calls
    }

    /// The mean worth of a plan over some chances, and the calls.
    fn try_plan(
        &mut self,
        analysis: &Analysis,
        root: &State,
        plan: &[Action],
        decision: &mut Decision,
        scratch: &mut (State, State),
    ) -> (f64, u64) {
        let game = analysis.game();
        let progress = Progress::of(analysis);
        let (state, before) = scratch;
        decision.imagine(state, root);
        let (mut value, mut weight, mut calls) = (0.0, 1.0, 0);
        for &action in plan.iter().take(self.config.horizon) {
            before.clone_from(state);
            game.step(state, action);
            calls += 1;
            value += weight * Width::reward(&mut self.unit, &progress, before, state);
            weight *= self.config.discount;
            if state.is_over() {
                break;
            }
        }
        (value, calls)
    }
}

fn discount(discount: f64, depth: u32) -> f64 {
    (0..depth).fold(1.0, |weight, _| weight * discount)
}

/// What can be done, waiting included.
fn choices(game: &Game, state: &State) -> impl Iterator<Item = Action> + use<> {
    let actions = game.actions(state);
    let waits = !actions.contains(&Action::Nil);
    actions.iter().copied().chain(waits.then_some(Action::Nil))
}

impl Planner for Width {
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64) {
        let actions = game.actions(state);
        let mut decision = self.streams.next();
        let analysis = self.analysis.take().unwrap_or_else(|| Analysis::of(game));
        if self.been.is_none() {
            let features = Features::of(&analysis, &analysis.keying(state), state);
            let atoms = Atoms::new(features.len());
            self.been = Some((features, atoms));
        }
        let (features, been) = self.been.as_mut().expect("just made");
        features.each(state, |atom| _ = been.insert(atom));
        if state.is_over() {
            self.analysis = Some(analysis);
            return (actions[0], 0);
        }
        let mut plans: Vec<(f64, Vec<Action>)> = Vec::new();
        if !self.plan.is_empty() {
            plans.push((0.0, self.plan.iter().copied().collect()));
        }
        let look = (budget.0 as f64 * self.config.look) as u64;
        let mut calls = self.look(&analysis, state, look.max(1), &mut decision, &mut plans);
        // What the first look expects beyond the horizon counts for plans that do as well in their first ticks.
        let mut scratch = (state.clone(), state.clone());
        let mut tried: Vec<(f64, f64)> = vec![(0.0, 0.0); plans.len()];
        while calls < budget.0 {
            for (plan, tried) in plans.iter().zip(&mut tried) {
                let (value, cost) = self.try_plan(&analysis, state, &plan.1, &mut decision, &mut scratch);
                calls += cost;
                tried.0 += value;
                tried.1 += 1.0;
            }
        }
        let mean = |at: usize| {
            let (sum, count): (f64, f64) = tried[at];
            let beyond = if plans[at].1.len() > self.config.horizon { 0.5 * plans[at].0 } else { 0.0 };
            let expected = 0.1 * plans[at].0;
            if count > 0.0 { sum / count + beyond + expected } else { plans[at].0 }
        };
        let mut best = 0;
        for at in 1..plans.len() {
            if mean(at) > mean(best) {
                best = at;
            }
        }
        let mut plan: VecDeque<Action> = plans.swap_remove(best).1.into();
        let action = plan.pop_front().unwrap_or(Action::Nil);
        self.plan = plan;
        self.analysis = Some(analysis);
        (action, calls)
    }
}
