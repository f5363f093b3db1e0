//! Requirements on a level's sprites. If a level does not meet them, playing it is pointless.

use super::goal::Condition;
use crate::analysis::Analysis;
use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Side};
use crate::analysis::interactions::lock::{Fate, Key, Sink};
use crate::analysis::types::role::Role;
use crate::rules::SpriteType;

/// The reason for a requirement on levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The player needs an avatar.
    Avatar,
    /// The termination at this index must not hold at the start.
    Goal(usize),
    /// Without the required sprites, the termination at this index could never hold.
    WinMethod(usize),
    /// Locks of this type need this amount of their key.
    Lock(SpriteType),
    /// Portals of this type need an exit.
    Portal(SpriteType),
}

/// The maximum number of terminations, in order of priority, from which requirements are derived. Real games
/// have only a few terminations.
pub const MAX_GOALS: usize = 64;

/// A requirement on the total number of sprites of certain types in a level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Requirement {
    /// The counted types, restricted to types that levels can place. If the list is empty, no level can meet
    /// the requirement.
    pub types: Vec<SpriteType>,
    /// The minimum total number of sprites.
    pub at_least: u32,
    /// The maximum total number of sprites; `None` for no maximum.
    pub at_most: Option<u32>,
    /// The reason for the requirement.
    pub reason: Reason,
}

pub(crate) fn requirements(analysis: &Analysis) -> Vec<Requirement> {
    let mut list = Vec::new();
    let placeable = |types: &[SpriteType]| -> Vec<SpriteType> {
        let mut types: Vec<SpriteType> =
            types.iter().copied().filter(|stype| !analysis.facts(*stype).symbols.is_empty()).collect();
        types.sort_unstable();
        types.dedup();
        types
    };
    let makers = makers(analysis);
    let starts: Vec<SpriteType> = analysis.avatars.iter().map(|avatar| avatar.stype).collect();
    let (types, reason) = (placeable(&starts), Reason::Avatar);
    list.push(Requirement { types, at_least: 1, at_most: Some(1), reason });
    for (at, goal) in analysis.goals.iter().enumerate().take(MAX_GOALS) {
        let types = placeable(goal.condition.types());
        let only_avatars = types.iter().all(|&stype| analysis.role(stype) == Role::Avatar);
        if only_avatars && !types.is_empty() {
            continue;
        }
        let (at_least, at_most) = match goal.condition {
            Condition::AtMost(_, limit) if limit >= 0 => (count(limit) + 1, None),
            Condition::Exactly(_, 0) => (1, None),
            Condition::AtLeast(_, limit) | Condition::Exactly(_, limit) if limit >= 1 => {
                (0, Some(count(limit) - 1))
            }
            Condition::AtMost(..) | Condition::AtLeast(..) | Condition::Exactly(..) | Condition::Tick(_) => {
                continue;
            }
        };
        if !types.is_empty() || at_least > 0 {
            list.push(Requirement { types, at_least, at_most, reason: Reason::Goal(at) });
        }
        if goal.win {
            list.extend(methods(analysis, at, &makers));
        }
    }
    list.extend(keys(analysis));
    list.extend(portals(analysis));
    let mut seen: Vec<Requirement> = Vec::new();
    list.retain(|requirement| {
        let new = !seen.contains(requirement);
        seen.extend(new.then(|| requirement.clone()));
        new
    });
    list
}

/// Converts a parameter into a number of sprites. Negative values count as 0.
fn count(number: i32) -> u32 {
    u32::try_from(number).unwrap_or(0)
}

/// Returns, for each type, the first interaction that creates its sprites.
fn makers(analysis: &Analysis) -> Vec<Option<&Encounter>> {
    let mut makers = vec![None; analysis.facts.len()];
    for encounter in &analysis.encounters {
        for effect in &encounter.effects {
            if let EffectSummary::Become(to) | EffectSummary::Make(to) = effect {
                makers[to.index()].get_or_insert(encounter);
            }
        }
    }
    makers
}

/// Returns the requirements for a win by the termination at index `at`: for creating the sprites that it counts or, if
/// there must be few of them, for removing them by pushes.
fn methods(analysis: &Analysis, at: usize, makers: &[Option<&Encounter>]) -> Vec<Requirement> {
    let condition = &analysis.goals[at].condition;
    let wants_more = match condition {
        Condition::AtLeast(_, limit) | Condition::Exactly(_, limit) => *limit > 0,
        Condition::AtMost(..) | Condition::Tick(_) => false,
    };
    let mut list = Vec::new();
    let single = |stype: SpriteType, at_least: u32| {
        let types = vec![stype];
        Requirement { types, at_least, at_most: None, reason: Reason::WinMethod(at) }
    };
    if wants_more {
        for &wanted in condition.types() {
            let Some(encounter) = makers[wanted.index()] else { continue };
            let sides = [(Some(encounter.first), Side::First), (encounter.second, Side::Second)];
            for (written, side) in sides.into_iter().filter_map(|(written, side)| Some((written?, side))) {
                let tree = &analysis.game.0.types[written.index()].tree;
                let placed = |stype: &&SpriteType| {
                    !analysis.facts(**stype).symbols.is_empty() && analysis.role(**stype) != Role::Avatar
                };
                let is_spent = encounter.ends(side) && tree.len() == 1 && !is_created(analysis, written);
                let least = if is_spent { missing(analysis, condition) } else { 1 };
                list.extend(tree.iter().find(placed).map(|&stype| single(stype, least)));
            }
        }
        return list;
    }
    for pushable in analysis.pushables.iter().filter(|pushable| condition.types().contains(&pushable.stype)) {
        let placed = |partner: SpriteType| !analysis.facts(partner).symbols.is_empty();
        // Prefer a sprite that stays in place over another pushable sprite.
        let spoils =
            |sink: &&Sink| matches!(sink.fate, Fate::Becomes(to) if analysis.aims.prevent.contains(&to));
        let sinks = pushable.sinks.iter().filter(|sink| placed(sink.partner) && !spoils(sink));
        let sink = sinks.min_by_key(|sink| analysis.role(sink.partner) == Role::Pushable);
        list.extend(sink.map(|sink| single(sink.partner, 1)));
    }
    list
}

/// Returns `true` if sprites of the type can appear after the start.
fn is_created(analysis: &Analysis, stype: SpriteType) -> bool {
    let creates = |effect: &EffectSummary| {
        let created = matches!(effect, EffectSummary::Become(to) | EffectSummary::Make(to) if *to == stype);
        created || matches!(effect, EffectSummary::BecomeAll(_, to) if *to == stype)
    };
    analysis.encounters.iter().any(|met| met.does(creates))
        || analysis.facts.iter().any(|facts| facts.makes.contains(&stype))
}

/// Returns the number of sprites that a win must create for a condition: 1 if levels can place some of them, or if
/// several types count.
fn missing(analysis: &Analysis, condition: &Condition) -> u32 {
    let (Condition::AtLeast(types, limit) | Condition::Exactly(types, limit)) = condition else { return 1 };
    match types[..] {
        [wanted] if analysis.facts(wanted).symbols.is_empty() => count(*limit).max(1),
        _ => 1,
    }
}

/// Returns the requirements that give a level enough keys for one lock of each type.
fn keys(analysis: &Analysis) -> Vec<Requirement> {
    let mut list = Vec::new();
    for lock in &analysis.locks {
        let placed = |giver: &&(SpriteType, i32)| !analysis.facts(giver.0).symbols.is_empty();
        let types: Vec<SpriteType> = lock.givers.iter().filter(placed).map(|giver| giver.0).collect();
        let least = lock.givers.iter().filter(placed).map(|giver| giver.1.max(1)).min();
        let (Some(least), false) = (least, types.is_empty()) else { continue };
        let at_least = match lock.key {
            Key::Resource { amount, .. } => count(amount).max(1).div_ceil(count(least).max(1)),
            Key::Avatar(_) | Key::Switch(..) => 1,
        };
        list.push(Requirement { types, at_least, at_most: None, reason: Reason::Lock(lock.stype) });
    }
    list
}

fn portals(analysis: &Analysis) -> Vec<Requirement> {
    let mut list = Vec::new();
    for stype in analysis.of_role(Role::Portal) {
        let exit = analysis.leads_to(stype);
        if let Some(exit) = exit.filter(|&exit| !analysis.facts(exit).symbols.is_empty()) {
            let reason = Reason::Portal(stype);
            list.push(Requirement { types: vec![exit], at_least: 1, at_most: None, reason });
        }
    }
    list
}
