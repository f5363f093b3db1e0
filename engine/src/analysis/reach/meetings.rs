//! Who can meet whom, one pair of types at a time, in the order of a tick.

use super::super::encounter::{Encounter, Provided};
use super::super::prospect::Prospect;
use crate::game::{Rules, SpriteType};
use crate::ontology::effects::Effect;

/// Meetings that are looked at, at most: with more of them the reach is coarse.
const MAX_MEETINGS: usize = 1 << 15;

/// When in a tick something happens: by a sprite's own update, by the clock, at the edge, or in the pass of that number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Order(u32);

impl Order {
    pub(super) const UPDATE: Order = Order(0);
    /// After all that happens in a tick.
    pub(super) const LAST: Order = Order(u32::MAX);
    const CLOCK: Order = Order(1);
    const EDGE: Order = Order(2);

    fn pass(number: usize) -> Order {
        Order(3 + number as u32)
    }
}

/// Whom a sprite meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum With {
    Sprite(SpriteType),
    Edge,
    /// Nobody: the effect runs by the clock.
    Nobody,
}

/// An effect that can run on sprites of one type.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// None: on no sprite in particular.
    pub(super) one: Option<SpriteType>,
    pub(super) with: With,
    pub(super) effect: u16,
    pub(super) order: Order,
    pub(super) provided: Provided,
    /// Nothing keeps it from running when the two overlap.
    pub(super) certain: bool,
}

impl Meeting {
    pub(super) fn two(&self) -> Option<SpriteType> {
        match self.with {
            With::Sprite(two) => Some(two),
            With::Edge | With::Nobody => None,
        }
    }

    pub(super) fn effect<'a>(&self, rules: &'a Rules) -> &'a Effect {
        &rules.effects[usize::from(self.effect)].effect
    }
}

/// Everything that can run, from what can come; None if it is too much.
pub(super) fn meetings(rules: &Rules, prospect: &Prospect<'_>) -> Option<Vec<Meeting>> {
    let there = |written: SpriteType| {
        let tree = rules.types[written.index()].tree.iter().copied();
        tree.filter(|stype| prospect.there[stype.index()])
    };
    let live = || prospect.encounters().iter().zip(&prospect.live).filter(|(_, live)| **live);
    let mut meetings = Vec::new();
    for (timed, _) in rules.timed.iter().zip(&prospect.timed).filter(|(_, live)| **live) {
        let meeting = |one: Option<SpriteType>| Meeting {
            one,
            with: With::Nobody,
            effect: timed.effect,
            order: Order::CLOCK,
            provided: Provided::Always,
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
    for (number, encounter) in prospect.encounters().iter().enumerate().filter(|(at, _)| prospect.live[*at]) {
        let Encounter { first, second, effect, provided, .. } = *encounter;
        let info = &rules.effects[usize::from(effect)];
        let batches = matches!(info.effect, Effect::WallBounce | Effect::WallReverse);
        if info.in_batch && !batches {
            // It is never run, whatever happens.
            continue;
        }
        let mut shields = live().map(|(other, _)| &rules.effects[usize::from(other.effect)].effect);
        let certain =
            second.is_none() || !shields.any(|effect| shields_from(effect, second, encounter.keyword));
        let order = if second.is_none() { Order::EDGE } else { Order::pass(number) };
        for one in there(first) {
            let meeting = |with: With| Meeting { one: Some(one), with, effect, order, provided, certain };
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

/// Whether an effect keeps a keyword's interactions with that partner from running.
fn shields_from(effect: &Effect, partner: Option<SpriteType>, keyword: u16) -> bool {
    matches!(effect, Effect::ShieldFrom { stype, keyword: off } if Some(*stype) == partner && *off == keyword)
}
