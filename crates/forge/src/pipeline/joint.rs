//! The stage that checks whether the wins of a game use merged types in all their roles.

use super::game::Trial;
use super::stage::{Passage, Stage};
use crate::tally::Tally;
use std::collections::BTreeSet;
use validators::used_rules;

/// The reason for rejecting a game with a type that no win uses in all its roles.
const JOINT: &str = "joint use";

/// The minimum number of levels whose wins have to use a merged type in all its roles; one in a game with fewer than
/// three levels.
const LEVELS: usize = 2;

impl Trial<'_> {
    pub(super) const JOINT: Stage<Self> = Stage {
        name: JOINT,
        purpose: "of an invented game: asks that every type with opposed uses is used in all its roles within one win, on at least two \
                  levels",
        cost: "a replay of each win",
        reasons: &[JOINT],
        ..Stage::once(Self::ask_for_joint_use)
    };

    fn ask_for_joint_use(&mut self, _: &mut Tally) -> Passage {
        let joint = self.levels.source.joint_types();
        if joint.is_empty() {
            return Ok(());
        }
        let used: Vec<BTreeSet<usize>> = self
            .found
            .iter()
            .filter_map(|found| {
                let win = found.report.witness.as_ref()?;
                Some(used_rules(&self.candidate.game, &found.level, win).into_iter().collect())
            })
            .collect();
        let least = LEVELS.min(used.len().saturating_sub(1)).max(1);
        let is_used =
            |lines: &Vec<usize>, used: &BTreeSet<usize>| lines.iter().any(|line| used.contains(line));
        let enough = joint.iter().all(|stype| {
            let all = |used: &&BTreeSet<usize>| stype.uses.iter().all(|lines| is_used(lines, used));
            used.iter().filter(all).count() >= least
        });
        if enough { Ok(()) } else { Err(JOINT.into()) }
    }
}
