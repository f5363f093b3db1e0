//! Facts about each type that follow from its interactions with other types, collected in one pass.

use super::facts::{Avatar, Facts, Motion, is_certain};
use crate::analysis::goals::goal::Aims;
use crate::analysis::interactions::encounter::{Encounter, Side};
use crate::analysis::interactions::touch::Harm;
use crate::rules::{Rules, SpriteType};

/// The facts about one type that follow from its interactions.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Marks {
    /// `true` if some interaction involves the type.
    pub(crate) takes_part: bool,
    /// `true` if a collision with the type removes a protected type or creates a forbidden type.
    pub(crate) threat: bool,
    /// `true` if the type blocks something other than an avatar.
    pub(crate) holds_up: bool,
    /// `true` if the type blocks a moving hostile type.
    pub(crate) holds_up_enemies: bool,
    /// `true` if an avatar's shot, or something harmful, always removes the type.
    pub(crate) breakable: bool,
    /// `true` if a moving sprite's collision with the type creates a forbidden type.
    pub(crate) spoilt: bool,
    /// `true` if the type removes shots, or shots remove the type, regardless of the shooter.
    pub(crate) meets_shots: bool,
}

/// Returns, for each type, whether a collision with the type removes a protected type or creates a forbidden
/// type. In each pair of types, the moving type is the threat. If both types move, the second type is the
/// threat.
pub(crate) fn threats(rules: &Rules, encounters: &[Encounter], facts: &[Facts], aims: &Aims) -> Vec<bool> {
    let moving = by_family(rules, |stype| facts[stype.index()].motion != Motion::Still);
    let guarded = by_family(rules, |stype| aims.protect.binary_search(&stype).is_ok());
    let mut threat = vec![false; facts.len()];
    for encounter in encounters {
        let Some(second) = encounter.second else { continue };
        let first = encounter.first;
        let [ones, twos] = [first, second].map(|written| &rules.types[written.index()].tree);
        let spoils = encounter.brings_one_of(&aims.prevent);
        if (encounter.ends(Side::First) && guarded[first.index()]) || (spoils && moving[second.index()]) {
            twos.iter().for_each(|stype| threat[stype.index()] = true);
        }
        if encounter.ends(Side::Second) && guarded[second.index()] {
            ones.iter().for_each(|stype| threat[stype.index()] = true);
        }
        if spoils && !moving[second.index()] {
            let only = ones.iter().filter(|&&stype| !rules.types[second.index()].in_tree(stype));
            only.for_each(|stype| threat[stype.index()] = true);
        }
    }
    threat
}

/// The kinds of harm that types cause, each with one entry per type.
pub(crate) struct Harms<'a> {
    /// The harm to an avatar that touches the type.
    pub(crate) harm: &'a [Harm],
    /// `true` if the type removes a protected type, or creates a forbidden type.
    pub(crate) threat: &'a [bool],
    /// `true` if the type creates harmful sprites.
    pub(crate) source: &'a [bool],
}

/// Computes the [`Marks`] of every type, which are flags derived from its interactions. Cost: O(interactions ×
/// relatives).
pub(crate) fn marks(
    rules: &Rules,
    encounters: &[Encounter],
    facts: &[Facts],
    avatars: &[Avatar],
    aims: &Aims,
    &Harms { harm, threat, source }: &Harms<'_>,
) -> Vec<Marks> {
    let own_shot = |stype: SpriteType| avatars.iter().any(|avatar| avatar.shots.contains(&stype));
    let own_shot: Vec<bool> = (0..facts.len()).map(|at| own_shot(SpriteType(at as u16))).collect();
    let mut launched = own_shot.clone();
    for made in facts.iter().filter(|fact| fact.possible).flat_map(|fact| &fact.makes) {
        launched[made.index()] |= matches!(facts[made.index()].motion, Motion::Straight(_));
    }
    let is_avatar = by_family(rules, |stype| avatars.iter().any(|avatar| avatar.stype == stype));
    let breaks = by_family(rules, |stype| own_shot[stype.index()] || harm[stype.index()] != Harm::None);
    let flies = by_family(rules, |stype| launched[stype.index()]);
    let hostile = by_family(rules, |stype| {
        let (at, fact) = (stype.index(), &facts[stype.index()]);
        let moves = fact.motion != Motion::Still && fact.possible;
        moves && (harm[at] != Harm::None || source[at] || threat[at])
    });

    let blank = |&threat: &bool| Marks { threat, ..Marks::default() };
    let mut marks: Vec<Marks> = threat.iter().map(blank).collect();
    for encounter in encounters {
        let first = encounter.first.index();
        let ones = &rules.types[first].tree;
        ones.iter().for_each(|stype| marks[stype.index()].takes_part = true);
        let Some(second) = encounter.second.map(SpriteType::index) else { continue };
        let twos = &rules.types[second].tree;
        let (certain, blocks) = (is_certain(encounter), encounter.blocks());
        let (ends_first, ends_second) = (encounter.ends(Side::First), encounter.ends(Side::Second));
        let ends = ends_first || ends_second;
        for stype in ones {
            let mark = &mut marks[stype.index()];
            mark.breakable |= certain && ends_first && breaks[second];
            mark.meets_shots |= ends && flies[second];
        }
        let spoils = encounter.brings_one_of(&aims.prevent);
        for stype in twos {
            let mark = &mut marks[stype.index()];
            mark.takes_part = true;
            mark.breakable |= certain && ends_second && breaks[first];
            mark.meets_shots |= ends && flies[first];
            mark.holds_up |= blocks && !is_avatar[first];
            mark.holds_up_enemies |= blocks && hostile[first];
            mark.spoilt |= spoils;
        }
    }
    marks
}

/// Returns, for each type, whether `holds` is true for the type or for any related type in the SpriteSet to which rules
/// on the type apply.
fn by_family(rules: &Rules, holds: impl Fn(SpriteType) -> bool) -> Vec<bool> {
    let own: Vec<bool> = (0..rules.types.len()).map(|at| holds(SpriteType(at as u16))).collect();
    rules.types.iter().map(|info| info.tree.iter().any(|stype| own[stype.index()])).collect()
}
