//! The stage that requires every mechanic of an invented game to matter.

use super::game::Trial;
use super::stage::{Passage, Stage};
use crate::boards::Ablations;
use crate::tally::Tally;
use engine::Analysis;
use std::collections::BTreeSet;

/// The reason for rejecting a game in which too few wins are shaped by all mechanics.
const JOINT: &str = "joint use";

/// The minimum number of levels on which every mechanic must matter. For a game with one or two levels, the minimum is
/// one.
const LEVELS: usize = 2;

/// The number of forward-model calls in the search for a win without an interaction or a mechanic.
const CALLS: u64 = 96_000;

impl Trial<'_> {
    pub(super) const JOINT: Stage<Self> = Stage {
        name: JOINT,
        purpose: "for an invented game, requires two levels on which every mechanic matters: without the mechanic, \
                  there is no win, only a clearly longer win, or (for a threat) a clearly shorter win or fewer \
                  fatal choices",
        cost: "a second",
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
        let least = LEVELS.min(self.found.len().saturating_sub(1)).max(1);
        let all_matter = self.found.iter().filter(|found| {
            found.report.witness.as_ref().is_some_and(|win| {
                let (needed, _) = ablations.needed(lines.iter().copied(), &found.level, win, CALLS);
                ablations.matter(&analysis, &needed, &found.level, win, CALLS).0 >= 1.0
            })
        });
        if all_matter.count() >= least { Ok(()) } else { Err(JOINT.into()) }
    }
}
