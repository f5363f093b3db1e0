//! Best-first width search: finds some win soon, not the shortest one.

use super::tree::{Expanded, NodeId, ROOT, StoredState, Tree};
use super::{Answer, Pushes, SearchLimits, Searched};
use crate::features::{Atoms, Features};
use crate::progress::Progress;
use engine::State;
use engine::analysis::Analysis;
use std::collections::{BTreeMap, BinaryHeap};

/// Prefers novel states among states equally far from the goal: those with a sprite where none of its type was yet,
/// or more of a resource. (Lipovetzky and Geffner 2017, "Best-first width search: exploration and exploitation in
/// classical planning"; the goal counter is the number of sprites that must go or come, and the score.) Ties go to
/// states nearer the goal, then to those that need fewer [`Pushes`].
///
/// Unlike in the paper, states that are not novel are not pruned, so the search is complete: without a win it proves
/// that there is none. Conditions and costs are those of [`a_star`](super::a_star).
pub fn best_first(analysis: &Analysis, pushes: &Pushes, start: &State, limits: SearchLimits) -> Searched {
    let mut tree = Tree::new(analysis, pushes, start, limits);
    if start.is_over() || !analysis.is_deterministic_from(start) {
        return tree.answer(Answer::OutOfCalls);
    }
    let mut queue = Queue {
        progress: Progress::of(analysis),
        features: Features::of(analysis, tree.abstraction(), start),
        seen: BTreeMap::new(),
        open: BinaryHeap::new(),
    };
    if let Some(least) = pushes.least(start) {
        let root = tree.root();
        queue.push(start, ROOT, 0, least, root);
    }
    while let Some(Open { node, kept, .. }) = queue.open.pop() {
        let expanded = tree.expand(node, &kept, &mut |tree, id, state, least, kept| {
            queue.push(state, id, tree.depth(id), least, kept);
        });
        match expanded {
            Expanded::On => {}
            Expanded::Won(node) => return tree.won(node, false),
            Expanded::OutOfCalls => return tree.answer(Answer::OutOfCalls),
            Expanded::OutOfMemory => return tree.answer(Answer::OutOfMemory),
        }
    }
    tree.answer(Answer::Impossible)
}

struct Queue<'a> {
    progress: Progress<'a>,
    features: Features,
    /// The atoms seen, by distance from the goal and score.
    seen: BTreeMap<(u32, i64), Atoms>,
    open: BinaryHeap<Open>,
}

impl Queue<'_> {
    fn push(&mut self, state: &State, node: NodeId, depth: u32, least: u32, kept: StoredState) {
        let missing = self.progress.missing(state);
        let score = state.score() as i64;
        let seen = self.seen.entry((missing, score)).or_insert_with(|| Atoms::new(self.features.len()));
        let mut new = 0;
        self.features.each(state, |atom| new += u32::from(seen.insert(atom)));
        let order = (u32::from(new == 0), missing.saturating_add(least), -score, depth);
        self.open.push(Open { order, node, kept });
    }
}

struct Open {
    order: (u32, u32, i64, u32),
    node: NodeId,
    kept: StoredState,
}

impl Open {
    /// Ties go to the older node.
    fn rank(&self) -> ((u32, u32, i64, u32), NodeId) {
        (self.order, self.node)
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Open) -> bool {
        self.rank() == other.rank()
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Open) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    /// The heap returns the greatest first.
    fn cmp(&self, other: &Open) -> std::cmp::Ordering {
        other.rank().cmp(&self.rank())
    }
}
