//! Best-first width search, which finds a win quickly, but not necessarily the shortest one.

use super::tree::{Frontier, NodeId, StoredState, Tree};
use super::{Pushes, SearchLimits, Searched};
use crate::guides::features::{Atoms, Features};
use crate::guides::progress::Progress;
use crate::play::Stopped;
use engine::State;
use engine::analysis::Analysis;
use std::collections::BTreeMap;

/// Searches for any win. Among states that are equally far from the goal, the search prefers novel states. In a novel
/// state, a type has a sprite in a new cell, or the avatar holds a new amount of a resource. Ties go to states closer
/// to the goal, and then to states that need fewer [`Pushes`].
///
/// The search is described in Lipovetzky and Geffner 2017, "Best-first width search: exploration and
/// exploitation in classical planning". Its goal counter consists of the number of sprites that must
/// disappear or appear, and the score.
///
/// Unlike in the paper, states that are not novel are not pruned. The search is therefore complete: if it ends without
/// a win before its limits are reached, no win exists. Conditions and costs are the same as for
/// [`a_star`](super::a_star).
pub fn best_first(analysis: &Analysis, pushes: &Pushes, start: &State, limits: SearchLimits) -> Searched {
    best_first_until(analysis, pushes, start, limits, &|| false)
}

/// Searches like [`best_first`], until `stopped` returns `true`.
pub(crate) fn best_first_until(
    analysis: &Analysis,
    pushes: &Pushes,
    start: &State,
    limits: SearchLimits,
    stopped: Stopped<'_>,
) -> Searched {
    Tree::new(analysis, pushes, start, limits).until(stopped).search(|tree, start| Queue {
        progress: Progress::of(analysis),
        features: Features::of(analysis, &tree.abstraction, start),
        seen: BTreeMap::new(),
        open: BTreeMap::new(),
    })
}

struct Queue<'a> {
    progress: Progress<'a>,
    features: Features,
    /// The atoms (facts about states) seen so far, by distance from the goal and score.
    seen: BTreeMap<(u32, i64), Atoms>,
    /// The open states by rank. Nodes with equal ranks are expanded in order of discovery.
    open: BTreeMap<(Rank, NodeId), StoredState>,
}

/// A state's rank. Novel states come first. The other criteria are, in this order, the distance from the goal plus
/// the required pushes, the score, and the depth.
type Rank = (u32, u32, i64, u32);

impl Frontier for Queue<'_> {
    const SHORTEST: bool = false;

    fn push(&mut self, state: &State, node: NodeId, depth: u32, least: u32, kept: StoredState) {
        let missing = self.progress.missing(state);
        let score = state.score() as i64;
        let seen = self.seen.entry((missing, score)).or_insert_with(|| Atoms::new(self.features.len()));
        let mut new = 0;
        self.features.each(state, |atom| new += u32::from(seen.insert(atom)));
        let rank = (u32::from(new == 0), missing.saturating_add(least), -score, depth);
        // A node that is added again has a smaller depth and thus a different rank, so no entry is replaced.
        self.open.insert((rank, node), kept);
    }

    fn pop(&mut self) -> Option<(NodeId, StoredState)> {
        self.open.pop_first().map(|((_, node), kept)| (node, kept))
    }
}
