//! What happens when an avatar touches a sprite: all interactions of the two types, either way round, put together.

use super::encounter::{Deed, Encounter, Provided, Side};
use super::goal::Aims;
use super::pairs::Pairs;
use crate::game::{Rules, SpriteType};

/// How badly contact ends for the avatar, from best to worst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Harm {
    /// It does not hurt.
    #[default]
    None,
    /// It kills sometimes: depending on how the two move, on what the avatar holds, or on what else is there.
    Conditional,
    /// It costs health points, fewer than the avatar starts with.
    Wounds,
    /// It kills.
    Kills,
}

/// Whether contact makes the other sprite go away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Removal {
    /// No.
    #[default]
    Never,
    /// If the avatar holds so many of this resource.
    IfHolds(SpriteType, i32),
    /// Depending on other things.
    Sometimes,
    /// Yes.
    Always,
}

/// What happens when an avatar of one type touches a sprite of another.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Touch {
    /// What it means for the avatar.
    pub harm: Harm,
    /// Holding so many of this resource keeps the avatar from harm.
    pub safe_with: Option<(SpriteType, i32)>,
    /// The avatar cannot enter.
    pub blocks: bool,
    /// The avatar pushes the sprite along.
    pub pushes: bool,
    /// The avatar is carried along or put somewhere else.
    pub carries: bool,
    /// Whether the sprite goes away.
    pub removal: Removal,
    /// What the avatar turns into.
    pub becomes: Option<SpriteType>,
    /// What the sprite turns into.
    pub changes: Option<SpriteType>,
    /// Resources that the avatar gains, or loses, with the amount.
    pub gives: Vec<(SpriteType, i32)>,
    /// The avatar appears where the sprite leads to.
    pub teleports: bool,
    /// Types whose sprites all go away or change, wherever they are.
    pub opens: Vec<SpriteType>,
    /// Types of which a sprite appears; among them what the avatar turns into for a win.
    pub makes: Vec<SpriteType>,
    /// The sum of the score changes.
    pub score: i32,
    /// Whether there is any interaction at all.
    pub any: bool,
}

impl Touch {
    /// Whether the sprite goes away or changes, at least sometimes.
    pub fn ends_other(&self) -> bool {
        self.removal != Removal::Never || self.changes.is_some()
    }

    /// Whether contact neither hurts nor stops the avatar.
    pub fn lets_pass(&self) -> bool {
        !self.blocks && self.harm == Harm::None
    }
}

/// What happens between an avatar type and each type, by type. Cost: O(interactions of the avatar × relatives).
pub(super) fn touches(rules: &Rules, pairs: &Pairs<'_>, aims: &Aims, avatar: SpriteType) -> Vec<Touch> {
    let mut row = vec![Touch::default(); rules.types.len()];
    pairs.with(avatar, |other, side, encounter| {
        add(rules, aims, avatar, other, encounter, side, &mut row[other.index()]);
    });
    // Something else at the same place can keep the avatar from what a type does to it.
    for from in pairs.shields(avatar) {
        for other in &rules.types[from.index()].tree {
            let touch = &mut row[other.index()];
            touch.harm = if touch.harm == Harm::None { Harm::None } else { Harm::Conditional };
        }
    }
    row
}

/// Adds what an interaction does in which the avatar is on the side `own`.
fn add(
    rules: &Rules,
    aims: &Aims,
    avatar: SpriteType,
    other: SpriteType,
    encounter: &Encounter,
    own: Side,
    touch: &mut Touch,
) {
    let is_avatar = |stype: SpriteType| rules.types[stype.index()].class.is_some_and(|c| c.is_avatar());
    touch.any = true;
    touch.score = touch.score.saturating_add(encounter.score);
    let (mut certain, mut safe_with) = (true, None);
    let removal = match encounter.provided {
        Provided::Always => Removal::Always,
        Provided::Holds(side, resource, amount) if side == own => {
            certain = amount <= 0;
            if certain { Removal::Always } else { Removal::IfHolds(resource, amount) }
        }
        Provided::HoldsAtMost(side, resource, amount) if side == own => {
            certain = false;
            safe_with = Some((resource, amount.saturating_add(1)));
            Removal::Sometimes
        }
        Provided::Chance(_) => Removal::Sometimes,
        Provided::Holds(..) | Provided::HoldsAtMost(..) | Provided::Way => {
            certain = false;
            Removal::Sometimes
        }
    };
    let mut hurt = |touch: &mut Touch, harm: Harm| {
        touch.harm = touch.harm.max(if certain { harm } else { Harm::Conditional });
        touch.safe_with = touch.safe_with.or(safe_with.take());
    };
    for deed in &encounter.deeds {
        match deed {
            Deed::Kill(side) if *side == own => hurt(touch, Harm::Kills),
            Deed::Kill(_) => touch.removal = stronger(touch.removal, removal),
            Deed::Become(to) if own == Side::First => {
                if is_avatar(*to) {
                    touch.becomes = Some(*to);
                } else if aims.create.binary_search(to).is_ok() {
                    touch.makes.push(*to);
                } else {
                    hurt(touch, Harm::Kills);
                }
            }
            Deed::Become(to) => touch.changes = Some(*to),
            Deed::BecomeAny(options) if own == Side::First => {
                touch.becomes = options.iter().copied().find(|&to| is_avatar(to));
                if options.iter().any(|&to| !is_avatar(to)) {
                    touch.harm = touch.harm.max(Harm::Conditional);
                }
            }
            Deed::BecomeAny(options) => touch.changes = options.first().copied(),
            Deed::KillAll(stype) if is_avatar(*stype) => hurt(touch, Harm::Kills),
            Deed::BecomeAll(stype, to) if is_avatar(*stype) && !is_avatar(*to) => hurt(touch, Harm::Kills),
            Deed::KillAll(stype) | Deed::BecomeAll(stype, _) => touch.opens.push(*stype),
            Deed::Stop => touch.blocks |= own == Side::First,
            Deed::Undo(spare) => touch.blocks |= !spare.contains(&avatar),
            Deed::Push => touch.pushes |= own == Side::Second,
            Deed::Carry => touch.carries |= own == Side::First,
            Deed::Teleport => touch.teleports |= own == Side::First,
            Deed::Make(stype) => touch.makes.push(*stype),
            Deed::Collect if own == Side::Second => {
                let traits = &rules.types[other.index()].traits;
                if traits.is_resource {
                    touch.gives.push((other, traits.value));
                }
            }
            Deed::Change { who, resource, by } if *who == own => touch.gives.push((*resource, *by)),
            Deed::Health { of, by, dies_at } if *by < 0 => {
                let hits_avatar =
                    of.map_or(own == Side::First, |stype| rules.types[stype.index()].in_tree(avatar));
                if hits_avatar {
                    let left = rules.types[avatar.index()].traits.health.saturating_add(*by);
                    hurt(touch, if left <= *dies_at { Harm::Kills } else { Harm::Wounds });
                } else if of.is_none() {
                    touch.removal = stronger(touch.removal, Removal::Sometimes);
                }
            }
            Deed::Collect
            | Deed::Change { .. }
            | Deed::Health { .. }
            | Deed::Turn
            | Deed::Wrap
            | Deed::Speed(_)
            | Deed::Clone
            | Deed::Shield { .. } => {}
        }
    }
}

/// An unconditional removal wins over one with a price, and that over one that merely may happen.
fn stronger(one: Removal, two: Removal) -> Removal {
    let rank = |removal: Removal| match removal {
        Removal::Never => 0,
        Removal::Sometimes => 1,
        Removal::IfHolds(..) => 2,
        Removal::Always => 3,
    };
    if rank(two) > rank(one) { two } else { one }
}
