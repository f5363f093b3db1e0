//! Open-loop expectimax tree search (OLETS), like the reference's `olets`, with a budget in forward-model calls
//! (`spec/04` §2). OLETS won the reference's competition.
//!
//! A node represents a sequence of actions, as in [`Mcts`](crate::Mcts), but there is no rollout. Instead, the state
//! at each new node is evaluated. The value of a node is a mixture of the results that ended there and the value of
//! its best child. The tree under the chosen action is reused for the next decision. The method was developed by A.
//! Couëtoux (2015). See Perez Liebana et al. 2016, "The 2014 general video game playing competition".

use super::branches::{UNEXPANDED, WIDTH, best, blurred, subtree, unexpanded};
use crate::planner::{Budget, Decision, Planner, Streams};
use base::Seed;
use engine::{Action, Game, Outcome, State};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// A constant that guards divisions and breaks ties between sums, as in the reference.
const EPSILON: f64 = 1e-4;

base::with_defaults! {
    /// The parameters of [`Olets`]. The defaults match the reference.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct OletsConfig {
        /// The exploration weight, relative to unnormalised scores.
        pub exploration: f64 = std::f64::consts::SQRT_2,
        /// The fraction of uniformly random choices during the descent.
        pub random: f64 = 0.05,
        /// The number of past avatar positions that are remembered, one per decision.
        pub memory: usize = 15,
        /// The penalty for a node that leads to a remembered position.
        pub penalty: f64 = 0.5,
        /// `true` to correct how the reference counts nodes retained after the last decision (`spec/04` §2). Each
        /// retained node should count as one visit, with the mean of its results so far. The reference keeps the sum
        /// of the results that ended at a node, but divides this sum by that one visit. If `true`, the sum is divided
        /// by the number of results instead.
        pub fixed_refresh: bool = false,
    }
}

/// A planner that uses open-loop expectimax tree search.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Olets {
    config: OletsConfig,
    streams: Streams,
    /// The nodes of the tree, root first. Between decisions, the tree holds only the retained nodes,
    /// which the next decision refreshes.
    tree: Vec<Node>,
    /// The action that belongs to each branch of the tree.
    actions: Vec<Action>,
    /// The avatar's positions at the most recent decisions, excluding the planner's first decision. The current
    /// position comes last.
    places: VecDeque<(i32, i32)>,
    /// `true` once a decision has been made.
    begun: bool,
    #[serde(skip)]
    path: Vec<usize>,
    #[serde(skip)]
    scratch: Option<State>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Node {
    children: [u32; WIDTH],
    visits: f64,
    /// The sum of the results of all iterations through this node.
    total: f64,
    /// The number of iterations that ended at this node, and the sum of their results.
    exits: f64,
    exit_sum: f64,
    /// The mean of the results that ended at this node, mixed with the value of the best child. The weights are
    /// proportional to the numbers of visits.
    value: f64,
    penalty: f64,
    /// `true` if the node was reached in this decision.
    reached: bool,
}

impl Node {
    fn new() -> Node {
        Node {
            children: [UNEXPANDED; WIDTH],
            visits: 0.0,
            total: 0.0,
            exits: 0.0,
            exit_sum: 0.0,
            value: 0.0,
            penalty: 0.0,
            reached: false,
        }
    }

    /// Makes all results seen so far count as one visit.
    fn refresh(&mut self, fixed: bool) {
        let visits = self.visits.max(1.0);
        self.total /= visits;
        self.value = self.total;
        if fixed {
            self.exit_sum /= self.exits.max(1.0);
        }
        (self.visits, self.exits, self.reached) = (1.0, 1.0, false);
    }
}

impl Olets {
    /// Creates a planner with its own random-number streams for choices and imagined outcomes.
    pub fn new(config: OletsConfig, seed: Seed) -> Olets {
        Olets {
            config,
            streams: Streams::new(seed),
            tree: Vec::new(),
            actions: Vec::new(),
            places: VecDeque::new(),
            begun: false,
            path: Vec::new(),
            scratch: None,
        }
    }

    /// Remembers the avatar's position, and prepares the tree. Reuses the part retained after the last decision, if
    /// it still fits.
    fn begin(&mut self, actions: Vec<Action>, state: &State) {
        if std::mem::replace(&mut self.begun, true)
            && let Some(place) = state.avatar_place()
        {
            if self.places.len() >= self.config.memory {
                self.places.pop_front();
            }
            self.places.push_back(place);
        }
        if self.actions != actions || self.tree.is_empty() {
            self.actions = actions;
            self.tree.clear();
            self.tree.push(Node::new());
        }
        self.tree.iter_mut().for_each(|node| node.refresh(self.config.fixed_refresh));
    }

    /// Runs one iteration: descends the tree to a new node, and backpropagates the value of its state.
    /// Returns the number of calls that the iteration made.
    fn iterate(&mut self, game: &Game, state: &mut State, decision: &mut Decision) -> u64 {
        let mut node = 0;
        self.path.clear();
        self.path.push(0);
        while !state.is_over() {
            let children = &self.tree[node].children[..self.actions.len()];
            let (branch, new) = match unexpanded(children, &mut decision.choices) {
                Some(branch) => (branch, true),
                None => (self.select(node, decision), false),
            };
            game.step(state, self.actions[branch]);
            if new {
                self.tree[node].children[branch] = self.tree.len() as u32;
                self.tree.push(Node::new());
            }
            node = self.tree[node].children[branch] as usize;
            self.path.push(node);
            if !self.tree[node].reached {
                self.tree[node].reached = true;
                self.tree[node].penalty = self.penalty(state);
                // The first pass through a retained child of the root ends there, so that the child gets a result
                // from this decision.
                if new || self.path.len() == 2 {
                    break;
                }
            }
        }
        let calls = self.path.len() as u64 - 1;
        self.back_up(result(state, calls as f64));
        calls
    }

    fn back_up(&mut self, result: f64) {
        let leaf = *self.path.last().expect("the root is on every path");
        self.tree[leaf].exits += 1.0;
        self.tree[leaf].exit_sum += result;
        for &at in self.path.iter().rev() {
            self.tree[at].visits += 1.0;
            self.tree[at].total += result;
            let node = &self.tree[at];
            let children = node.children.iter().filter(|&&child| child != UNEXPANDED);
            let best = children.map(|&child| self.tree[child as usize].value).reduce(f64::max);
            // At the root, iterations end only if there is nothing to plan. At other nodes, they end only before the
            // node has a child.
            let ended = if node.exits > 0.0 { node.exit_sum / node.exits } else { 0.0 };
            let share = node.exits / node.visits;
            self.tree[at].value = best.map_or(ended, |best| share * ended + (1.0 - share) * best);
        }
    }

    /// Returns the penalty for the avatar's current position.
    fn penalty(&self, state: &State) -> f64 {
        let known = state.avatar_place().is_some_and(|place| self.places.contains(&place));
        if known { self.config.penalty } else { 0.0 }
    }

    /// Chooses the branch to descend: sometimes a random branch, and otherwise the branch with the greatest
    /// value after the exploration bonus is added and the penalty is subtracted.
    fn select(&self, node: usize, decision: &mut Decision) -> usize {
        let (choices, width) = (&mut decision.choices, self.actions.len());
        if choices.unit() < self.config.random {
            return choices.below(width);
        }
        let Node { children, visits, .. } = &self.tree[node];
        let logarithm = libm::log(visits + 1.0);
        best(width, |branch| {
            let child = &self.tree[children[branch] as usize];
            let explore = (logarithm / (child.visits + EPSILON)).sqrt();
            child.value + self.config.exploration * explore - child.penalty
        })
    }

    /// Chooses the most visited branch, or the branch with the greatest sum if all of them have the same
    /// number of visits.
    fn decide(&self, decision: &mut Decision) -> usize {
        let width = self.actions.len();
        let child = |branch: usize| self.tree.get(self.tree[0].children[branch] as usize);
        let mut visits = (0..width).filter_map(child).map(|child| child.visits);
        let alike = visits.next().is_none_or(|first| visits.all(|visits| visits == first));
        best(width, |branch| match child(branch) {
            Some(child) if alike => blurred(child.total, EPSILON, decision.choices.unit()),
            Some(child) => child.visits,
            None => f64::NEG_INFINITY,
        })
    }

    /// Retains the subtree under a branch of the root, breadth first.
    fn keep(&mut self, branch: usize) {
        let root = self.tree[0].children[branch];
        self.tree = subtree(&self.tree, root, |node| &mut node.children);
    }
}

/// Returns the actions in the reference's order, which breaks ties in the descent and in the final choice. If
/// no branch is better and no other position can be reached immediately, an avatar that shoots keeps
/// shooting. It is unknown where the reference adds tie-breaking noise. See `docs/reference/planners.md` for
/// the evidence from the recorded episodes.
fn in_order(actions: &[Action]) -> Vec<Action> {
    use Action::{Down, Left, Nil, Right, Up, Use};
    [Use, Left, Right, Down, Up, Nil].into_iter().filter(|action| actions.contains(action)).collect()
}

/// Returns the value of a state `depth` ticks ahead. The value is the score, adjusted for the outcome. A win is worth
/// more if the score is higher, and a loss is worse if it comes sooner.
fn result(state: &State, depth: f64) -> f64 {
    let score = state.score();
    match state.outcome() {
        Outcome::Won => score + 100.0 * (1.0 + score.abs()),
        Outcome::Lost | Outcome::Stopped(_) => {
            score - 2000.0 / ((1.0 + depth) * (1.0 + depth)) * (1.0 + score.abs())
        }
        Outcome::Ongoing | Outcome::Ended => score,
    }
}

impl Planner for Olets {
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64) {
        let mut decision = self.streams.next();
        self.begin(in_order(game.actions(state)), state);
        if self.actions.len() == 1 {
            self.tree.clear();
            return (self.actions[0], 0);
        }
        let mut copy = self.scratch.take().unwrap_or_else(|| state.clone());
        let mut calls = 0;
        // There must be at least one iteration, because `decide` needs a child.
        loop {
            decision.fork_with_random_future(&mut copy, state);
            let cost = self.iterate(game, &mut copy, &mut decision);
            calls += cost;
            if cost == 0 || calls >= budget.0 {
                break;
            }
        }
        self.scratch = Some(copy);
        let branch = self.decide(&mut decision);
        self.keep(branch);
        (self.actions[branch], calls)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAME: &str = "BasicGame\n  SpriteSet\n    goal > Door\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > killSprite\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=500 win=False\n";

    #[test]
    fn early_deaths_score_lower_and_wins_grow_with_the_score() {
        let game = Game::from_source(GAME).unwrap();
        let ended = |level: &str| {
            let mut state = game.start(&game.level(level).unwrap(), Seed::from_text("results"));
            game.step(&mut state, Action::Right);
            state
        };
        assert_eq!(result(&ended("Apg"), 1.0), -500.0);
        assert_eq!(result(&ended("Apg"), 3.0), -125.0);
        assert_eq!(result(&ended("Ag"), 5.0), 1.0 + 200.0);
        assert_eq!(result(&ended("A g"), 5.0), 0.0);
    }

    /// Checks values that were calculated by hand, for a retained node with four visits. Three of the visits ended at
    /// the node, with a sum of 6.
    #[test]
    fn kept_subtrees_count_as_one_visit() {
        let node = Node { visits: 4.0, total: 10.0, exits: 3.0, exit_sum: 6.0, ..Node::new() };
        for (fixed, exit_sum) in [(false, 6.0), (true, 2.0)] {
            let mut node = node.clone();
            node.refresh(fixed);
            assert_eq!((node.visits, node.total, node.value), (1.0, 2.5, 2.5));
            assert_eq!((node.exits, node.exit_sum), (1.0, exit_sum));
        }
    }
}
