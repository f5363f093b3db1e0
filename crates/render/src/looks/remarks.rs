//! Notes for legends: the harm that a type does, the means of removing its sprites, and the purposes of its sprites.

use super::glyph::is_avatar;
use super::payments;
use super::wins::{self, Terms, counted, is_in_vain};
use engine::analysis::{EffectSummary, Encounter, Fate, Harm, Motion, Pushable, Role, Side, Sink};
use engine::{Analysis, SpriteType};
use std::collections::BTreeSet;

/// The maximum number of names in a note.
const NAMED: usize = 3;

/// The maximum number of ways to win in a note.
const WAYS: usize = 2;

/// Returns the names of types in alphabetical order, or `None` for an empty list.
pub(super) fn names(analysis: &Analysis, types: &[SpriteType]) -> Option<String> {
    let mut names: Vec<&str> = types.iter().map(|&stype| analysis.game().name(stype)).collect();
    names.sort_unstable();
    names.dedup();
    names.truncate(NAMED);
    (!names.is_empty()).then(|| names.join(", "))
}

/// Returns the condition of the harm if it is the same for all avatars that the type can harm.
fn harm_terms(analysis: &Analysis, stype: SpriteType) -> Option<Terms> {
    let avatars = analysis.avatars().iter().map(|avatar| avatar.stype);
    let hurt = avatars.filter(|avatar| analysis.touch(*avatar, stype).harm != Harm::None);
    let mut found = hurt.map(|avatar| payments::deadly_terms(analysis, avatar, stype));
    let first = found.next()??;
    found.all(|terms| terms.as_ref() == Some(&first)).then_some(first)
}

/// Returns `true` if contact with the type costs health points but is never deadly.
fn only_wounds(analysis: &Analysis, stype: SpriteType) -> bool {
    let costs = |effect: &EffectSummary| matches!(effect, EffectSummary::Health { by, .. } if *by < 0);
    let met = || analysis.avatars().iter().flat_map(|avatar| wins::met(analysis, avatar.stype, stype));
    met().any(|(encounter, _)| encounter.does(costs))
        && !met().any(|(encounter, own)| payments::is_deadly(analysis, encounter, own))
}

/// Describes the harm to a player who touches a type, including any protection against it: `deadly unless you
/// are masked`.
pub(super) fn harm(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let word = match analysis.harm(stype) {
        Harm::None => return None,
        Harm::Kills => "deadly",
        Harm::Wounds => "wounds",
        Harm::Conditional if only_wounds(analysis, stype) => "harms",
        Harm::Conditional => "deadly",
    };
    let terms = harm_terms(analysis, stype).filter(|_| analysis.harm(stype) == Harm::Conditional);
    let word = match terms {
        Some(Terms::HoldsAtMost(resource, most)) => {
            format!("{word} without {}", counted(analysis, resource, most.saturating_add(1)))
        }
        Some(Terms::Holds(resource, amount)) => {
            format!("{word} with {}", counted(analysis, resource, amount))
        }
        _ if analysis.harm(stype) == Harm::Conditional => format!("{word} at times"),
        _ => word.to_owned(),
    };
    let touches =
        || analysis.avatars().iter().map(|avatar| (avatar.stype, analysis.touch(avatar.stype, stype)));
    let safe: Vec<SpriteType> =
        touches().filter(|(_, touch)| touch.harm == Harm::None).map(|(stype, _)| stype).collect();
    Some(match names(analysis, &safe) {
        Some(safe) => format!("{word} unless you are {safe}"),
        None => word,
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
    let written: Vec<SpriteType> = analysis.encounters().iter().filter_map(partner).collect();
    let is_met = |other: &SpriteType| {
        let facts = analysis.facts(*other);
        facts.possible && facts.concrete && written.iter().any(|&written| analysis.applies(written, *other))
    };
    let met = analysis.game().sprite_types().filter(is_met);
    met.filter(|&other| !is_avatar(analysis, other)).collect()
}

/// Returns the types whose sprites appear during play.
fn appearing(analysis: &Analysis) -> BTreeSet<SpriteType> {
    let types = analysis.game().sprite_types();
    let mut found: BTreeSet<SpriteType> =
        types.flat_map(|maker| analysis.facts(maker).makes.iter().copied()).collect();
    for effect in analysis.encounters().iter().flat_map(|encounter| &encounter.effects) {
        match effect {
            EffectSummary::Make(to) | EffectSummary::Become(to) | EffectSummary::BecomeAll(_, to) => {
                found.insert(*to);
            }
            EffectSummary::BecomeAny(options) => found.extend(options.iter()),
            _ => {}
        }
    }
    found
}

/// Returns the types from [`removers`] whose sprites can come into contact with a sprite of `stype`. The sprites of
/// at least one of the two types must move, be pushed or shot, or appear during play.
pub(super) fn reachable_removers(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let appearing = appearing(analysis);
    let comes = |stype: SpriteType| {
        let is_sent = analysis.role(stype) == Role::Shot || appearing.contains(&stype);
        is_sent || moves(analysis, stype)
    };
    let own = comes(stype);
    removers(analysis, stype).into_iter().filter(|&partner| own || comes(partner)).collect()
}

/// Returns `true` if sprites of the type neither stop nor harm an avatar.
pub(super) fn is_passable(analysis: &Analysis, stype: SpriteType) -> bool {
    analysis.avatars().iter().all(|avatar| analysis.touch(avatar.stype, stype).lets_pass())
}

/// Returns the types that clear sprites of `stype` out of the avatar's way on contact. They remove these sprites, or
/// turn them into something that the avatar can pass.
pub(super) fn clearers(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let clears = |encounter: &Encounter, own: Side| {
        encounter.does(|effect| match effect {
            EffectSummary::Kill(side) => *side == own,
            EffectSummary::Health { of: None, by, .. } => *by < 0 && own == Side::First,
            EffectSummary::Become(to) => own == Side::First && is_passable(analysis, *to),
            _ => false,
        })
    };
    let is_clearer = |partner: &SpriteType| {
        let first = analysis.between(stype, *partner).any(|encounter| clears(encounter, Side::First));
        first || analysis.between(*partner, stype).any(|encounter| clears(encounter, Side::Second))
    };
    reachable_removers(analysis, stype).into_iter().filter(is_clearer).collect()
}

/// Returns the moving or pushed types that contact with `stype` removes.
pub(super) fn swallowed(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let falls = |other: &SpriteType| {
        let goes = |side: Side| move |effect: &EffectSummary| *effect == EffectSummary::Kill(side);
        analysis.between(*other, stype).any(|encounter| encounter.does(goes(Side::First)))
            || analysis.between(stype, *other).any(|encounter| encounter.does(goes(Side::Second)))
    };
    let game = analysis.game();
    game.sprite_types().filter(|&other| moves(analysis, other)).filter(falls).collect()
}

/// Returns the types, except avatars, that contact with `stype` removes or changes.
pub(super) fn spoilt_by(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let spoils = |other: SpriteType| {
        let first = analysis.between(other, stype).any(|encounter| encounter.ends(Side::First));
        let is_spoilt = first || analysis.between(stype, other).any(|encounter| encounter.ends(Side::Second));
        other != stype && is_spoilt
    };
    let things = analysis.game().sprite_types().filter(|&other| analysis.facts(other).possible);
    things.filter(|&other| !is_avatar(analysis, other) && spoils(other)).collect()
}

/// Returns `true` if the type is not an avatar, and its sprites move by themselves or are pushed.
pub(super) fn moves(analysis: &Analysis, stype: SpriteType) -> bool {
    let facts = analysis.facts(stype);
    facts.possible
        && !is_avatar(analysis, stype)
        && analysis.role(stype) != Role::Shot
        && (facts.motion != Motion::Still || analysis.role(stype) == Role::Pushable)
}

/// Returns the types that remove or change all sprites of `stype` when the avatar touches them.
fn switches(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let opens = |other: &SpriteType| {
        let mut avatars = analysis.avatars().iter();
        analysis.facts(*other).possible
            && *other != stype
            && avatars.any(|avatar| {
                analysis.touch(avatar.stype, *other).opens.contains(&stype)
                    && !is_in_vain(analysis, *other, avatar.stype)
            })
    };
    let turns = |effect: &EffectSummary| match effect {
        EffectSummary::BecomeAll(from, to) => *from == stype && !wins::goes(analysis, *to),
        _ => false,
    };
    let kept = analysis.encounters().iter().any(|encounter| encounter.does(turns));
    if kept { Vec::new() } else { analysis.game().sprite_types().filter(opens).collect() }
}

/// Describes how the player can remove a type that must disappear for the win: `catch it to win`, `lead it to nest to
/// win`. Returns `None` for any other type, and if no way to remove it is known.
pub(super) fn win_by_removing(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    if !wins::is_to_go(analysis, stype) {
        return None;
    }
    let moving = analysis.facts(stype).motion != Motion::Still;
    let catch = if moving { "catch it" } else { "take it" };
    let catch = wins::able(analysis, stype).and_then(|(able, terms)| {
        let all = able.len() == analysis.avatars().len();
        let only = if all { String::new() } else { format!(" as {}", names(analysis, &able)?) };
        Some(format!("{catch}{only}{}", terms.phrase(analysis)))
    });
    let mut partners = reachable_removers(analysis, stype);
    partners.retain(|&partner| !is_in_vain(analysis, stype, partner));
    if wins::is_to_keep(analysis, stype) {
        partners.clear();
    }
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
    let switched = told(&switches(analysis, stype), "touch ", "");
    let ways: Vec<String> = [catch, hit, led, left, switched].into_iter().flatten().take(WAYS).collect();
    (!ways.is_empty()).then(|| format!("{} to win", ways.join(" or ")))
}

/// Returns the shots that cost a resource.
pub(super) fn ammunition_for(analysis: &Analysis, resource: SpriteType) -> Vec<SpriteType> {
    let shots = analysis.avatars().iter().flat_map(|avatar| avatar.ammo.iter().zip(&avatar.shots));
    shots.filter(|(ammo, _)| **ammo == resource).map(|(_, shot)| *shot).collect()
}

/// Returns the collisions of a type's pushed sprites with motionless sprites that stay.
fn sinks(analysis: &Analysis, stype: SpriteType) -> impl Iterator<Item = &Sink> {
    let stays = |sink: &&Sink| {
        let facts = analysis.facts(sink.partner);
        facts.motion == Motion::Still && !facts.fleeting
    };
    let pushables = analysis.pushables().iter().filter(move |pushable| pushable.stype == stype);
    pushables.flat_map(|pushable| &pushable.sinks).filter(stays)
}

/// Returns `true` if pushing a sprite of `stype` into the sink brings a win closer.
fn wins_by_push(analysis: &Analysis, stype: SpriteType, sink: &Sink) -> bool {
    let comes = |of: SpriteType, by: SpriteType| {
        let mut turns = analysis.turns(of).into_iter();
        turns.any(|(to, partner)| analysis.applies(partner, by) && wins::is_to_come(analysis, to))
    };
    let goes = |of: SpriteType| wins::is_to_go(analysis, of) && !wins::is_to_keep(analysis, of);
    let own = match sink.fate {
        Fate::Stays => false,
        Fate::Goes => goes(stype),
        Fate::Becomes(to) => goes(stype) && wins::goes(analysis, to),
    };
    let helps = own
        || (sink.fills && goes(sink.partner))
        || sink.opens.iter().any(|opened| goes(*opened))
        || comes(stype, sink.partner)
        || comes(sink.partner, stype);
    helps && !is_in_vain(analysis, stype, sink.partner) && !is_in_vain(analysis, sink.partner, stype)
}

/// Returns `true` if the sink only uses up a pushed sprite, or loses the game.
fn is_lost(analysis: &Analysis, stype: SpriteType, sink: &Sink) -> bool {
    let is_prevented = |to: SpriteType| analysis.aims().prevent.contains(&to);
    let is_spoilt = matches!(sink.fate, Fate::Becomes(to) if is_prevented(to));
    let is_gone = sink.fate == Fate::Goes && wins::is_to_keep(analysis, stype);
    let is_useless = sink.fate == Fate::Goes && !sink.fills && sink.opens.is_empty();
    let wins = wins_by_push(analysis, stype, sink);
    !wins && (is_spoilt || is_gone || is_useless || is_in_vain(analysis, sink.partner, stype))
}

/// Describes the motionless types that a pushed sprite changes, fills or opens, or that use up the pushed sprite: `push
/// it onto drain`, `can be pushed, lost at hole`. Returns `None` if there are no such types.
pub(super) fn destinations(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let (lost, good): (Vec<&Sink>, Vec<&Sink>) =
        sinks(analysis, stype).partition(|sink| is_lost(analysis, stype, sink));
    let places = |sinks: &[&Sink]| {
        names(analysis, &sinks.iter().map(|sink| sink.partner).collect::<Vec<SpriteType>>())
    };
    match (places(&good), places(&lost)) {
        (Some(good), _) => Some(format!("push it onto {good}")),
        (None, Some(lost)) => Some(format!("can be pushed, lost at {lost}")),
        (None, None) => None,
    }
}

/// Returns `true` if pushing something onto the type contributes to a win.
pub(super) fn is_socket_of_win(analysis: &Analysis, stype: SpriteType) -> bool {
    !pushed_into(analysis, stype, |of, sink| wins_by_push(analysis, of, sink)).is_empty()
}

/// Returns the types that can be pushed onto `stype`, if `wanted` accepts the collision.
fn pushed_into(
    analysis: &Analysis,
    stype: SpriteType,
    wanted: impl Fn(SpriteType, &Sink) -> bool,
) -> Vec<SpriteType> {
    let sunk = |pushable: &&Pushable| {
        pushable.sinks.iter().any(|sink| sink.partner == stype && wanted(pushable.stype, sink))
    };
    analysis.pushables().iter().filter(sunk).map(|pushable| pushable.stype).collect()
}

/// Describes the sprites to push onto a type, and states whether the push brings a win closer: `push crate here to
/// win`, `swallows crate`. For a type with short-lived sprites, returns `soon gone`. Returns `None` if nothing can be
/// pushed onto the type.
pub(super) fn socket(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    if analysis.facts(stype).fleeting {
        return Some("soon gone".to_owned());
    }
    let wins = pushed_into(analysis, stype, |of, sink| wins_by_push(analysis, of, sink));
    let good = pushed_into(analysis, stype, |of, sink| !is_lost(analysis, of, sink));
    let lost = pushed_into(analysis, stype, |of, sink| is_lost(analysis, of, sink));
    if let Some(wins) = names(analysis, &wins) {
        return Some(format!("push {wins} here to win"));
    }
    let good = names(analysis, &good).map(|good| format!("push {good} here"));
    good.or_else(|| Some(format!("swallows {}", names(analysis, &lost)?)))
}
