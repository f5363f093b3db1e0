//! A* with transpositions: the shortest win, or the proof that there is none.

use super::tree::{Expanded, Kept, NodeId, ROOT, Tree};
use super::{Answer, Pushes, SearchLimits, Searched};
use engine::State;
use engine::analysis::Analysis;

/// Looks at states in the order of the ticks that a win through them takes at least: those that it takes to reach them,
/// and the [`Pushes`] that they need (Hart, Nilsson and Raphael 1968). Where nothing is pushed this is breadth-first search.
///
/// `start` is a state from which on chance decides nothing ([`Analysis::is_deterministic_from`]); from another one, the
/// answer is [`Answer::OutOfCalls`] at no cost, because nothing could be proved. Cost: at most the number of states times
/// that of an action each, in calls; O(size of a state) for each call.
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
            // Every push is a tick, every tick one push at most, and one tick is needed at least: the estimate never falls
            // by more than the tick that passes, so each state is expanded when its shortest way is known.
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

/// Open states by their estimate, a small number of ticks; of those with the same one, the last one first.
#[derive(Default)]
struct Buckets {
    buckets: Vec<Vec<(NodeId, Kept)>>,
    least: usize,
}

impl Buckets {
    fn push(&mut self, estimate: u32, open: (NodeId, Kept)) {
        let estimate = estimate as usize;
        if self.buckets.len() <= estimate {
            self.buckets.resize_with(estimate + 1, Vec::new);
        }
        self.buckets[estimate].push(open);
        self.least = self.least.min(estimate);
    }

    fn pop(&mut self) -> Option<(NodeId, Kept)> {
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
