//! Interactions by who meets whom: what one type has to do with every other, without going through all rules for each.

use super::encounter::{Deed, Encounter, Side};
use crate::game::{Rules, SpriteType};

/// Interactions between two types that count: those beyond, in order of the tick, are taken for repetitions. Real games
/// have a handful.
pub const MAX_RULES_PER_PAIR: u16 = 64;

/// The interactions between sprites, those written for the same two types together.
pub(super) struct Pairs<'a> {
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
    pub(super) fn of(rules: &'a Rules, encounters: &'a [Encounter]) -> Pairs<'a> {
        let written = |encounter: &Encounter| (encounter.first, encounter.second);
        let groups = encounters.chunk_by(|one, two| written(one) == written(two));
        let group = |encounters: &'a [Encounter]| {
            let [Encounter { first, second: Some(second), .. }, ..] = encounters else { return None };
            Some(Group { first: *first, second: *second, encounters })
        };
        Pairs { rules, encounters, groups: groups.filter_map(group).collect() }
    }

    /// Visits the interactions of a type with every other, in order of the tick: the other, the side on which the type
    /// itself is (the first, if both are possible), and what happens.
    pub(super) fn with(&self, own: SpriteType, mut visit: impl FnMut(SpriteType, Side, &Encounter)) {
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

    /// The types, as written, that some interaction of a type can keep off it.
    pub(super) fn shields(&self, own: SpriteType) -> Vec<SpriteType> {
        let concerned =
            self.encounters.iter().filter(|encounter| self.rules.types[encounter.first.index()].in_tree(own));
        let shield = |deed: &Deed| if let Deed::Shield { from, .. } = deed { Some(*from) } else { None };
        let mut from: Vec<SpriteType> =
            concerned.flat_map(|encounter| &encounter.deeds).filter_map(shield).collect();
        from.sort_unstable();
        from.dedup();
        from
    }
}
