//! Comparison of a game with and without one of its rules, in every state that play can reach.

use base::Seed;
use engine::{Analysis, Level, State};
use std::collections::{BTreeSet, VecDeque};

/// The answer of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Comparison {
    /// Some sequence of actions ends or scores differently in the two games.
    Differs,
    /// It is proved that all sequences of actions end and score the same. The value is the number of pairs of
    /// states in the proof.
    Equal(usize),
    /// The answer is unknown, because the level is stochastic or the calls ran out.
    Open,
}

/// The maximum number of pairs of states to distinguish.
const MAX_PAIRS: usize = 50_000;

/// Compares two games that differ in one rule on a level, breadth first, with at most `most` forward-model calls.
/// Returns the answer and the number of calls.
///
/// Pairs of states with equal search keys have the same future, so only one pair is continued.
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
