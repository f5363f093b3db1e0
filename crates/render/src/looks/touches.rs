//! The effects of the avatar touching a sprite: the things that the avatar gains, creates, opens and changes.

use super::glyph::changes_speed;
use super::{remarks, wins};
use engine::analysis::{EffectSummary, Precondition, Side};
use engine::{Analysis, SpriteType};

/// Returns the types that a type's sprites open, and the types that use up the type's resource. That resource is the
/// type itself, or one that it gives.
fn uses(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let gives = |givers: &[(SpriteType, i32)]| givers.iter().any(|(giver, _)| *giver == stype);
    let locks = analysis.locks().iter().filter(|lock| gives(&lock.givers)).map(|lock| lock.stype);
    let resources = analysis.resources().iter();
    let resources = resources.filter(|resource| resource.stype == stype || gives(&resource.givers));
    locks.chain(resources.flat_map(|resource| resource.takers.iter().map(|(taker, _)| *taker))).collect()
}

/// Returns the types whose sprites all disappear or change when the avatar touches `stype`.
pub(super) fn opened(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let avatars = analysis.avatars().iter();
    let opened = avatars.flat_map(|avatar| analysis.touch(avatar.stype, stype).opens.iter().copied());
    opened.filter(|opened| analysis.facts(*opened).possible && *opened != stype).collect()
}

/// Returns the types from [`opened`], the types that `stype` opens or pays for, and the type whose speed it
/// changes.
pub(super) fn changed(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let opened = opened(analysis, stype).into_iter();
    opened.chain(uses(analysis, stype)).chain(changes_speed(analysis, stype)).collect()
}

/// Returns the resource that the avatar receives from a type; `None` if it receives none.
pub(super) fn given(analysis: &Analysis, stype: SpriteType) -> Option<&str> {
    let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let resource = touches.find_map(|touch| touch.gives.iter().find(|(_, by)| *by > 0))?.0;
    Some(analysis.game().name(resource))
}

/// Describes what the avatar turns into when it touches a type; `None` if it does not change.
pub(super) fn becomes(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let becomes = touches.find_map(|touch| touch.becomes)?;
    Some(format!("makes you {}", analysis.game().name(becomes)))
}

/// Describes a type whose touch gives the avatar health. Returns `None` for any other type.
pub(super) fn health(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let heals = |effect: &EffectSummary| matches!(effect, EffectSummary::Health { by, .. } if *by > 0);
    let mut avatars = analysis.avatars().iter();
    let is_healed = avatars.any(|avatar| {
        wins::met(analysis, avatar.stype, stype)
            .any(|(encounter, own)| own == Side::First && encounter.does(heals))
    });
    is_healed.then(|| "heals you".to_owned())
}

/// Describes the change in a sprite that the avatar touches: `becomes gap when touched`, or `may become gap
/// when touched` if the change is conditional.
pub(super) fn changes(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let to = touches.find_map(|touch| touch.changes)?;
    let certain = analysis.avatars().iter().all(|avatar| {
        let becomes = |effect: &EffectSummary| *effect == EffectSummary::Become(to);
        let mut met = wins::met(analysis, avatar.stype, stype);
        met.any(|(encounter, own)| {
            own == Side::Second && encounter.does(becomes) && encounter.precondition == Precondition::Always
        })
    });
    let verb = if certain { "becomes" } else { "may become" };
    Some(format!("{verb} {} when touched", analysis.game().name(to)))
}

/// Describes the sprites that appear when the avatar touches a type; `None` if none appear.
pub(super) fn makes(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let made: Vec<SpriteType> = touches.flat_map(|touch| touch.makes.iter().copied()).collect();
    Some(format!("makes {} when touched", remarks::names(analysis, &made)?))
}
