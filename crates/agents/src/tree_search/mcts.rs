//! Open-loop Monte-Carlo tree search with UCT, like the reference's `sampleMCTS`, with a budget in forward-model
//! calls (`spec/04` §1).
//!
//! In open-loop search, a node represents a sequence of actions, not a state. Every iteration replays its sequence
//! from a fresh copy of the root, with its own random seed, so the statistics of a node average over the possible
//! outcomes. See Kocsis and Szepesvári 2006, "Bandit based Monte-Carlo planning", and Browne et al. 2012, "A survey
//! of Monte Carlo tree search methods".

use super::branches::{UNEXPANDED, WIDTH, best, blurred, unexpanded};
use crate::planner::{Budget, Planner, Streams};
use base::{Sampler, Seed};
use engine::{Action, Game, Outcome, State};
use serde::{Deserialize, Serialize};

/// A constant that breaks ties and guards divisions, as in the reference.
const EPSILON: f64 = 1e-6;

base::with_defaults! {
    /// The parameters of [`Mcts`]. The defaults match the reference.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct MctsConfig {
        /// The number of ticks that the tree and the rollout together look ahead.
        pub depth: u32 = 10,
        /// The exploration weight in UCT.
        pub exploration: f64 = std::f64::consts::SQRT_2,
        /// The bonus that a win adds to the score.
        pub win: f64 = 1e7,
        /// The penalty that a loss subtracts from the score.
        pub loss: f64 = 1e7,
    }
}

impl MctsConfig {
    /// Returns bold parameters, under which wins and losses weigh about as much as points. With the reference's ±10⁷,
    /// a single loss below a node hides all score differences there, so the search avoids every danger instead of
    /// making progress. On the corpus, the bold parameters win about a quarter more episodes with the same number of
    /// calls.
    pub fn bold(depth: u32) -> MctsConfig {
        MctsConfig { depth, win: 10.0, loss: 1.0, ..MctsConfig::default() }
    }
}

/// A planner that uses UCT and builds a new tree for each decision.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Mcts {
    config: MctsConfig,
    streams: Streams,
    #[serde(skip)]
    tree: Vec<Node>,
    #[serde(skip)]
    path: Vec<usize>,
    #[serde(skip)]
    scratch: Option<State>,
}

#[derive(Clone, Debug)]
struct Node {
    children: [u32; WIDTH],
    visits: f64,
    total: f64,
    /// The minimum and maximum results of the iterations through this node.
    least: f64,
    greatest: f64,
}

impl Node {
    fn new() -> Node {
        let (least, greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        Node { children: [UNEXPANDED; WIDTH], visits: 0.0, total: 0.0, least, greatest }
    }

    /// Returns the mean result of the simulations that passed through the node.
    fn value(&self) -> f64 {
        self.total / (self.visits + EPSILON)
    }
}

impl Mcts {
    /// Creates a planner with its own random-number streams for choices and imagined outcomes.
    pub fn new(config: MctsConfig, seed: Seed) -> Mcts {
        Mcts { config, streams: Streams::new(seed), tree: Vec::new(), path: Vec::new(), scratch: None }
    }

    /// Runs one iteration: descends the tree, adds one node, plays a random rollout, and backpropagates the
    /// result. Returns the number of calls that the iteration made.
    fn iterate(&mut self, game: &Game, state: &mut State, actions: &[Action], choices: &mut Sampler) -> u64 {
        let mut calls = 0;
        let mut depth = 0;
        let mut node = 0;
        self.path.clear();
        self.path.push(0);
        while !state.is_over() && depth < self.config.depth {
            let (branch, new) = match unexpanded(&self.tree[node].children[..actions.len()], choices) {
                Some(branch) => (branch, true),
                None => (self.select(node, actions.len(), choices), false),
            };
            game.step(state, actions[branch]);
            calls += 1;
            depth += 1;
            if new {
                self.tree[node].children[branch] = self.tree.len() as u32;
                self.tree.push(Node::new());
            }
            node = self.tree[node].children[branch] as usize;
            self.path.push(node);
            if new {
                break;
            }
        }
        while !state.is_over() && depth < self.config.depth {
            game.step(state, *choices.choose(actions));
            calls += 1;
            depth += 1;
        }
        let result = match state.outcome() {
            Outcome::Won => state.score() + self.config.win,
            Outcome::Lost | Outcome::Stopped(_) => state.score() - self.config.loss,
            Outcome::Ongoing | Outcome::Ended => state.score(),
        };
        for &node in &self.path {
            let node = &mut self.tree[node];
            node.visits += 1.0;
            node.total += result;
            node.least = node.least.min(result);
            node.greatest = node.greatest.max(result);
        }
        calls
    }

    /// Chooses the branch with the greatest UCT value, which is the mean plus exploration. The mean is normalised to
    /// the range of the results of the iterations through the node.
    fn select(&self, node: usize, width: usize, choices: &mut Sampler) -> usize {
        let Node { children, visits, least, greatest, .. } = &self.tree[node];
        let logarithm = libm::log(visits + 1.0);
        let value = |branch: usize, noise: f64| {
            let child = &self.tree[children[branch] as usize];
            let mean = child.value();
            let mean = if least < greatest { (mean - least) / (greatest - least) } else { mean };
            let explore = (logarithm / (child.visits + EPSILON)).sqrt();
            blurred(mean + self.config.exploration * explore, EPSILON, noise)
        };
        best(width, |branch| value(branch, choices.unit()))
    }

    /// Chooses the most visited branch, or the visited branch with the best mean if all of them have the same
    /// number of visits.
    fn decide(&self, width: usize, choices: &mut Sampler) -> usize {
        let root = &self.tree[0];
        let child = |branch: usize| self.tree.get(root.children[branch] as usize);
        let visits = |branch: usize| child(branch).map_or(0.0, |child| child.visits);
        let mut visited = (0..width).map(visits).filter(|&visits| visits > 0.0);
        let alike = visited.next().is_none_or(|first| visited.all(|visits| visits == first));
        best(width, |branch| match child(branch) {
            Some(child) if alike => blurred(child.value(), EPSILON, choices.unit()),
            Some(child) => blurred(child.visits, EPSILON, choices.unit()),
            None => f64::NEG_INFINITY,
        })
    }
}

impl Planner for Mcts {
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64) {
        let actions = game.actions(state);
        let mut decision = self.streams.next();
        if actions.len() == 1 {
            return (actions[0], 0);
        }
        self.tree.clear();
        self.tree.push(Node::new());
        let mut scratch = self.scratch.take().unwrap_or_else(|| state.clone());
        let mut calls = 0;
        while calls < budget.0 {
            decision.fork_with_random_future(&mut scratch, state);
            let cost = self.iterate(game, &mut scratch, actions, &mut decision.choices);
            calls += cost;
            if cost == 0 {
                break; // The episode is over: nothing to plan.
            }
        }
        self.scratch = Some(scratch);
        (actions[self.decide(actions.len(), &mut decision.choices)], calls)
    }
}
