//! Notes for legends: a type's harm, what removes its sprites, and what its sprites are needed for.

use super::glyph::is_avatar;
use engine::analysis::{EffectSummary, Encounter, Harm, Motion, Precondition, Removal, Role, Side};
use engine::{Analysis, SpriteType};

/// The maximum number of names in a note.
const NAMED: usize = 3;

/// The maximum number of win methods in a note.
const WAYS: usize = 2;

/// Returns the names of types in alphabetical order, or `None` for an empty list.
pub(super) fn names(analysis: &Analysis, types: &[SpriteType]) -> Option<String> {
    let mut names: Vec<&str> = types.iter().map(|&stype| analysis.game().name(stype)).collect();
    names.sort_unstable();
    names.dedup();
    names.truncate(NAMED);
    (!names.is_empty()).then(|| names.join(", "))
}

/// Returns the harm to a player who touches a type, including any protection against the harm: `deadly unless
/// you are masked`.
pub(super) fn harm(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let word = match analysis.harm(stype) {
        Harm::None => return None,
        Harm::Kills => "deadly",
        Harm::Wounds => "wounds",
        Harm::Conditional => "deadly at times",
    };
    let touches =
        || analysis.avatars().iter().map(|avatar| (avatar.stype, analysis.touch(avatar.stype, stype)));
    let safe: Vec<SpriteType> =
        touches().filter(|(_, touch)| touch.harm == Harm::None).map(|(stype, _)| stype).collect();
    let with = touches().find_map(|(_, touch)| touch.safe_with);
    let hurt = touches().filter(|(_, touch)| touch.harm != Harm::None).count();
    Some(match (names(analysis, &safe), with) {
        (Some(safe), _) if word != "wounds" && hurt > 0 => format!("deadly unless you are {safe}"),
        (_, Some((resource, _))) => format!("deadly without {}", analysis.game().name(resource)),
        _ => word.to_owned(),
    })
}

/// Returns the types that remove or change sprites of `stype` on contact, except avatars.
pub(super) fn removers(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let partner = |encounter: &Encounter| {
        let second = encounter.second?;
        if analysis.applies(encounter.first, stype) && encounter.ends(Side::First) {
            Some(second)
        } else if analysis.applies(second, stype) && encounter.ends(Side::Second) {
            Some(encounter.first)
        } else {
            None
        }
    };
    let partners = analysis.encounters().iter().filter_map(partner);
    partners
        .filter(|&partner| analysis.facts(partner).possible || !analysis.facts(partner).concrete)
        .filter(|&partner| !is_avatar(analysis, partner))
        .collect()
}

/// Returns the moving or pushed types that are removed by contact with `stype`.
pub(super) fn swallowed(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let falls = |other: &SpriteType| {
        let goes = |side: Side| move |effect: &EffectSummary| *effect == EffectSummary::Kill(side);
        analysis.between(*other, stype).any(|encounter| encounter.does(goes(Side::First)))
            || analysis.between(stype, *other).any(|encounter| encounter.does(goes(Side::Second)))
    };
    let game = analysis.game();
    game.sprite_types().filter(|&other| moves(analysis, other)).filter(falls).collect()
}

/// Returns the types that are removed or changed by contact with `stype`, except avatars.
pub(super) fn spoilt_by(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let spoils = |other: SpriteType| {
        let removers = removers(analysis, other);
        other != stype && removers.into_iter().any(|remover| analysis.applies(remover, stype))
    };
    let things = analysis.game().sprite_types().filter(|&other| analysis.facts(other).possible);
    things.filter(|&other| !is_avatar(analysis, other) && spoils(other)).collect()
}

/// Returns `true` if sprites of the type, which is not an avatar, move by themselves or are pushed.
pub(super) fn moves(analysis: &Analysis, stype: SpriteType) -> bool {
    let facts = analysis.facts(stype);
    facts.possible
        && !is_avatar(analysis, stype)
        && analysis.role(stype) != Role::Shot
        && (facts.motion != Motion::Still || analysis.role(stype) == Role::Pushable)
}

/// Returns `true` if a collision of the two types loses the game, or leaves a type that must also disappear
/// for a win.
fn is_in_vain(analysis: &Analysis, stype: SpriteType, partner: SpriteType) -> bool {
    let aims = analysis.aims();
    let bad = |effect: &EffectSummary| match effect {
        EffectSummary::Become(to) => aims.prevent.contains(to) || aims.remove.contains(to),
        EffectSummary::Make(to) => aims.prevent.contains(to),
        _ => false,
    };
    let both = analysis.between(stype, partner).chain(analysis.between(partner, stype));
    both.into_iter().any(|encounter| encounter.does(bad))
}

/// Returns a description of how the player can remove a type that must disappear for the win: `catch it to
/// win`, `lead it to nest to win`.
pub(super) fn win_by_removing(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let moving = analysis.facts(stype).motion != Motion::Still;
    let aims = analysis.aims();
    let goes = |to: SpriteType| !aims.remove.contains(&to) && !aims.prevent.contains(&to);
    let removes = |avatar: &SpriteType| {
        let touch = analysis.touch(*avatar, stype);
        touch.removal != Removal::Never || touch.changes.is_some_and(goes)
    };
    let avatars: Vec<SpriteType> = analysis.avatars().iter().map(|avatar| avatar.stype).collect();
    let able: Vec<SpriteType> = avatars.iter().copied().filter(removes).collect();
    let catch = if moving { "catch it" } else { "take it" };
    let catch = match names(analysis, &able) {
        Some(names) if able.len() < avatars.len() => Some(format!("{catch} as {names}")),
        Some(_) => Some(catch.to_owned()),
        None => None,
    };
    let mut partners = removers(analysis, stype);
    partners.retain(|&partner| !is_in_vain(analysis, stype, partner));
    let (shots, others): (Vec<_>, Vec<_>) =
        partners.into_iter().partition(|&partner| analysis.role(partner) == Role::Shot);
    let (movers, rest): (Vec<_>, Vec<_>) = others.into_iter().partition(|&partner| moves(analysis, partner));
    let told = |types: &[SpriteType], before: &str, after: &str| {
        Some(format!("{before}{}{after}", names(analysis, types)?))
    };
    let hit = told(&shots, "hit it with ", "");
    let (led, left) = match moving {
        true => (told(&rest, "lead it to ", ""), told(&movers, "let ", " catch it")),
        false if movers.is_empty() => (None, told(&rest, "let ", " reach it")),
        false => (told(&movers, "bring ", " here"), None),
    };
    let ways: Vec<String> = [catch, hit, led, left].into_iter().flatten().take(WAYS).collect();
    (!ways.is_empty()).then(|| format!("{} to win", ways.join(" or ")))
}

/// Returns the partners of encounters that require a resource.
pub(super) fn requirers(analysis: &Analysis, resource: SpriteType) -> Vec<SpriteType> {
    let partner = |encounter: &Encounter| match encounter.precondition {
        Precondition::Holds(side, needed, amount) if needed == resource && amount > 0 => match side {
            Side::First => encounter.second,
            Side::Second => Some(encounter.first),
        },
        _ => None,
    };
    let partners = analysis.encounters().iter().filter_map(partner);
    partners.filter(|&partner| !is_avatar(analysis, partner)).collect()
}

/// Returns the shots that cost a resource.
pub(super) fn ammunition_for(analysis: &Analysis, resource: SpriteType) -> Vec<SpriteType> {
    let shots = analysis.avatars().iter().flat_map(|avatar| avatar.ammo.iter().zip(&avatar.shots));
    shots.filter(|(ammo, _)| **ammo == resource).map(|(_, shot)| *shot).collect()
}

/// Returns the motionless types that a pushed sprite changes, fills or opens, or that remove the pushed
/// sprite.
pub(super) fn destinations(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let pushables = analysis.pushables().iter().filter(|pushable| pushable.stype == stype);
    let partners = pushables.flat_map(|pushable| &pushable.sinks).map(|sink| sink.partner);
    let stays = |partner: &SpriteType| {
        let facts = analysis.facts(*partner);
        facts.motion == Motion::Still && !facts.fleeting
    };
    partners.filter(stays).collect()
}

/// Returns a description of where to push sprites that change or fill a type, and whether a win requires the
/// push.
pub(super) fn socket(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let sunk =
        |pushable: &&engine::analysis::Pushable| pushable.sinks.iter().any(|sink| sink.partner == stype);
    let pushed: Vec<SpriteType> =
        analysis.pushables().iter().filter(sunk).map(|pushable| pushable.stype).collect();
    let aims = analysis.aims();
    let becomes = |to: &(SpriteType, SpriteType)| aims.create.contains(&to.0);
    let wanted = aims.remove.contains(&stype)
        || pushed.iter().any(|pushed| aims.remove.contains(pushed))
        || analysis.turns(stype).iter().any(becomes)
        || pushed.iter().any(|&pushed| analysis.turns(pushed).iter().any(becomes));
    let verb = if wanted { " to win" } else { "" };
    let pushed = names(analysis, &pushed)?;
    Some(format!("push {pushed} here{verb}"))
}
