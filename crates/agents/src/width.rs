//! Iterated width search with replanning, also for stochastic games.
//!
//! In each decision, the planner looks ahead breadth first from copies of the state, each with its own random seed.
//! The look-ahead continues only from novel states, in which a type has a sprite in a cell where the look-ahead has
//! not seen that type yet.
//!
//! The method is IW(1): see Lipovetzky and Geffner 2012, "Width and serialization of classical planning problems",
//! and Lipovetzky, Ramirez and Geffner 2015, "Classical planning with simulators: results on the Atari video games".
//! The method looks far ahead with few calls, whereas random rollouts do not get far from the start.
//!
//! The best plans found, one per first action, are then retried with different seeds, because a single good result in
//! a stochastic game may be luck. The plan with the best average is played.

use crate::guides::features::{Atoms, Features};
use crate::guides::progress::Progress;
use crate::planner::{Budget, Decision, Planner, Streams};
use base::Seed;
use engine::analysis::Analysis;
use engine::{Action, Game, Outcome, State};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

base::with_defaults! {
    /// The parameters of [`Width`].
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct WidthConfig {
        /// The factor by which each tick of delay discounts a reward.
        pub discount: f64 = 0.98,
        /// The fraction of the budget spent on looking ahead. The rest is spent on retrying the plans.
        pub look: f64 = 0.6,
        /// The number of ticks of a plan that are retried. Later ticks can still be replanned in time.
        pub horizon: usize = 12,
        /// The weight of a loss, in multiples of the largest gain seen.
        pub loss: f64 = 10.0,
        /// The value, in points, of reaching a state with an atom (a fact about the state) that is new in this episode.
        /// An atom that was present in one earlier tick is worth half as much, one that was present in two earlier
        /// ticks a third as much, and so on.
        pub curiosity: f64 = 0.1,
    }
}

/// The weight of a win, in multiples of the largest gain seen.
const WIN: f64 = 20.0;

/// A planner that uses iterated width search.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Width {
    config: WidthConfig,
    streams: Streams,
    /// The largest score change in one tick so far, at least 1.
    unit: f64,
    /// The number of ticks in the episode in which each atom (fact about the state) was present; `None` before the
    /// first decision.
    #[serde(rename = "been")]
    presence: Option<(Features, Vec<u32>)>,
    /// The rest of the last plan; `None` if nothing is left of it.
    plan: Option<Plan>,
    #[serde(skip)]
    analysis: Option<Analysis>,
    #[serde(skip)]
    pool: Vec<State>,
}

/// An action sequence, with the values found for it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Plan {
    actions: Vec<Action>,
    /// For each action, the sum of the discounted rewards up to and including that action.
    values: Vec<f64>,
    /// The extra value of the plan's final state.
    bonus: f64,
}

impl Plan {
    /// Returns the sum of the discounted rewards in the first `ticks` ticks.
    fn value(&self, ticks: usize) -> f64 {
        let last = ticks.min(self.values.len());
        last.checked_sub(1).map_or(0.0, |last| self.values[last])
    }

    fn worth(&self) -> f64 {
        self.value(usize::MAX) + self.bonus
    }

    /// Returns the plan without its first action; `None` if the plan has no other action.
    fn rest(&self, discount: f64) -> Option<Plan> {
        let (&first, values) = self.values.split_first()?;
        if values.is_empty() {
            return None;
        }
        Some(Plan {
            actions: self.actions[1..].to_vec(),
            values: values.iter().map(|value| (value - first) / discount).collect(),
            bonus: self.bonus / discount,
        })
    }
}

struct Node {
    state: Option<State>,
    parent: usize,
    action: Action,
    depth: u32,
    /// The sum of the discounted rewards on the path, without curiosity.
    value: f64,
    /// The value of a plan that ends at this node.
    worth: f64,
}

impl Width {
    /// Creates a planner with its own random-number streams for choices and imagined outcomes.
    pub fn new(config: WidthConfig, seed: Seed) -> Width {
        Width {
            config,
            streams: Streams::new(seed),
            unit: 1.0,
            presence: None,
            plan: None,
            analysis: None,
            pool: Vec::new(),
        }
    }

    /// Returns the reward of a step.
    fn reward(&mut self, progress: &Progress<'_>, before: &State, after: &State) -> f64 {
        let gain = after.score() - before.score();
        self.unit = self.unit.max(gain.abs());
        let (had, has) = (progress.sprites_missing(before), progress.sprites_missing(after));
        let nearer = f64::from(had) - f64::from(has);
        let end = match after.outcome() {
            Outcome::Won => WIN * self.unit,
            Outcome::Lost | Outcome::Stopped(_) => -self.config.loss * self.unit,
            Outcome::Ongoing | Outcome::Ended => 0.0,
        };
        gain + nearer.clamp(-3.0, 3.0) * self.unit + end
    }

    /// Builds the tree of novel states. Returns the best plan for each first action, and the number of calls.
    fn look(
        &mut self,
        analysis: &Analysis,
        root: &State,
        budget: u64,
        decision: &mut Decision,
        plans: &mut Vec<Plan>,
    ) -> u64 {
        let game = analysis.game();
        let progress = Progress::of(analysis);
        let (features, presence) = self.presence.take().expect("the features were made before");
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
            let state = nodes[at].state.take().expect("open nodes have a state");
            let steps: f64 = discount(self.config.discount, nodes[at].depth);
            for action in choices(game, &state) {
                if calls >= budget {
                    self.pool.push(state);
                    break 'look;
                }
                let mut child = self.pool.pop().unwrap_or_else(|| state.clone());
                decision.fork_with_random_future(&mut child, &state);
                game.step(&mut child, action);
                calls += 1;
                let reward = self.reward(&progress, &state, &child);
                let value = nodes[at].value + steps * reward;
                let (mut new, mut rarest) = (false, u32::MAX);
                features.each(&child, |atom| {
                    new |= atoms.insert(atom);
                    rarest = rarest.min(presence[atom]);
                });
                let depth = nodes[at].depth + 1;
                let mut curious = 0.0;
                if !child.is_over() {
                    curious = self.config.curiosity * discount(self.config.discount, depth);
                    curious /= 1.0 + f64::from(rarest);
                }
                let open = new && !child.is_over();
                nodes.push(Node { state: None, parent: at, action, depth, value, worth: value + curious });
                if open {
                    nodes.last_mut().expect("a node was just pushed").state = Some(child);
                    queue.push_back(nodes.len() - 1);
                } else {
                    self.pool.push(child);
                }
            }
            self.pool.push(state);
        }
        self.pool.extend(nodes.iter_mut().filter_map(|node| node.state.take()));
        // Find the best end below each first action.
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
            let mut way = Vec::new();
            let mut at = end;
            while at != 0 {
                way.push(at);
                at = nodes[at].parent;
            }
            way.reverse();
            plans.push(Plan {
                actions: way.iter().map(|&at| nodes[at].action).collect(),
                values: way.iter().map(|&at| nodes[at].value).collect(),
                bonus: nodes[end].worth - nodes[end].value,
            });
        }
        self.presence = Some((features, presence));
        calls
    }

    /// Retries the first ticks of a plan with a different seed. Returns the rewards, `true` if the game
    /// continued, and the number of calls.
    fn try_plan(
        &mut self,
        analysis: &Analysis,
        root: &State,
        plan: &[Action],
        decision: &mut Decision,
        (state, before): &mut (State, State),
    ) -> (f64, bool, u64) {
        let progress = Progress::of(analysis);
        decision.fork_with_random_future(state, root);
        let (mut value, mut weight, mut calls) = (0.0, 1.0, 0);
        for &action in plan.iter().take(self.config.horizon) {
            before.clone_from(state);
            analysis.game().step(state, action);
            calls += 1;
            value += weight * self.reward(&progress, before, state);
            weight *= self.config.discount;
            if state.is_over() {
                break;
            }
        }
        (value, !state.is_over(), calls)
    }
}

fn discount(discount: f64, depth: u32) -> f64 {
    (0..depth).fold(1.0, |weight, _| weight * discount)
}

/// Returns the available actions, including [`Action::Nil`].
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
        if self.presence.is_none() {
            let features = Features::without_moving_types(&analysis, &analysis.abstraction(state), state);
            let never = vec![0; features.len()];
            self.presence = Some((features, never));
        }
        let (features, presence) = self.presence.as_mut().expect("the features were just made");
        features.each(state, |atom| presence[atom] = presence[atom].saturating_add(1));
        if state.is_over() {
            self.analysis = Some(analysis);
            return (actions[0], 0);
        }
        let mut plans: Vec<Plan> = self.plan.take().into_iter().collect();
        let look = (budget.0 as f64 * self.config.look) as u64;
        let mut calls = self.look(&analysis, state, look.max(1), &mut decision, &mut plans);
        let mut scratch = (state.clone(), state.clone());
        let mut tried = vec![Tried::default(); plans.len()];
        while calls < budget.0 {
            for (plan, tried) in plans.iter().zip(&mut tried) {
                let (value, alive, cost) =
                    self.try_plan(&analysis, state, &plan.actions, &mut decision, &mut scratch);
                calls += cost;
                tried.value += value;
                tried.alive += f64::from(u8::from(alive));
                tried.count += 1.0;
            }
        }
        // The value beyond the horizon is weighted by the fraction of the tries that reach the horizon.
        let expected = |(plan, tried): (&Plan, &Tried)| {
            if tried.count == 0.0 {
                return plan.worth();
            }
            let beyond = plan.worth() - plan.value(self.config.horizon);
            (tried.value + tried.alive * beyond) / tried.count
        };
        let values: Vec<f64> = plans.iter().zip(&tried).map(expected).collect();
        let mut best = 0;
        for at in 1..plans.len() {
            if values[at] > values[best] {
                best = at;
            }
        }
        let plan = plans.swap_remove(best);
        let action = plan.actions.first().copied().unwrap_or(Action::Nil);
        self.plan = plan.rest(self.config.discount);
        self.analysis = Some(analysis);
        (action, calls)
    }
}

/// The results of retrying a plan, as sums over the tries.
#[derive(Clone, Copy, Debug, Default)]
struct Tried {
    value: f64,
    alive: f64,
    count: f64,
}
