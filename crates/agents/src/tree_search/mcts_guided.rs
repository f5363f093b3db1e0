//! Monte-Carlo tree search that is guided by the game's rules. It avoids the known weaknesses of the reference's
//! search.
//!
//! Each difference from [`Mcts`](crate::Mcts) is a field of [`GuidedMctsConfig`], and can be turned off individually.
//! `docs/reference/planners.md` lists the gain from each field. The sources are:
//!
//! - Macro actions and discounts: Perez Liebana et al. 2012, "Monte Carlo tree search: long-term versus
//!   short-term planning".
//! - Knowledge of useful targets: Frydenberg et al. 2015, "Investigating MCTS modifications in general video
//!   game playing".
//! - Novelty: Soemers et al. 2016, "Enhancements for real-time Monte-Carlo tree search in general video game
//!   playing".

use super::branches::{UNEXPANDED, WIDTH, best, blurred, subtree, unexpanded};
use crate::guides::goal_guide::{Distances, GoalGuide};
use crate::planner::{Budget, Decision, Planner, Streams};
use base::Seed;
use engine::{Action, Game, Outcome, State};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};

/// A constant that breaks ties and guards divisions.
const EPSILON: f64 = 1e-6;

base::with_defaults! {
    /// The parameters of [`GuidedMcts`].
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct GuidedMctsConfig {
        /// The number of ticks that the tree and the rollout together look ahead.
        pub depth: u32 = 20,
        /// The exploration weight in UCT.
        pub exploration: f64 = 0.7,
        /// The bonus that a win adds to a result. The other parts of a result are each between −1 and 1. The
        /// reference adds 10⁷ to the score.
        pub win: f64 = 2.0,
        /// The penalty that a loss subtracts from a result.
        pub loss: f64 = 1.0,
        /// The weight of the points gained. They are measured relative to the largest gain in this episode's
        /// searches.
        pub score: f64 = 1.0,
        /// The factor by which each tick of delay discounts a result. The reference uses 1.
        pub discount: f64 = 0.99,
        /// `true` if doing nothing is an action. The reference uses `false`.
        pub nil: bool = true,
        /// `true` if the tree under the chosen action is reused for the next decision. The reference uses
        /// `false`.
        pub reuse: bool = true,
        /// The maximum number of consecutive ticks in which a rollout repeats an action. The reference uses
        /// 1.
        pub repeat: usize = 1,
        /// The weight of novelty, which means reaching a position that the avatar has not visited in this episode
        /// with the same progress. The reference uses 0.
        pub novelty: f64 = 0.5,
        /// The weight of progress as measured by the rules, including the distance to useful targets. The
        /// reference uses 0.
        pub guidance: f64 = 1.0,
        /// `true` to play a win to the end without searching again, if the win was found in a deterministic game.
        pub commit: bool = true,
    }
}

/// A planner that uses tree search guided by the game's rules.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GuidedMcts {
    config: GuidedMctsConfig,
    streams: Streams,
    /// The nodes of the tree, with the root first. Between decisions, only the retained nodes are stored.
    tree: Vec<Node>,
    /// The action that belongs to each branch of the tree.
    actions: Vec<Action>,
    /// The number of visits to each combination of the avatar's position, type and progress.
    #[serde(with = "pairs")]
    visits: BTreeMap<u64, u32>,
    /// The largest number of points gained or lost in a rollout.
    scale: f64,
    /// The remaining actions of a certain win, in the order of play.
    plan: VecDeque<Action>,
    #[serde(skip)]
    guide: Option<Box<GoalGuide>>,
    #[serde(skip)]
    distances: Distances,
    #[serde(skip)]
    path: Vec<usize>,
    #[serde(skip)]
    played: Vec<Action>,
    #[serde(skip)]
    scratch: Option<State>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Node {
    children: [u32; WIDTH],
    visits: f64,
    total: f64,
}

impl Node {
    fn new() -> Node {
        Node { children: [UNEXPANDED; WIDTH], visits: 0.0, total: 0.0 }
    }

    fn mean(&self) -> f64 {
        self.total / (self.visits + EPSILON)
    }
}

/// Serialises a map as a list of pairs, because JSON object keys must be strings.
mod pairs {
    use serde::{Deserialize, Deserializer, Serializer};
    use std::collections::BTreeMap;

    pub(crate) fn serialize<S: Serializer>(map: &BTreeMap<u64, u32>, to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(map)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<BTreeMap<u64, u32>, D::Error> {
        Ok(Vec::<(u64, u32)>::deserialize(from)?.into_iter().collect())
    }
}

/// The root's values, for comparison with results.
struct Root {
    score: f64,
    progress: f64,
    closeness: f64,
}

impl GuidedMcts {
    /// Creates a planner with its own random-number streams for choices and imagined outcomes.
    pub fn new(config: GuidedMctsConfig, seed: Seed) -> GuidedMcts {
        GuidedMcts {
            config,
            streams: Streams::new(seed),
            tree: Vec::new(),
            actions: Vec::new(),
            visits: BTreeMap::new(),
            scale: 0.0,
            plan: VecDeque::new(),
            guide: None,
            distances: Distances::default(),
            path: Vec::new(),
            played: Vec::new(),
            scratch: None,
        }
    }

    /// Prepares the tree. Reuses the part retained after the last decision, if it still fits.
    fn begin(&mut self, game: &Game, state: &State) {
        let mut actions = game.actions(state).to_vec();
        if self.config.nil && !actions.contains(&Action::Nil) {
            actions.push(Action::Nil);
        }
        if self.actions != actions || self.tree.is_empty() {
            self.actions = actions;
            self.tree.clear();
            self.tree.push(Node::new());
        }
        if self.guide.as_ref().is_none_or(|guide| !guide.fits(game)) {
            self.guide = Some(Box::new(GoalGuide::of(game)));
        }
    }

    /// Runs one iteration: descends the tree, adds one node, plays a random rollout, and backpropagates the
    /// result. Returns the number of calls that the iteration made, and `true` if the rollout won.
    fn iterate(
        &mut self,
        game: &Game,
        state: &mut State,
        root: &Root,
        decision: &mut Decision,
    ) -> (u64, bool) {
        let (depth, width) = (self.config.depth as usize, self.actions.len());
        let mut node = 0;
        self.path.clear();
        self.path.push(0);
        self.played.clear();
        let mut gained = Gains { score: root.score, value: 0.0, weight: 1.0, discount: self.config.discount };
        let mut grown = false;
        while !grown && !state.is_over() && self.played.len() < depth {
            let branch = match unexpanded(&self.tree[node].children[..width], &mut decision.choices) {
                Some(branch) => {
                    self.tree[node].children[branch] = self.tree.len() as u32;
                    self.tree.push(Node::new());
                    grown = true;
                    branch
                }
                None => self.select(node, decision),
            };
            game.step(state, self.actions[branch]);
            gained.tick(state);
            self.played.push(self.actions[branch]);
            node = self.tree[node].children[branch] as usize;
            self.path.push(node);
        }
        let (mut action, mut left) = (Action::Nil, 0);
        while !state.is_over() && self.played.len() < depth {
            if left == 0 {
                action = *decision.choices.choose(&self.actions);
                left = 1 + decision.choices.below(self.config.repeat.max(1));
            }
            left -= 1;
            game.step(state, action);
            gained.tick(state);
            self.played.push(action);
        }
        let result = self.result(state, root, &gained);
        for &node in &self.path {
            self.tree[node].visits += 1.0;
            self.tree[node].total += result;
        }
        (self.played.len() as u64, state.outcome() == Outcome::Won)
    }

    /// Computes a rollout's result from its points, progress, novelty and outcome.
    fn result(&mut self, state: &State, root: &Root, gained: &Gains) -> f64 {
        let config = &self.config;
        self.scale = self.scale.max(gained.value.abs());
        let points = if self.scale > 0.0 { config.score * gained.value / self.scale } else { 0.0 };
        let end = match state.outcome() {
            Outcome::Won => return points + config.win * gained.weight,
            Outcome::Lost | Outcome::Stopped(_) => return points - config.loss * gained.weight,
            Outcome::Ongoing | Outcome::Ended => gained.weight,
        };
        let guide = self.guide.as_ref().expect("the guide is made when the decision begins");
        let mut worth = 0.0;
        if config.guidance > 0.0 {
            let done = (guide.progress(state) - root.progress).clamp(-1.0, 1.0);
            let nearer = guide.closeness(state, &mut self.distances) - root.closeness;
            worth += config.guidance * (done + if done > 0.0 { 0.0 } else { nearer });
        }
        if config.novelty > 0.0 {
            let visits = self.visits.get(&novelty_key(state, guide)).copied().unwrap_or(0);
            worth += config.novelty / (1.0 + f64::from(visits)).sqrt();
        }
        points + end * worth
    }

    /// Chooses the branch with the greatest UCT value.
    fn select(&self, node: usize, decision: &mut Decision) -> usize {
        let Node { children, visits, .. } = &self.tree[node];
        let logarithm = libm::log(visits + 1.0);
        best(self.actions.len(), |branch| {
            let child = &self.tree[children[branch] as usize];
            let explore = (logarithm / (child.visits + EPSILON)).sqrt();
            let value = child.mean() + self.config.exploration * explore;
            blurred(value, EPSILON, decision.choices.unit())
        })
    }

    /// Chooses the most visited branch. Ties go to the branch with the higher value.
    fn decide(&self) -> usize {
        best(self.actions.len(), |branch| {
            let child = self.tree.get(self.tree[0].children[branch] as usize);
            child.map_or(f64::NEG_INFINITY, |child| child.visits + 0.1 * child.mean().clamp(-4.0, 4.0))
        })
    }

    /// Retains the subtree under a branch of the root, breadth first. Retains nothing if reuse is off.
    fn keep(&mut self, branch: usize) {
        let root = if self.config.reuse { self.tree[0].children[branch] } else { UNEXPANDED };
        self.tree = subtree(&self.tree, root, |node| &mut node.children);
    }
}

/// The discounted points gained in a rollout.
struct Gains {
    score: f64,
    value: f64,
    /// The weight of the next tick.
    weight: f64,
    discount: f64,
}

impl Gains {
    fn tick(&mut self, state: &State) {
        self.value += self.weight * (state.score() - self.score);
        self.score = state.score();
        self.weight *= self.discount;
    }
}

/// Returns a hash of the avatar's position and type, and of the game's progress. A state is not novel if its hash has
/// been seen before.
fn novelty_key(state: &State, guide: &GoalGuide) -> u64 {
    let (x, y) = state.avatar_place().unwrap_or((-1, -1));
    let block = state.block().max(1);
    let mut key = (x / block) as u64 & 0xFFFF | ((y / block) as u64 & 0xFFFF) << 16;
    key |= u64::from(state.avatar_type().map_or(u16::MAX, |stype| stype.0)) << 32;
    let done = (guide.progress(state) * 16.0) as i64 as u64;
    key ^ done.wrapping_mul(0x9E37_79B9_7F4A_7C15)
}

impl Planner for GuidedMcts {
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64) {
        let mut decision = self.streams.next();
        if let Some(action) = self.plan.pop_front() {
            return (action, 0);
        }
        self.begin(game, state);
        if self.actions.len() == 1 {
            self.tree.clear();
            return (self.actions[0], 0);
        }
        let guide = self.guide.as_ref().expect("the guide was just made");
        *self.visits.entry(novelty_key(state, guide)).or_default() += 1;
        let root = Root {
            score: state.score(),
            progress: guide.progress(state),
            closeness: guide.closeness(state, &mut self.distances),
        };
        let mut copy = self.scratch.take().unwrap_or_else(|| state.clone());
        let mut calls = 0;
        let mut certain = false;
        while calls < budget.0 && !certain {
            decision.fork_with_random_future(&mut copy, state);
            let (cost, won) = self.iterate(game, &mut copy, &root, &mut decision);
            calls += cost;
            certain = won && self.config.commit && game.is_deterministic();
            if cost == 0 {
                break; // The episode is over: nothing to plan.
            }
        }
        self.scratch = Some(copy);
        if certain {
            self.plan = self.played.iter().copied().collect();
            return (self.plan.pop_front().unwrap_or(Action::Nil), calls);
        }
        let branch = self.decide();
        self.keep(branch);
        (self.actions[branch], calls)
    }
}
