//! Removals that cost a resource. A win is impossible if there is not enough of the resource for all required
//! removals.

use super::cause::{Cause, Unpaid};
use crate::analysis::Analysis;
use crate::analysis::goals::attain::disappears_by_itself;
use crate::analysis::goals::goal::Condition;
use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Precondition, Side};
use crate::analysis::reach::events::Events;
use crate::rules::SpriteType;
use crate::rules::effects::{Ending, Movement, Target};
use std::collections::BTreeSet;

/// A removal that costs the other sprite some of a resource.
struct Payment {
    resource: SpriteType,
    each: i64,
    removing: usize,
    taking: usize,
}

impl Analysis {
    /// Returns the reason why too few of the counted sprites can be removed, if the removals cost more of a
    /// resource than is obtainable. Returns `None` if this is uncertain.
    pub(in crate::analysis::reach) fn unpaid(
        &self,
        condition: &Condition,
        events: &Events<'_>,
    ) -> Option<Cause> {
        let (Condition::AtMost(types, limit) | Condition::Exactly(types, limit)) = condition else {
            return None;
        };
        let (rules, model) = (&*self.game.0, events.flood.model);
        let distinct: BTreeSet<SpriteType> = types.iter().copied().collect();
        let has_duplicates = distinct.len() < types.len();
        let goes_by_itself = |&stype: &SpriteType| {
            let info = &rules.types[stype.index()];
            let singleton = info.path.iter().any(|&stype| rules.types[stype.index()].singleton);
            singleton || info.is_like_avatar() || disappears_by_itself(rules, stype)
        };
        if has_duplicates
            || types.iter().any(goes_by_itself)
            || !rules.timed.is_empty()
            || !self.only_falls(types)
        {
            return None;
        }
        let placed = |stype: &SpriteType| events.placed()[stype.index()].iter();
        let present: i64 = types.iter().flat_map(placed).map(|(_, count)| i64::from(*count)).sum();
        let removals = present.saturating_sub(i64::from(*limit));
        if removals < 1 {
            return None;
        }
        let mut payments: Vec<Payment> = Vec::new();
        for at in 0..self.encounters.len() {
            payments.extend(self.payments(at, types, events)?);
        }
        let first = payments.first()?;
        let resource = first.resource;
        let each = payments.iter().map(|payment| payment.each).min()?;
        let most = events.have[resource.index()];
        let is_short = most.checked_div(each).is_some_and(|paid| paid < removals);
        let other = payments.iter().any(|payment| payment.resource != resource);
        if other || !is_short || model.unlimited[resource.index()] {
            return None;
        }
        let lines = |of: fn(&Payment) -> usize| -> Vec<usize> {
            payments.iter().map(of).collect::<BTreeSet<_>>().into_iter().collect()
        };
        let target = types.iter().copied().find(|stype| placed(stype).next().is_some())?;
        let (removing, taking) = (lines(|payment| payment.removing), lines(|payment| payment.taking));
        Some(Cause::Unpaid(Unpaid { target, removals, resource, each, most, removing, taking }))
    }

    /// Returns the payments in an interaction that can remove sprites of these types. The list is empty if
    /// the interaction cannot remove such sprites. Returns `None` if the interaction may remove a sprite
    /// without payment.
    fn payments(&self, at: usize, types: &[SpriteType], events: &Events<'_>) -> Option<Vec<Payment>> {
        let encounter = &self.encounters[at];
        let covers = |written: SpriteType| types.iter().any(|&stype| self.applies(written, stype));
        let (first, second) = (covers(encounter.first), encounter.second.is_some_and(covers));
        let mut payments = Vec::new();
        for effect in &encounter.effects {
            let side = match effect.ending() {
                Some((Target::All(of) | Target::Tree(of), _)) if covers(of) => return None,
                Some((Target::All(_) | Target::Tree(_), _) | (_, Ending::Health { by: 0.., .. })) => continue,
                Some((Target::Side(side), _)) => side,
                None if *effect == EffectSummary::Collect => Side::First,
                None if *effect == EffectSummary::Clone && self.is_avatars(encounter.first, events) => {
                    return None;
                }
                None => continue,
            };
            if !(if side == Side::First { first } else { second }) || !self.can_happen(encounter, events) {
                continue;
            }
            payments.push(self.payment(at, side, types, events)?);
        }
        Some(payments)
    }

    /// Returns `true` unless an interaction provably never takes effect.
    fn can_happen(&self, encounter: &Encounter, events: &Events<'_>) -> bool {
        let occurs = |written: SpriteType| {
            let mut family = self.game.0.types[written.index()].tree.iter();
            family.any(|&stype| events.can_occur(stype))
        };
        occurs(encounter.first)
            && encounter.second.is_none_or(occurs)
            && events.can_be(encounter.precondition)
    }

    /// Returns the payment for removing a sprite on one side of an interaction, or `None` if the removal may
    /// cost nothing.
    fn payment(&self, at: usize, side: Side, types: &[SpriteType], events: &Events<'_>) -> Option<Payment> {
        let encounter = &self.encounters[at];
        let (payer, pays) = match side {
            Side::First => (encounter.second?, Side::Second),
            Side::Second => (encounter.first, Side::First),
        };
        let Precondition::Holds(holder, resource, least) = encounter.precondition else { return None };
        if holder != pays || least < 1 || !self.is_one_avatar(payer, events) {
            return None;
        }
        let taken = |encounter: &Encounter, payer: Side| {
            encounter.effects.iter().find_map(|effect| {
                let EffectSummary::Change { side, resource: changed, by } = effect else { return None };
                (*side == payer && *changed == resource).then(|| -i64::from(*by))
            })
        };
        let at_once = taken(encounter, pays);
        if let Some(each) = at_once {
            let all = each >= 1 && each <= i64::from(least);
            return all.then_some(Payment {
                resource,
                each,
                removing: encounter.line,
                taking: encounter.line,
            });
        }
        // In the same tick, the next rule for the two sprites takes the resource, provided that the sprites
        // still overlap.
        let takes = |later: &Encounter| {
            let by = taken(later, Side::First)?;
            let second = later.second?;
            let all = |written: SpriteType, of: &mut dyn Iterator<Item = SpriteType>| {
                of.filter(|&stype| events.can_occur(stype)).all(|stype| self.applies(written, stype))
            };
            let payers: Vec<SpriteType> = self.game.0.types[payer.index()].tree.to_vec();
            let covers = all(later.first, &mut payers.into_iter()) && all(second, &mut types.iter().copied());
            let each = by.min(i64::from(least));
            (covers && each >= 1 && later.precondition == Precondition::Always).then_some(each)
        };
        let mut later = self.encounters.iter().enumerate().skip(at + 1);
        let (found, each) = later.find_map(|(at, later)| Some((at, takes(later)?)))?;
        let taking = &self.encounters[found];
        let parts = |between: &Encounter| {
            let apart = |effect: &EffectSummary| match (effect.movement(), effect.ending()) {
                (Some(Movement::AllBack(_)), _) => true,
                (Some(Movement::Back | Movement::Away), _) => self.is_avatars(between.first, events),
                (None, Some((Target::All(from), Ending::Turned))) => self.is_avatars(from, events),
                (None, Some((_, Ending::Turned))) => self.is_avatars(between.first, events),
                (None, _) => *effect == EffectSummary::Clone && self.is_avatars(between.first, events),
            };
            between.does(apart) && self.can_happen(between, events)
        };
        let keyword = &self.game.description().interactions[taking.line].effect.text;
        let shields = |effect: &EffectSummary| matches!(effect, EffectSummary::Shield { keyword: shielded, .. } if shielded.eq_ignore_ascii_case(keyword));
        let is_shielded = self.encounters.iter().any(|other| other.does(shields));
        let one_at_a_time = self.are_apart(types, payer, events);
        let is_sure = one_at_a_time && !is_shielded && !self.encounters[at + 1..found].iter().any(parts);
        is_sure.then_some(Payment { resource, each, removing: encounter.line, taking: taking.line })
    }

    /// Returns `true` if a rule on `written` applies to a possible avatar type.
    fn is_avatars(&self, written: SpriteType, events: &Events<'_>) -> bool {
        let mut avatars = self.avatars.iter().map(|avatar| avatar.stype);
        avatars.any(|stype| events.can_occur(stype) && self.applies(written, stype))
    }

    /// Returns `true` if a type's only sprite is the avatar, because nothing creates another sprite of the
    /// type.
    fn is_one_avatar(&self, written: SpriteType, events: &Events<'_>) -> bool {
        let rules = &*self.game.0;
        let own = rules.types[written.index()].tree.iter().filter(|&&stype| events.can_occur(stype));
        let is_avatar = |stype: SpriteType| rules.types[stype.index()].is_like_avatar();
        let made = |stype: &SpriteType| is_avatar(*stype) && events.can_occur(*stype);
        let makes = |effect: &EffectSummary| matches!(effect, EffectSummary::Make(to) | EffectSummary::BecomeAll(_, to) if made(to));
        let by_itself =
            |maker: SpriteType| events.can_occur(maker) && self.facts(maker).makes.iter().any(made);
        let turns = |encounter: &Encounter| {
            let becomes = encounter.effects.iter().any(|effect| {
                matches!(effect, EffectSummary::Become(_) | EffectSummary::BecomeAny(_))
                    && effect.makes().iter().any(made)
            });
            let family = rules.types[encounter.first.index()].tree.iter();
            becomes && !family.filter(|&&stype| events.can_occur(stype)).all(|&stype| is_avatar(stype))
        };
        own.clone().all(|&stype| is_avatar(stype))
            && !self.encounters.iter().any(|encounter| encounter.does(makes) || turns(encounter))
            && !self.game.sprite_types().any(by_itself)
    }

    /// Returns `true` if an avatar never touches two sprites of these types at the same time, because they
    /// are motionless and apart from each other.
    fn are_apart(&self, types: &[SpriteType], payer: SpriteType, events: &Events<'_>) -> bool {
        let model = events.flood.model;
        let still = types.iter().all(|&stype| {
            let own = model.of_type(stype);
            own.fixed && !own.off_grid && !model.is_scaled(stype)
        });
        let payers = self.game.0.types[payer.index()].tree.iter();
        let mut payers = payers.filter(|&&stype| events.can_occur(stype));
        let small = payers.all(|&stype| !model.is_scaled(stype)) && model.rules.reach <= 1;
        let cells: Vec<(usize, u32)> =
            types.iter().flat_map(|stype| events.placed()[stype.index()].iter().copied()).collect();
        let columns = i64::from(events.board().columns);
        let place = |cell: usize| {
            let at = events.board().on_level(cell) as i64;
            (at % columns, at / columns)
        };
        let near = |&(one, _): &(usize, u32), &(two, _): &(usize, u32)| {
            let ((x, y), (u, v)) = (place(one), place(two));
            (x - u).abs().max((y - v).abs()) < 2
        };
        let alone = |(number, one): (usize, &(usize, u32))| {
            one.1 == 1 && cells[number + 1..].iter().all(|two| !near(one, two))
        };
        still && small && cells.iter().enumerate().all(alone)
    }
}
