//! The stage that requires a game's wins to need merged types in two roles.

use super::game::Trial;
use super::stage::{Passage, Stage};
use crate::boards::Ablations;
use crate::tally::Tally;
use engine::Analysis;
use std::collections::BTreeSet;

/// The reason for rejecting a game in which a type has opposed uses, but too few wins need two of its uses.
const JOINT: &str = "joint use";

/// The minimum number of levels whose wins need a merged type in two roles. For a game with one or two levels,
/// the minimum is one.
const LEVELS: usize = 2;

/// The number of a type's roles that a win must need, if the type has that many. Some roles are interchangeable.
const ROLES: usize = 2;

/// The number of forward-model calls in the search for a win without an interaction.
const CALLS: u64 = 40_000;

impl Trial<'_> {
    pub(super) const JOINT: Stage<Self> = Stage {
        name: JOINT,
        purpose: "for an invented game, requires for every type with opposed uses that on at least two \
                  levels one win needs two uses, or the only use that is not a threat: without a use, \
                  there is no win or only a clearly longer win",
        cost: "a second",
        reasons: &[JOINT],
        ..Stage::once(Self::ask_for_joint_use)
    };

    fn ask_for_joint_use(&mut self, _: &mut Tally) -> Passage {
        let joint = self.levels.source.joint_types();
        if joint.is_empty() {
            return Ok(());
        }
        let ablations = Ablations::of(&Analysis::of(&self.candidate.game));
        let lines: BTreeSet<usize> = joint.iter().flat_map(|stype| stype.uses.concat()).collect();
        let needed: Vec<Vec<usize>> = self
            .found
            .iter()
            .filter_map(|found| {
                let win = found.report.witness.as_ref()?;
                Some(ablations.needed(lines.iter().copied(), &found.level, win, CALLS).0)
            })
            .collect();
        let least = LEVELS.min(needed.len().saturating_sub(1)).max(1);
        let is_met = |lines: &Vec<usize>, needed: &[usize]| lines.iter().any(|line| needed.contains(line));
        let enough = joint.iter().all(|stype| {
            let enough = |needed: &&Vec<usize>| {
                let met = stype.uses.iter().filter(|lines| is_met(lines, needed)).count();
                met >= stype.uses.len().min(ROLES)
            };
            needed.iter().filter(enough).count() >= least
        });
        if enough { Ok(()) } else { Err(JOINT.into()) }
    }
}
