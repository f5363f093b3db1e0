//! A* search with transpositions, which finds the shortest win or proves that there is no win.

use super::tree::{Frontier, NodeId, StoredState, Tree};
use super::{Pushes, SearchLimits, Searched};
use crate::play::Stopped;
use engine::State;
use engine::analysis::Analysis;

/// Searches for the shortest win (Hart, Nilsson and Raphael 1968). States are expanded in ascending order of a lower
/// bound on the number of ticks in a win through the state. The bound is the number of ticks to reach the state, plus
/// the number of [`Pushes`] that the state needs. If no pushes are needed, this is a breadth-first search.
///
/// The result is proven only if play is deterministic from the initial state onwards
/// ([`Analysis::is_deterministic_from`]). Cost: at most one call per state and action. Each call costs O(size of a
/// state).
pub fn a_star(analysis: &Analysis, pushes: &Pushes, start: &State, limits: SearchLimits) -> Searched {
    a_star_until(analysis, pushes, start, limits, &|| false)
}

/// Searches like [`a_star`], until `stopped` returns `true`.
pub(crate) fn a_star_until(
    analysis: &Analysis,
    pushes: &Pushes,
    start: &State,
    limits: SearchLimits,
    stopped: Stopped<'_>,
) -> Searched {
    Tree::new(analysis, pushes, start, limits).until(stopped).search(|_, _| Buckets::default())
}

/// Open states in buckets, one bucket per estimate in ticks. Among states with equal estimates, the most recent comes
/// first.
#[derive(Default)]
struct Buckets {
    buckets: Vec<Vec<(NodeId, StoredState)>>,
    least: usize,
}

impl Frontier for Buckets {
    const SHORTEST: bool = true;

    fn push(&mut self, _: &State, node: NodeId, depth: u32, least: u32, kept: StoredState) {
        // A tick has at most one push, and a win takes at least one more tick. The remaining estimate therefore never
        // falls by more than one per tick, so the shortest path to a state is known when the state is expanded.
        let estimate = (depth + least.max(1)) as usize;
        if self.buckets.len() <= estimate {
            self.buckets.resize_with(estimate + 1, Vec::new);
        }
        self.buckets[estimate].push((node, kept));
        self.least = self.least.min(estimate);
    }

    fn pop(&mut self) -> Option<(NodeId, StoredState)> {
        loop {
            let bucket = self.buckets.get_mut(self.least)?;
            match bucket.pop() {
                Some(open) => return Some(open),
                None => {
                    *bucket = Vec::new();
                    self.least += 1;
                }
            }
        }
    }
}
