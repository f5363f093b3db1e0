//! Comparison, in every reachable state, of a game with and without one of its rules.

use base::Seed;
use engine::{Analysis, Level, State};
use std::collections::{BTreeSet, VecDeque};

/// The result of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Comparison {
    /// Some sequence of actions has a different outcome or score in the two games.
    Differs,
    /// All sequences of actions are proven to have the same outcome and score. Contains the number of state pairs in
    /// the proof.
    Equal(usize),
    /// The result is unknown, because the level is stochastic or the calls ran out.
    Open,
}

/// The maximum number of distinct state pairs to examine.
const MAX_PAIRS: usize = 50_000;

/// Compares two games that differ in one rule, by a breadth-first search of a level with at most `most` forward-model
/// calls. Returns the result and the number of calls.
///
/// State pairs with equal search keys have the same future, so the search continues from only one of them.
pub(crate) fn compare(games: [&Analysis; 2], level: &Level, seed: Seed, most: u64) -> (Comparison, u64) {
    let start = games.map(|analysis| analysis.game().start(level, seed));
    let abstractions = [0, 1].map(|at| games[at].abstraction(&start[at]));
    if abstractions.iter().any(engine::analysis::StateAbstraction::reads_chance) {
        return (Comparison::Open, 0);
    }
    let keys = |pair: &[State; 2]| [0, 1].map(|at| abstractions[at].key(games[at], &pair[at]));
    let mut seen = BTreeSet::from([keys(&start)]);
    let mut open = VecDeque::from([start]);
    let mut calls = 0;
    while let Some(pair) = open.pop_front() {
        if pair[0].is_over() {
            continue;
        }
        for &action in games[0].game().actions(&pair[0]) {
            if calls >= most {
                return (Comparison::Open, calls);
            }
            let mut next = pair.clone();
            for (analysis, state) in games.iter().zip(&mut next) {
                analysis.game().step(state, action);
            }
            calls += 2;
            let [one, other] = &next;
            if (one.outcome(), one.score()) != (other.outcome(), other.score()) {
                return (Comparison::Differs, calls);
            }
            if seen.insert(keys(&next)) {
                if seen.len() > MAX_PAIRS {
                    return (Comparison::Open, calls);
                }
                open.push_back(next);
            }
        }
    }
    (Comparison::Equal(seen.len()), calls)
}
