//! The possible meetings, one pair of types at a time, in the order of a tick.

use super::super::encounter::{Deed, Encounter, Provided, Side};
use super::super::prospect::Prospect;
use crate::game::{Rules, SpriteType};
use crate::ontology::effects::Effect;
use smallvec::SmallVec;
use std::collections::{BTreeMap, BTreeSet};

/// The largest number of meetings considered: with more of them the reach is coarse.
const MAX_MEETINGS: usize = 1 << 15;

/// A moment in a tick: a sprite's own update, the timed effects, the edge, or the pass of that number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Order(u32);

impl Order {
    pub(super) const UPDATE: Order = Order(0);
    /// After everything else in a tick.
    pub(super) const LAST: Order = Order(u32::MAX);
    const CLOCK: Order = Order(1);
    const EDGE: Order = Order(2);

    fn pass(number: usize) -> Order {
        Order(3 + number as u32)
    }
}

/// The partner that a sprite meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum With {
    Sprite(SpriteType),
    Edge,
    /// No partner: the effect is timed.
    Nobody,
}

/// An effect that can run on sprites of one type.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting<'a> {
    /// The type it runs on; none: no particular sprite.
    pub(super) one: Option<SpriteType>,
    pub(super) with: With,
    pub(super) effect: u16,
    pub(super) order: Order,
    pub(super) provided: Provided,
    deeds: &'a [Deed],
    /// The number of times that it runs in a tick, on the same two sprites.
    pub(super) times: u16,
    /// Nothing prevents it when the two overlap.
    pub(super) certain: bool,
}

/// A sprite that a meeting can remove.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub(super) stype: SpriteType,
    pub(super) whose: Whose,
    /// It applies to avatars, too: those that are only killed stay where they are.
    pub(super) for_good: bool,
}

/// The sprites that a meeting can remove, relative to its cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whose {
    First,
    Second,
    /// Anywhere.
    All,
}

impl Meeting<'_> {
    /// Returns the sprites that it can remove.
    pub(super) fn ends(&self, rules: &Rules) -> SmallVec<[End; 4]> {
        let mut ends = SmallVec::new();
        let mut end = |stype: Option<SpriteType>, whose: Whose, for_good: bool| {
            ends.extend(stype.map(|stype| End { stype, whose, for_good }));
        };
        // Only resources are collected.
        let collects = self.deeds.contains(&Deed::Collect);
        let first = self.one.filter(|one| !collects || rules.types[one.index()].traits.is_resource);
        for deed in self.deeds {
            match deed {
                // Without an exit, the sprite dies.
                Deed::Kill(Side::First) | Deed::Teleport => end(first, Whose::First, false),
                Deed::Kill(Side::Second) => end(self.two(), Whose::Second, true),
                Deed::Become(_) | Deed::BecomeAny(_) => end(first, Whose::First, true),
                Deed::KillAll(stype) => end(Some(*stype), Whose::All, false),
                Deed::BecomeAll(from, _) => end(Some(*from), Whose::All, true),
                Deed::Health { of, dies_at, .. } if *dies_at > i32::MIN => {
                    end(first, Whose::First, false);
                    let family = of.map_or(&[][..], |of| &*rules.types[of.index()].tree);
                    family.iter().for_each(|&stype| end(Some(stype), Whose::All, false));
                }
                _ => {}
            }
        }
        ends
    }

    pub(super) fn two(&self) -> Option<SpriteType> {
        match self.with {
            With::Sprite(two) => Some(two),
            With::Edge | With::Nobody => None,
        }
    }

    pub(super) fn effect<'r>(&self, rules: &'r Rules) -> &'r Effect {
        &rules.effects[usize::from(self.effect)].effect
    }
}

/// Returns everything that can run in a prospect; None if that is too much. `clockwork`: the timed effects.
pub(super) fn meetings<'a>(
    rules: &Rules,
    prospect: &Prospect<'a>,
    clockwork: &'a [(Option<SpriteType>, SmallVec<[Deed; 2]>)],
) -> Option<Vec<Meeting<'a>>> {
    let there = |written: SpriteType| {
        let tree = rules.types[written.index()].tree.iter().copied();
        tree.filter(|stype| prospect.there[stype.index()])
    };
    let live = prospect.encounters().iter().enumerate().filter(|(at, _)| prospect.live[*at]);
    let timed = rules.timed.iter().zip(clockwork).zip(&prospect.timed).filter(|(_, live)| **live);
    let shield = |effect: u16| match rules.effects[usize::from(effect)].effect {
        Effect::ShieldFrom { stype, keyword } => Some((stype, keyword)),
        _ => None,
    };
    let effects = live.clone().map(|(_, encounter)| encounter.effect);
    let effects = effects.chain(timed.clone().map(|((timed, _), _)| timed.effect));
    let shields: BTreeSet<_> = effects.filter_map(shield).collect();
    let mut repeats: BTreeMap<_, u16> = BTreeMap::new();
    for pass in &rules.passes {
        *repeats.entry((pass.first, Some(pass.second), pass.effect)).or_default() += 1;
    }
    let mut meetings = Vec::new();
    for ((timed, (_, deeds)), _) in timed {
        let meeting = |one: Option<SpriteType>| Meeting {
            one,
            with: With::Nobody,
            effect: timed.effect,
            order: Order::CLOCK,
            provided: Provided::Always,
            deeds,
            times: 1,
            certain: false,
        };
        match timed.target {
            None => meetings.push(meeting(None)),
            Some(target) => meetings.extend(there(target).map(|one| meeting(Some(one)))),
        }
        if meetings.len() > MAX_MEETINGS {
            return None;
        }
    }
    for (number, encounter) in live {
        let Encounter { first, second, effect, provided, ref deeds, .. } = *encounter;
        let info = &rules.effects[usize::from(effect)];
        let batches = matches!(info.effect, Effect::WallBounce | Effect::WallReverse);
        if info.in_batch && !batches {
            // It is never run.
            continue;
        }
        let certain = second.is_none_or(|second| !shields.contains(&(second, encounter.keyword)));
        let order = if second.is_none() { Order::EDGE } else { Order::pass(number) };
        let times = repeats.get(&(first, second, effect)).copied().unwrap_or(1);
        for one in there(first) {
            let meeting =
                |with: With| Meeting { one: Some(one), with, effect, order, provided, deeds, times, certain };
            match second {
                None => meetings.push(meeting(With::Edge)),
                Some(second) => meetings.extend(there(second).map(|two| meeting(With::Sprite(two)))),
            }
            if meetings.len() > MAX_MEETINGS {
                return None;
            }
        }
    }
    Some(meetings)
}
