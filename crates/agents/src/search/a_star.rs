//! A* with transpositions: the shortest win, or the proof that there is none.

use super::tree::{Frontier, NodeId, StoredState, Tree};
use super::{Pushes, SearchLimits, Searched};
use crate::play::Stopped;
use engine::State;
use engine::analysis::Analysis;

/// Expands states in the order of the least number of ticks of a win through them: the ticks to reach them, plus the
/// [`Pushes`] that they need (Hart, Nilsson and Raphael 1968). If nothing is pushed this is breadth-first search.
///
/// Proofs need a state from which play is deterministic ([`Analysis::is_deterministic_from`]). Cost:
/// at most the number of states times the number of actions, in calls; O(size of a state) for each call.
pub fn a_star(analysis: &Analysis, pushes: &Pushes, start: &State, limits: SearchLimits) -> Searched {
    a_star_until(analysis, pushes, start, limits, &|| false)
}

/// [`a_star`], until nobody waits for its answer.
pub(crate) fn a_star_until(
    analysis: &Analysis,
    pushes: &Pushes,
    start: &State,
    limits: SearchLimits,
    stopped: Stopped<'_>,
) -> Searched {
    Tree::new(analysis, pushes, start, limits).until(stopped).search(|_, _| Buckets::default())
}

/// Open states by their estimate, a small number of ticks; of equals, the last one first.
#[derive(Default)]
struct Buckets {
    buckets: Vec<Vec<(NodeId, StoredState)>>,
    least: usize,
}

impl Frontier for Buckets {
    const SHORTEST: bool = true;

    fn push(&mut self, _: &State, node: NodeId, depth: u32, least: u32, kept: StoredState) {
        // Every push takes a tick, every tick has at most one push, and at least one tick is needed: the estimate
        // never falls by more than the tick that passes, so each state is expanded with its shortest way known.
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
