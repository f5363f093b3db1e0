//! The results of an avatar touching a sprite. They combine all interactions between the two types, in either
//! order.

use super::encounter::{EffectSummary, Encounter, Precondition, Side};
use super::pairs::Pairs;
use crate::analysis::goals::goal::Aims;
use crate::rules::{Rules, SpriteType};

/// The harm that contact does to the avatar, from least to most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Harm {
    /// Contact does not hurt.
    #[default]
    None,
    /// Contact sometimes kills, depending on how the two sprites move, on the avatar's resources, or on other
    /// sprites.
    Conditional,
    /// Contact costs fewer health points than the avatar starts with.
    Wounds,
    /// Contact kills.
    Kills,
}

/// The conditions under which contact removes the other sprite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Removal {
    /// Contact never removes the sprite.
    #[default]
    Never,
    /// Contact removes the sprite if the avatar holds this amount of the resource.
    IfHolds(SpriteType, i32),
    /// Contact removes the sprite under other conditions.
    Sometimes,
    /// Contact always removes the sprite.
    Always,
}

/// The result when an avatar of one type touches a sprite of another type.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Touch {
    /// The harm to the avatar.
    pub harm: Harm,
    /// The resource, with the required amount, that protects the avatar from harm; `None` if no resource does.
    pub safe_with: Option<(SpriteType, i32)>,
    /// `true` if the avatar cannot enter the sprite's cell.
    pub blocks: bool,
    /// `true` if the avatar pushes the sprite.
    pub pushes: bool,
    /// `true` if the avatar is carried along or moved to a different position.
    pub carries: bool,
    /// The conditions under which the sprite is removed.
    pub removal: Removal,
    /// The type that the avatar turns into; `None` if the avatar keeps its type.
    pub becomes: Option<SpriteType>,
    /// The type that the sprite turns into; `None` if the sprite keeps its type.
    pub changes: Option<SpriteType>,
    /// The resources that the avatar gains or loses, with their amounts.
    pub gives: Vec<(SpriteType, i32)>,
    /// `true` if the avatar reappears at the exit to which the sprite leads.
    pub teleports: bool,
    /// The types that a touch removes or changes as a whole: every sprite of the type, anywhere on the board.
    pub opens: Vec<SpriteType>,
    /// The types of the sprites that appear. The type that the avatar turns into is included only if a win
    /// requires it.
    pub makes: Vec<SpriteType>,
    /// The sum of the score changes.
    pub score: i32,
    /// `true` if any interaction involves the two types.
    pub any: bool,
}

impl Touch {
    /// Returns `true` if the sprite is removed or changed, at least sometimes.
    pub fn ends_other(&self) -> bool {
        self.removal != Removal::Never || self.changes.is_some()
    }

    /// Returns `true` if contact neither harms nor stops the avatar.
    pub fn lets_pass(&self) -> bool {
        !self.blocks && self.harm == Harm::None
    }
}

/// Returns the results of an avatar type touching each type. Cost: O(interactions of the avatar × relatives).
pub(crate) fn touches(rules: &Rules, pairs: &Pairs<'_>, aims: &Aims, avatar: SpriteType) -> Vec<Touch> {
    let mut row = vec![Touch::default(); rules.types.len()];
    pairs.with(avatar, |other, side, encounter| {
        add(rules, aims, avatar, other, encounter, side, &mut row[other.index()]);
    });
    // Another sprite at the same position can shield the avatar from a type's effects.
    for from in pairs.shields(avatar) {
        for other in &rules.types[from.index()].tree {
            let touch = &mut row[other.index()];
            touch.harm = if touch.harm == Harm::None { Harm::None } else { Harm::Conditional };
        }
    }
    row
}

/// Adds the effects of an interaction in which the avatar is on the side `own`.
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
    let removal = match encounter.precondition {
        Precondition::Always => Removal::Always,
        Precondition::Holds(side, resource, amount) if side == own => {
            certain = amount <= 0;
            if certain { Removal::Always } else { Removal::IfHolds(resource, amount) }
        }
        Precondition::HoldsAtMost(side, resource, amount) if side == own => {
            certain = false;
            safe_with = Some((resource, amount.saturating_add(1)));
            Removal::Sometimes
        }
        Precondition::Chance(_) => Removal::Sometimes,
        Precondition::Holds(..) | Precondition::HoldsAtMost(..) | Precondition::Movement => {
            certain = false;
            Removal::Sometimes
        }
    };
    let mut hurt = |touch: &mut Touch, harm: Harm| {
        touch.harm = touch.harm.max(if certain { harm } else { Harm::Conditional });
        touch.safe_with = touch.safe_with.or(safe_with.take());
    };
    for effect in &encounter.effects {
        match effect {
            EffectSummary::Kill(side) if *side == own => hurt(touch, Harm::Kills),
            EffectSummary::Kill(_) => touch.removal = stronger(touch.removal, removal),
            EffectSummary::Become(to) if own == Side::First => {
                if is_avatar(*to) {
                    touch.becomes = Some(*to);
                } else if aims.create.binary_search(to).is_ok() {
                    touch.makes.push(*to);
                } else {
                    hurt(touch, Harm::Kills);
                }
            }
            EffectSummary::Become(to) => touch.changes = Some(*to),
            EffectSummary::BecomeAny(options) if own == Side::First => {
                touch.becomes = options.iter().copied().find(|&to| is_avatar(to));
                if options.iter().any(|&to| !is_avatar(to)) {
                    touch.harm = touch.harm.max(Harm::Conditional);
                }
            }
            EffectSummary::BecomeAny(options) => touch.changes = options.first().copied(),
            EffectSummary::KillAll(stype) if is_avatar(*stype) => hurt(touch, Harm::Kills),
            EffectSummary::BecomeAll(stype, to) if is_avatar(*stype) && !is_avatar(*to) => {
                hurt(touch, Harm::Kills)
            }
            EffectSummary::KillAll(stype) | EffectSummary::BecomeAll(stype, _) => touch.opens.push(*stype),
            EffectSummary::Stop => touch.blocks |= own == Side::First,
            EffectSummary::Undo(spare) => touch.blocks |= !spare.contains(&avatar),
            EffectSummary::Push => touch.pushes |= own == Side::Second,
            EffectSummary::Carry => touch.carries |= own == Side::First,
            EffectSummary::Teleport => touch.teleports |= own == Side::First,
            EffectSummary::Make(stype) => touch.makes.push(*stype),
            EffectSummary::Collect if own == Side::Second => {
                let traits = &rules.types[other.index()].traits;
                if traits.is_resource {
                    touch.gives.push((other, traits.value));
                }
            }
            EffectSummary::Change { side, resource, by } if *side == own => {
                touch.gives.push((*resource, *by))
            }
            EffectSummary::Health { of, by, dies_at } if *by < 0 => {
                let hits_avatar =
                    of.map_or(own == Side::First, |stype| rules.types[stype.index()].in_tree(avatar));
                if hits_avatar {
                    let left = rules.types[avatar.index()].traits.health.saturating_add(*by);
                    hurt(touch, if left <= *dies_at { Harm::Kills } else { Harm::Wounds });
                } else if of.is_none() {
                    touch.removal = stronger(touch.removal, Removal::Sometimes);
                }
            }
            EffectSummary::Collect
            | EffectSummary::Change { .. }
            | EffectSummary::Health { .. }
            | EffectSummary::Turn
            | EffectSummary::Wrap
            | EffectSummary::Speed(_)
            | EffectSummary::Clone
            | EffectSummary::Shield { .. } => {}
        }
    }
}

/// Returns the stronger of two removals. Unconditional removal outranks removal that costs a resource, which
/// outranks removal that happens only sometimes.
fn stronger(one: Removal, two: Removal) -> Removal {
    let rank = |removal: Removal| match removal {
        Removal::Never => 0,
        Removal::Sometimes => 1,
        Removal::IfHolds(..) => 2,
        Removal::Always => 3,
    };
    if rank(two) > rank(one) { two } else { one }
}
