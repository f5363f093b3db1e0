//! Interactions grouped by pair of types, so that one type can be checked against every other type without
//! scanning all rules.

use super::encounter::{EffectSummary, Encounter, Side};
use crate::rules::{Rules, SpriteType};

/// The maximum number of interactions to consider for a pair of types. Interactions that come later in a tick
/// are assumed to be repetitions. Real games have only a few interactions per pair.
pub const MAX_RULES_PER_PAIR: u16 = 64;

/// The interactions between sprites, grouped by their pair of types.
pub(crate) struct Pairs<'a> {
    rules: &'a Rules,
    encounters: &'a [Encounter],
    groups: Vec<Group<'a>>,
}

struct Group<'a> {
    first: SpriteType,
    second: SpriteType,
    encounters: &'a [Encounter],
}

impl<'a> Pairs<'a> {
    pub(crate) fn of(rules: &'a Rules, encounters: &'a [Encounter]) -> Pairs<'a> {
        let written = |encounter: &Encounter| (encounter.first, encounter.second);
        let groups = encounters.chunk_by(|one, two| written(one) == written(two));
        let group = |encounters: &'a [Encounter]| {
            let [Encounter { first, second: Some(second), .. }, ..] = encounters else { return None };
            Some(Group { first: *first, second: *second, encounters })
        };
        Pairs { rules, encounters, groups: groups.filter_map(group).collect() }
    }

    /// Visits the interactions of a type with every other type, in the order in which a tick checks them.
    /// `visit` receives the other type, the side of `own`, and the interaction. If the type matches both
    /// sides, `visit` receives the first side.
    pub(crate) fn with(&self, own: SpriteType, mut visit: impl FnMut(SpriteType, Side, &Encounter)) {
        let mut seen = vec![0u16; self.rules.types.len()];
        let mut visit = |group: &Group<'_>, other: SpriteType, side: Side| {
            for encounter in group.encounters {
                let seen = &mut seen[other.index()];
                if *seen == MAX_RULES_PER_PAIR {
                    return;
                }
                *seen += 1;
                visit(other, side, encounter);
            }
        };
        for group in &self.groups {
            let [first, second] =
                [group.first, group.second].map(|written| &self.rules.types[written.index()]);
            let (is_first, is_second) = (first.in_tree(own), second.in_tree(own));
            if is_first {
                second.tree.iter().for_each(|&other| visit(group, other, Side::First));
            }
            if is_second {
                let others = first.tree.iter().filter(|&&other| !(is_first && second.in_tree(other)));
                others.for_each(|&other| visit(group, other, Side::Second));
            }
        }
    }

    /// Returns the types, as written in the rules, against which some interaction can shield sprites of
    /// `own`.
    pub(crate) fn shields(&self, own: SpriteType) -> Vec<SpriteType> {
        let concerned =
            self.encounters.iter().filter(|encounter| self.rules.types[encounter.first.index()].in_tree(own));
        let shield = |effect: &EffectSummary| {
            if let EffectSummary::Shield { from, .. } = effect { Some(*from) } else { None }
        };
        let mut from: Vec<SpriteType> =
            concerned.flat_map(|encounter| &encounter.effects).filter_map(shield).collect();
        from.sort_unstable();
        from.dedup();
        from
    }
}
