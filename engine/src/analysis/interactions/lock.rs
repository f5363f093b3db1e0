//! Locks and keys, resources, and pushable sprites.

use super::encounter::{EffectSummary, Encounter, Precondition, Side};
use super::pairs::Pairs;
use super::touch::{Harm, Removal, Touch};
use crate::analysis::futures::PossibleFutures;
use crate::analysis::types::facts::{Avatar, Facts, Motion, Steering};
use crate::rules::{Rules, SpriteType};

/// The requirement for opening a lock.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Key {
    /// An amount of a resource.
    Resource {
        /// The resource.
        resource: SpriteType,
        /// The amount that must be held at once.
        amount: i32,
        /// `true` if opening consumes the resource.
        spent: bool,
    },
    /// The avatar must be of this type.
    Avatar(SpriteType),
    /// The avatar must have touched a sprite of the first type, or, if there is a second type, have pushed a
    /// sprite of the second type onto a sprite of the first type.
    Switch(SpriteType, Option<SpriteType>),
}

/// A type that the avatar cannot pass or remove at first, but can later.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lock {
    /// The locked type.
    pub stype: SpriteType,
    /// The requirement for opening the lock.
    pub key: Key,
    /// `true` if the lock blocks or harms the avatar until it is opened, and can therefore guard the cells
    /// behind it.
    pub guards: bool,
    /// `true` if opening removes the sprite, and `false` if the avatar then passes through it.
    pub vanishes: bool,
    /// The types that give the key on contact, each with the given amount.
    pub givers: Vec<(SpriteType, i32)>,
}

/// A resource that avatars can hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resource {
    /// The resource's type.
    pub stype: SpriteType,
    /// The maximum amount that an avatar can hold.
    pub limit: i32,
    /// The types that give the resource on contact, each with the given amount.
    pub givers: Vec<(SpriteType, i32)>,
    /// The types that consume the resource on contact, each with the maximum amount that one of its sprites
    /// takes.
    pub takers: Vec<(SpriteType, i32)>,
    /// The maximum amount that any interaction requires at once, or 0 if no interaction requires the
    /// resource.
    pub needed: i32,
    /// `true` if some sprite can ever hold the needed amount.
    pub obtainable: bool,
    /// `true` if shots cost this resource.
    pub is_ammunition: bool,
}

/// The effect on a sprite that is pushed onto a partner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// The pushed sprite stays on the cell, unchanged.
    Stays,
    /// The pushed sprite turns into this type.
    Becomes(SpriteType),
    /// The pushed sprite is removed.
    Goes,
}

/// A collision between a pushed sprite and a partner. The collision removes or changes either sprite, or all
/// sprites of some other type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sink {
    /// The partner: a sprite on the cell, or another pushable sprite.
    pub partner: SpriteType,
    /// The effect on the pushed sprite.
    pub fate: Fate,
    /// `true` if the partner is removed or changes.
    pub fills: bool,
    /// The types whose sprites are all removed or changed by the collision.
    pub opens: Vec<SpriteType>,
}

/// A type whose sprites avatars can push.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pushable {
    /// The pushable type.
    pub stype: SpriteType,
    /// The types onto which a sprite of this type cannot be pushed.
    pub blocked_by: Vec<SpriteType>,
    /// The collisions with partner types that remove or change either sprite, or all sprites of some other
    /// type.
    pub sinks: Vec<Sink>,
}

/// The touch results: one row per avatar type, with one entry per type.
pub(crate) type Touches = Vec<Vec<Touch>>;

pub(crate) fn pushables(
    pairs: &Pairs<'_>,
    facts: &[Facts],
    avatars: &[Avatar],
    touches: &Touches,
) -> Vec<Pushable> {
    let types = || (0u16..).map(SpriteType).zip(facts).filter(|(_, fact)| fact.possible);
    let is_avatar = |stype: SpriteType| avatars.iter().any(|avatar| avatar.stype == stype);
    let pushed = |stype: SpriteType| touches.iter().any(|row| row[stype.index()].pushes);
    let mut list = Vec::new();
    for (stype, _) in types().filter(|&(stype, _)| pushed(stype)) {
        let mut pushable = Pushable { stype, blocked_by: Vec::new(), sinks: Vec::new() };
        let mut meetings = meetings(pairs, facts.len(), stype);
        for (partner, _) in types().filter(|&(partner, _)| !is_avatar(partner)) {
            match std::mem::replace(&mut meetings[partner.index()], Meeting::Blocked) {
                Meeting::Blocked => pushable.blocked_by.push(partner),
                Meeting::Free(sink) if sink.is_idle() => {}
                Meeting::Free(sink) => pushable.sinks.push(sink),
            }
        }
        list.push(pushable);
    }
    list
}

/// The result of pushing a sprite onto a partner.
enum Meeting {
    Blocked,
    Free(Sink),
}

impl Sink {
    fn is_idle(&self) -> bool {
        self.fate == Fate::Stays && !self.fills && self.opens.is_empty()
    }
}

/// Returns the result of pushing a sprite of `stype` onto a sprite of each type.
fn meetings(pairs: &Pairs<'_>, types: usize, stype: SpriteType) -> Vec<Meeting> {
    let sink = |partner: u16| Sink {
        partner: SpriteType(partner),
        fate: Fate::Stays,
        fills: false,
        opens: Vec::new(),
    };
    let mut meetings: Vec<Meeting> = (0..types).map(|partner| Meeting::Free(sink(partner as u16))).collect();
    pairs.with(stype, |partner, own, encounter| {
        let meeting = &mut meetings[partner.index()];
        let Meeting::Free(sink) = meeting else { return };
        // A row of pushed sprites moves together, but levels should not rely on this subtlety.
        let stops = |effect: &EffectSummary| effect.puts_back(own, stype) || *effect == EffectSummary::Push;
        if encounter.does(stops) {
            *meeting = Meeting::Blocked;
            return;
        }
        sink.fills |= encounter.ends(own.other());
        let becomes = encounter.effects.iter().rev().find_map(|effect| {
            let EffectSummary::Become(to) = *effect else { return None };
            (own == Side::First).then_some(to)
        });
        match becomes {
            Some(to) => sink.fate = Fate::Becomes(to),
            None if encounter.ends(own) && sink.fate == Fate::Stays => sink.fate = Fate::Goes,
            None => {}
        }
        for effect in &encounter.effects {
            if let EffectSummary::KillAll(other) | EffectSummary::BecomeAll(other, _) = effect {
                sink.opens.push(*other);
            }
        }
    });
    meetings
}

pub(crate) fn resources(
    rules: &Rules,
    encounters: &[Encounter],
    facts: &[Facts],
    avatars: &[Avatar],
    touches: &Touches,
    givers: &Givers,
    futures: &PossibleFutures<'_>,
) -> Vec<Resource> {
    let types = (0u16..).map(SpriteType).zip(facts);
    let mut takers = changes(facts, touches, |by| by.saturating_neg());
    let resources = types.filter(|(_, fact)| fact.is_resource).map(|(stype, _)| {
        let asks = encounters.iter().map(|encounter| match encounter.precondition {
            Precondition::Holds(_, resource, amount) if resource == stype => amount,
            Precondition::HoldsAtMost(_, resource, amount) if resource == stype => amount.saturating_add(1),
            _ => 0,
        });
        let needed = asks.max().unwrap_or(0);
        Resource {
            stype,
            limit: rules.types[stype.index()].resource_limit,
            givers: givers[stype.index()].clone(),
            takers: std::mem::take(&mut takers[stype.index()]),
            needed,
            obtainable: futures.can_hold(stype, needed),
            is_ammunition: avatars.iter().any(|avatar| avatar.ammo.contains(&stype)),
        }
    });
    resources
        .filter(|resource| resource.needed > 0 || resource.is_ammunition || !resource.givers.is_empty())
        .collect()
}

/// For each resource, the types that give it on touch, with the maximum amount per touch.
pub(crate) type Givers = Vec<Vec<(SpriteType, i32)>>;

pub(crate) fn givers(facts: &[Facts], touches: &Touches) -> Givers {
    changes(facts, touches, |by| by)
}

/// Returns, for each resource, the types that change its amount on contact. `share` maps each change to a
/// number. Each type is paired with its highest number, and types without a positive number are omitted.
fn changes(facts: &[Facts], touches: &Touches, share: impl Fn(i32) -> i32) -> Givers {
    let mut givers: Givers = vec![Vec::new(); facts.len()];
    for (stype, _) in (0u16..).map(SpriteType).zip(facts).filter(|(_, fact)| fact.possible) {
        for &(resource, by) in touches.iter().flat_map(|row| &row[stype.index()].gives) {
            let amount = share(by);
            let list = &mut givers[resource.index()];
            match list.last_mut() {
                Some((giver, most)) if *giver == stype => *most = amount.max(*most),
                _ if amount > 0 => list.push((stype, amount)),
                _ => {}
            }
        }
    }
    givers
}

/// Returns the types that turn some avatar into `avatar` on contact, each with an amount of 1.
fn turners(facts: &[Facts], touches: &Touches, avatar: SpriteType) -> Vec<(SpriteType, i32)> {
    let turns = |stype: SpriteType| touches.iter().any(|row| row[stype.index()].becomes == Some(avatar));
    let types = (0u16..).map(SpriteType).zip(facts).filter(|(_, fact)| fact.possible);
    types.filter(|&(stype, _)| turns(stype)).map(|(stype, _)| (stype, 1)).collect()
}

/// Returns all types that start locked. Cost: O(types × types × avatars).
pub(crate) fn locks(
    facts: &[Facts],
    avatars: &[Avatar],
    touches: &Touches,
    pushables: &[Pushable],
    givers: &Givers,
) -> Vec<Lock> {
    let mut locks = Vec::new();
    let Some(start) = avatars.iter().position(|avatar| avatar.starts) else { return locks };
    let switches = switches(facts.len(), touches, pushables);
    for (stype, fact) in (0u16..).map(SpriteType).zip(facts) {
        let still = fact.motion == Motion::Still;
        if !fact.possible || avatars.iter().any(|avatar| avatar.stype == stype) {
            continue;
        }
        let first = &touches[start][stype.index()];
        let guards = first.blocks || first.harm != Harm::None;
        if let Removal::IfHolds(resource, amount) = first.removal {
            let spends = |&(given, by): &(SpriteType, i32)| given == resource && by < 0;
            let spent = first.gives.iter().any(spends);
            let key = Key::Resource { resource, amount, spent };
            let givers = givers[resource.index()].clone();
            locks.push(Lock { stype, key, guards, vanishes: true, givers });
        } else if let (Some((resource, amount)), true, false) = (first.safe_with, still, first.blocks) {
            let key = Key::Resource { resource, amount, spent: false };
            let givers = givers[resource.index()].clone();
            locks.push(Lock { stype, key, guards: true, vanishes: false, givers });
        } else if still {
            let later = avatars.iter().zip(touches).skip(1).find_map(|(avatar, row)| {
                let then = &row[stype.index()];
                // An avatar that keeps moving on its own, or that is transformed on contact, does not count
                // as having passed.
                let settled = avatar.steering != Steering::Unsteered && then.becomes.is_none();
                let opens = then.ends_other() && !first.ends_other() && then.harm == Harm::None;
                let passes = guards && then.lets_pass() && !first.ends_other();
                (settled && (opens || passes)).then_some((avatar.stype, opens))
            });
            let lock = later
                .map(|(avatar, vanishes)| (Key::Avatar(avatar), vanishes, turners(facts, touches, avatar)));
            let lock = lock.filter(|(_, _, givers)| !givers.is_empty());
            let switched =
                || switches[stype.index()].map(|(by, pushed)| (Key::Switch(by, pushed), true, vec![(by, 1)]));
            if let Some((key, vanishes, givers)) = lock.or_else(|| guards.then(switched).flatten()) {
                locks.push(Lock { stype, key, guards, vanishes, givers });
            }
        }
    }
    locks
}

/// Returns, for each type, the switch that removes all its sprites. A switch is either touched by the avatar
/// or filled with a pushed sprite. Switches that are filled take precedence.
fn switches(
    types: usize,
    touches: &Touches,
    pushables: &[Pushable],
) -> Vec<Option<(SpriteType, Option<SpriteType>)>> {
    let mut switches = vec![None; types];
    for pushable in pushables {
        for sink in &pushable.sinks {
            for opened in &sink.opens {
                switches[opened.index()].get_or_insert((sink.partner, Some(pushable.stype)));
            }
        }
    }
    for row in touches {
        for (at, touch) in (0u16..).zip(row) {
            for opened in &touch.opens {
                switches[opened.index()].get_or_insert((SpriteType(at), None));
            }
        }
    }
    switches
}
