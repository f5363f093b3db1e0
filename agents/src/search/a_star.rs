//! A* with transpositions: the shortest win, or the proof that there is none.

use super::tree::{Expanded, NodeId, ROOT, StoredState, Tree};
use super::{Answer, Pushes, SearchLimits, Searched};
use engine::State;
use engine::analysis::Analysis;

/// Expands states in the order of the least number of ticks of a win through them: the ticks to reach them, plus the
/// [`Pushes`] that they need (Hart, Nilsson and Raphael 1968). If nothing is pushed this is breadth-first search.
///
/// `start` is a state from which play is deterministic ([`Analysis::is_deterministic_from`]); from any other state,
/// the answer is [`Answer::OutOfCalls`] at no cost, because nothing could be proved. Cost: at most the number of
/// states times the number of actions, in calls; O(size of a state) for each call.
pub fn a_star(analysis: &Analysis, pushes: &Pushes, start: &State, limits: SearchLimits) -> Searched {
    let mut tree = Tree::new(analysis, pushes, start, limits);
    if start.is_over() || !analysis.is_deterministic_from(start) {
        return tree.answer(Answer::OutOfCalls);
    }
    let mut queue = Buckets::default();
    if let Some(least) = pushes.least(start) {
        queue.push(least, (ROOT, tree.root()));
    }
    while let Some((node, kept)) = queue.pop() {
        let expanded = tree.expand(node, &kept, &mut |tree, id, _, least, kept| {
            // Every push takes a tick, every tick has at most one push, and at least one tick is needed: the estimate
            // never falls by more than the tick that passes, so each state is expanded with its shortest way known.
            queue.push(tree.depth(id) + least.max(1), (id, kept));
        });
        match expanded {
            Expanded::On => {}
            Expanded::Won(node) => return tree.won(node, true),
            Expanded::OutOfCalls => return tree.answer(Answer::OutOfCalls),
            Expanded::OutOfMemory => return tree.answer(Answer::OutOfMemory),
        }
    }
    tree.answer(Answer::Impossible)
}

/// Open states by their estimate, a small number of ticks; of equals, the last one first.
#[derive(Default)]
struct Buckets {
    buckets: Vec<Vec<(NodeId, StoredState)>>,
    least: usize,
}

impl Buckets {
    fn push(&mut self, estimate: u32, open: (NodeId, StoredState)) {
        let estimate = estimate as usize;
        if self.buckets.len() <= estimate {
            self.buckets.resize_with(estimate + 1, Vec::new);
        }
        self.buckets[estimate].push(open);
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
