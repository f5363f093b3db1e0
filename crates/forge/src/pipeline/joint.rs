//! The stage that requires every mechanic of an invented game to matter.

use super::game::Trial;
use super::stage::{Passage, Stage};
use crate::boards::Ablations;
use crate::tally::Tally;
use engine::Analysis;
use std::collections::BTreeSet;

/// The reason for rejecting a game with a mechanic that matters on no level.
const JOINT: &str = "joint use";

/// The number of forward-model calls in the search for a win without an interaction or a mechanic. The board search
/// needed at most this number for the known win, so a failed search is evidence that no such win exists.
const CALLS: u64 = 320_000;

impl Trial<'_> {
    pub(super) const JOINT: Stage<Self> = Stage {
        name: JOINT,
        purpose: "for an invented game, requires that every mechanic matters on at least one level: without the \
                  mechanic, there is no win, only a clearly longer win, or (for a threat) a clearly shorter win or \
                  fewer fatal keys",
        cost: "up to a minute",
        reasons: &[JOINT],
        ..Stage::once(Self::ask_for_joint_use)
    };

    fn ask_for_joint_use(&mut self, _: &mut Tally) -> Passage {
        let mechanics = self.levels.source.mechanics();
        if mechanics.is_empty() {
            return Ok(());
        }
        let analysis = Analysis::of(&self.candidate.game);
        let ablations = Ablations::of(&analysis, mechanics);
        let lines: BTreeSet<usize> = mechanics.iter().flatten().copied().collect();
        let wins = self.found.iter().filter_map(|found| Some((&found.level, found.report.witness.as_ref()?)));
        let matter: Vec<Vec<bool>> = wins
            .map(|(level, win)| {
                let (needed, _) = ablations.needed(lines.iter().copied(), level, win, CALLS);
                ablations.matter(&analysis, &needed, level, win, CALLS).0
            })
            .collect();
        let mechanics = matter.first().map_or(0, Vec::len);
        let matters = |at: usize| matter.iter().any(|matter| matter[at]);
        if (0..mechanics).all(matters) { Ok(()) } else { Err(JOINT.into()) }
    }
}
