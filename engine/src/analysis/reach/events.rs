//! The main fixed point: sprites move, create other sprites, obtain resources and collide, until nothing
//! changes.

use super::cells::{Board, Cells, Directions};
use super::flood::Flood;
use super::meetings::{End, Meeting, Order, RemovalScope, With};
use crate::analysis::interactions::encounter::Precondition;
use crate::rules::SpriteType;
use crate::rules::effects::{Displacement, Gives};
use std::collections::BTreeMap;

/// An amount of a resource that counts as unlimited: more than any rule requires.
const PLENTY: i64 = i64::MAX;

/// For each type, the cells in which a level places its sprites, each with the number of sprites in that
/// cell.
pub(super) type Placed = Vec<Vec<(usize, u32)>>;

/// The main fixed point, which applies the effects of collisions until nothing changes.
pub(super) struct Events<'a> {
    pub(super) flood: Flood<'a>,
    placed: &'a Placed,
    ring: Cells,
    /// For each type, the total obtainable amount of the type as a resource.
    pub(super) have: Vec<i64>,
    /// For each possible collision, the versions of the two regions when it was last processed.
    seen: Vec<(u32, u32)>,
}

/// A source of a resource: the cells of its sprites, the amount that each sprite gives, and whether a sprite
/// is used up by giving.
pub(super) struct Gift {
    pub(super) cells: Cells,
    each: i64,
    once: bool,
}

impl<'a> Events<'a> {
    pub(super) fn of(flood: Flood<'a>, placed: &'a Placed) -> Events<'a> {
        let ring = flood.board.ring();
        let (types, meetings) = (flood.model.exists.len(), flood.model.meetings.len());
        Events { flood, placed, ring, have: vec![0; types], seen: vec![(u32::MAX, u32::MAX); meetings] }
    }

    /// Runs until nothing changes. Returns `false` if the work budget is exceeded.
    pub(super) fn settle(&mut self) -> bool {
        loop {
            let before = self.state();
            self.flood.work += (self.flood.model.meetings.len() + self.have.len()) as u64;
            self.flood.spread();
            self.make();
            self.flood.spread();
            self.have = self.resources();
            for at in 0..self.flood.model.meetings.len() {
                // A pushed sprite may be pushed again.
                while !self.flood.is_over_budget() && self.meet(at) {}
            }
            if self.flood.is_over_budget() {
                return false;
            }
            if self.state() == before {
                return true;
            }
        }
    }

    fn state(&self) -> (u64, Vec<i64>, u64) {
        let versions = self.flood.regions.iter().map(|region| u64::from(region.version)).sum();
        (versions, self.have.clone(), self.flood.ends)
    }

    pub(super) fn board(&self) -> Board {
        self.flood.board
    }

    /// Returns the cost of a pass over a set of cells, in single-cell units. A pass processes many cells at a
    /// time.
    fn sweep(&self) -> u64 {
        1 + self.board().size() as u64 / 512
    }

    pub(super) fn touch(&self, stype: SpriteType) -> &Cells {
        &self.flood.regions[stype.index()].touch
    }

    pub(super) fn rest(&self, stype: SpriteType) -> &Cells {
        &self.flood.regions[stype.index()].rest
    }

    pub(super) fn can_occur(&self, stype: SpriteType) -> bool {
        self.flood.model.exists[stype.index()] && !self.touch(stype).is_empty()
    }

    /// Returns the cells that a sprite of the type can overlap during a collision in `cells`.
    pub(super) fn near(&mut self, stype: SpriteType, cells: &Cells) -> Cells {
        let spread = self.flood.model.spread(stype);
        self.flood.work += if spread == 0 { self.sweep() } else { self.board().size() as u64 };
        let around = self.board().around(cells, spread);
        around.shared(self.touch(stype))
    }

    pub(super) fn appear_in(&mut self, stype: SpriteType, cells: &Cells, at: Order, heading: Directions) {
        // A sprite that is larger than its maker, or between cells like its maker, extends to the right and
        // down.
        let more = self.flood.model.spread(stype);
        let grows = self.flood.model.scales && more > 0;
        let cells = if grows { self.board().around(cells, more) } else { cells.clone() };
        cells.iter().for_each(|cell| self.flood.appear(stype, cell, at, heading));
    }

    /// Adds sprites that an effect creates without giving them an orientation.
    pub(super) fn spawn_in(&mut self, stype: SpriteType, cells: &Cells, at: Order) {
        let heading = self.flood.model.born(stype);
        self.appear_in(stype, cells, at, heading);
    }

    /// Moves sprites to cells as the result of an effect. The sprites may face any of their possible
    /// directions.
    pub(super) fn come_to(&mut self, stype: SpriteType, cells: &Cells, at: Order) {
        let heading = self.flood.model.of_type(stype).facing;
        cells.iter().for_each(|cell| self.flood.come(stype, cell, at, heading));
    }

    /// Returns the sprites placed by the level.
    pub(super) fn placed(&self) -> &'a Placed {
        self.placed
    }

    /// Returns the sources of resources, by resource and by the type of the sprites that provide it.
    pub(super) fn gifts(&mut self) -> BTreeMap<(SpriteType, SpriteType), Gift> {
        let mut gifts: BTreeMap<(SpriteType, SpriteType), Gift> = BTreeMap::new();
        for meeting in self.flood.model.meetings {
            let (Some(one), Some(two)) = (meeting.one, meeting.two()) else { continue };
            if !self.can_occur(one) || !self.can_occur(two) || !self.can_be(meeting.precondition) {
                continue;
            }
            let value = i64::from(self.flood.model.info(one).traits.value);
            let (resource, giver, each, once) = match meeting.summary(self.flood.model.rules).gives {
                Some(Gives::First { used_up }) => {
                    (self.flood.model.info(one).traits.resource, one, value, used_up)
                }
                Some(Gives::Amount { resource, value, used_up }) => {
                    // A sprite that has been used up can collide once more in the same tick.
                    (resource, two, i64::from(value) * i64::from(meeting.times), used_up)
                }
                None => continue,
            };
            let cells = self.met(one, two, meeting.order);
            self.flood.work += self.sweep();
            let collected = giver == one;
            let nothing = collected && !self.flood.model.info(one).traits.is_resource;
            if each <= 0 || resource == SpriteType::NONE || cells.is_empty() || nothing {
                continue;
            }
            let none = || Gift { cells: Cells::none(self.board()), each: 0, once: true };
            let gift = gifts.entry((resource, giver)).or_insert_with(none);
            gift.cells.add(&cells);
            // Collecting removes the collected sprite, whereas each of the other rules may give the resource
            // once more.
            gift.each = if collected { gift.each.max(each) } else { gift.each.saturating_add(each) };
            gift.once &= once;
        }
        gifts
    }

    /// Returns the obtainable amount of each resource.
    fn resources(&mut self) -> Vec<i64> {
        let gifts = self.gifts();
        let unlimited = self.flood.model.unlimited.iter();
        let mut have: Vec<i64> = unlimited.map(|&unlimited| if unlimited { PLENTY } else { 0 }).collect();
        for ((resource, giver), gift) in gifts {
            let at = giver.index();
            let still = self.flood.model.of_type(giver).fixed;
            let met = self.placed[at].iter().filter(|(cell, _)| !still || gift.cells.contains(*cell));
            let count: i64 = met.map(|(_, count)| i64::from(*count)).sum();
            let limited = gift.once && !self.flood.made[at];
            let amount = if limited { count.saturating_mul(gift.each) } else { PLENTY };
            have[resource.index()] = have[resource.index()].saturating_add(amount);
        }
        have
    }

    /// Returns `true` if an effect's condition can hold.
    pub(super) fn can_be(&self, precondition: Precondition) -> bool {
        match precondition {
            Precondition::Holds(_, resource, amount) => {
                let limit = self.flood.model.info(resource).resource_limit;
                let within = amount <= limit || self.flood.model.unlimited[resource.index()];
                amount <= 0 || (within && self.have[resource.index()] >= i64::from(amount))
            }
            Precondition::Chance(prob) => prob > 0.0,
            Precondition::Always | Precondition::HoldsAtMost(..) | Precondition::Movement => true,
        }
    }

    /// Returns the cells that sprites of two types can share at the given point in a tick.
    fn met(&self, one: SpriteType, two: SpriteType, at: Order) -> Cells {
        self.flood.present(one, at, true).shared(&self.flood.present(two, at, false))
    }

    /// Processes a possible collision of two types, if any of its inputs has changed. Returns `true` if the
    /// region of either type has changed.
    fn meet(&mut self, at: usize) -> bool {
        let meeting = self.flood.model.meetings[at];
        let version =
            |stype: Option<SpriteType>| stype.map_or(0, |stype| self.flood.regions[stype.index()].version);
        let versions = (version(meeting.one), version(meeting.two()));
        let summary = meeting.summary(self.flood.model.rules);
        // These effects depend on more than the two types' regions.
        let far = summary.displacement == Some(Displacement::Exit)
            || summary.becomes_all().is_some()
            || summary.redirects.is_some();
        if (self.seen[at] == versions && !far) || !self.can_be(meeting.precondition) {
            return false;
        }
        self.flood.work += self.sweep();
        let Some(one) = meeting.one else {
            self.at_large(&meeting);
            return false;
        };
        if !self.can_occur(one) {
            return false;
        }
        let cells = match meeting.with {
            With::Sprite(two) if self.can_occur(two) => self.met(one, two, meeting.order),
            With::Sprite(_) => return false,
            With::Edge => self.touch(one).shared(&self.ring),
            With::NoPartner => self.touch(one).clone(),
        };
        if cells.is_empty() {
            return false;
        }
        let again = self.seen[at] != versions;
        self.seen[at] = versions;
        self.run(&meeting, one, &cells);
        self.end(&meeting, &cells);
        again
    }

    /// Applies an effect that does not run on a particular sprite.
    fn at_large(&mut self, meeting: &Meeting<'_>) {
        let summary = meeting.summary(self.flood.model.rules);
        if let Some((from, to)) = summary.becomes_all().filter(|_| !summary.needs_partner) {
            self.become_all(from, to, meeting.order);
        }
        self.end(meeting, &Cells::default());
    }

    /// Removes the sprites that a collision in the given cells can remove.
    fn end(&mut self, meeting: &Meeting<'_>, cells: &Cells) {
        for End { stype, scope, .. } in meeting.ends(self.flood.model.rules) {
            let at = match scope {
                RemovalScope::All => Cells::all(self.board()),
                RemovalScope::First | RemovalScope::Second => self.near(stype, cells),
            };
            self.flood.end(stype, &at);
        }
    }
}
