//! The possible collisions, one pair of types at a time, in the order in which a tick processes them.

use super::super::futures::PossibleFutures;
use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Precondition, Side};
use crate::rules::effects::{Ending, Summary, Target};
use crate::rules::{Rules, SpriteType};
use smallvec::SmallVec;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of possible collisions to consider. If there are more, the reach is coarse.
const MAX_MEETINGS: usize = 1 << 15;

/// A point in a tick: a sprite's own update, the timed effects, the edge, or a numbered pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Order(u32);

impl Order {
    pub(super) const UPDATE: Order = Order(0);
    /// The point after everything else in a tick.
    pub(super) const LAST: Order = Order(u32::MAX);
    const CLOCK: Order = Order(1);
    const EDGE: Order = Order(2);

    fn pass(number: usize) -> Order {
        Order(3 + number as u32)
    }
}

/// The sprite's partner in the collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum With {
    Sprite(SpriteType),
    Edge,
    /// No partner, because the effect is timed.
    NoPartner,
}

/// An effect that can run on sprites of one type.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting<'a> {
    /// The type on which the effect runs, or `None` if the effect does not run on a particular sprite.
    pub(super) one: Option<SpriteType>,
    pub(super) with: With,
    pub(super) effect: u16,
    pub(super) order: Order,
    pub(super) precondition: Precondition,
    effects: &'a [EffectSummary],
    /// The number of times that the effect runs in a tick on the same two sprites.
    pub(super) times: u16,
    /// `true` if nothing prevents the effect when the two sprites overlap.
    pub(super) certain: bool,
}

/// A sprite that a collision can remove.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub(super) stype: SpriteType,
    pub(super) scope: RemovalScope,
    /// `true` if avatars are removed, too. Avatars that are merely killed stay in their cell.
    pub(super) for_good: bool,
}

/// The sprites that a collision can remove, relative to the collision's cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RemovalScope {
    First,
    Second,
    /// Sprites in any cell.
    All,
}

impl Meeting<'_> {
    /// Returns the sprites that the collision can remove.
    pub(super) fn ends(&self, rules: &Rules) -> SmallVec<[End; 4]> {
        let mut ends = SmallVec::new();
        let mut end = |stype: Option<SpriteType>, scope: RemovalScope, for_good: bool| {
            ends.extend(stype.map(|stype| End { stype, scope, for_good }));
        };
        // Only resources are collected.
        let collects = self.effects.contains(&EffectSummary::Collect);
        let first = self.one.filter(|one| !collects || rules.types[one.index()].traits.is_resource);
        for (target, ending) in self.effects.iter().filter_map(EffectSummary::ending) {
            let turned = ending == Ending::Turned;
            match (target, ending) {
                (_, Ending::Health { dies_at: i32::MIN, .. }) => {}
                // If the portal has no exit, the sprite is killed.
                (Target::Side(Side::First), _) => end(first, RemovalScope::First, turned),
                (Target::Side(Side::Second), _) => end(self.two(), RemovalScope::Second, true),
                (Target::All(stype), _) => end(Some(stype), RemovalScope::All, turned),
                (Target::Tree(of), _) => {
                    end(first, RemovalScope::First, false);
                    let family = &rules.types[of.index()].tree;
                    family.iter().for_each(|&stype| end(Some(stype), RemovalScope::All, false));
                }
            }
        }
        ends
    }

    pub(super) fn two(&self) -> Option<SpriteType> {
        match self.with {
            With::Sprite(two) => Some(two),
            With::Edge | With::NoPartner => None,
        }
    }

    pub(super) fn summary<'r>(&self, rules: &'r Rules) -> &'r Summary {
        &rules.effects[usize::from(self.effect)].summary
    }
}

/// Returns all collisions and timed effects in the possible futures, or `None` if there are too many.
pub(super) fn meetings<'a>(
    rules: &Rules,
    futures: &PossibleFutures<'a>,
    timed_effects: &'a [(Option<SpriteType>, SmallVec<[EffectSummary; 2]>)],
) -> Option<Vec<Meeting<'a>>> {
    let exists = |written: SpriteType| {
        let tree = rules.types[written.index()].tree.iter().copied();
        tree.filter(|stype| futures.exists[stype.index()])
    };
    let live = futures.encounters().iter().enumerate().filter(|(at, _)| futures.live[*at]);
    let timed = rules.timed.iter().zip(timed_effects).zip(&futures.timed).filter(|(_, live)| **live);
    let shield = |effect: u16| rules.effects[usize::from(effect)].summary.shield;
    let effects = live.clone().map(|(_, encounter)| encounter.effect);
    let effects = effects.chain(timed.clone().map(|((timed, _), _)| timed.effect));
    let shields: BTreeSet<_> = effects.filter_map(shield).collect();
    let mut repeats: BTreeMap<_, u16> = BTreeMap::new();
    for pass in &rules.passes {
        *repeats.entry((pass.first, Some(pass.second), pass.effect)).or_default() += 1;
    }
    let mut meetings = Vec::new();
    for ((timed, (_, effects)), _) in timed {
        let meeting = |one: Option<SpriteType>| Meeting {
            one,
            with: With::NoPartner,
            effect: timed.effect,
            order: Order::CLOCK,
            precondition: Precondition::Always,
            effects,
            times: 1,
            certain: false,
        };
        match timed.target {
            None => meetings.push(meeting(None)),
            Some(target) => meetings.extend(exists(target).map(|one| meeting(Some(one)))),
        }
        if meetings.len() > MAX_MEETINGS {
            return None;
        }
    }
    for (number, encounter) in live {
        let Encounter { first, second, effect, precondition, ref effects, .. } = *encounter;
        let info = &rules.effects[usize::from(effect)];
        if info.in_batch && info.summary.batch.is_none() {
            // An effect without a batch variant never runs in a batch.
            continue;
        }
        let certain = second.is_none_or(|second| !shields.contains(&(second, encounter.keyword)));
        let order = if second.is_none() { Order::EDGE } else { Order::pass(number) };
        let times = repeats.get(&(first, second, effect)).copied().unwrap_or(1);
        for one in exists(first) {
            let meeting = |with: With| Meeting {
                one: Some(one),
                with,
                effect,
                order,
                precondition,
                effects,
                times,
                certain,
            };
            match second {
                None => meetings.push(meeting(With::Edge)),
                Some(second) => meetings.extend(exists(second).map(|two| meeting(With::Sprite(two)))),
            }
            if meetings.len() > MAX_MEETINGS {
                return None;
            }
        }
    }
    Some(meetings)
}
