//! Changes that affect all sprites of a type at once, and the earlier states of types.

use super::glyph::is_avatar;
use super::remarks;
use engine::analysis::{EffectSummary, Encounter, Role};
use engine::{Analysis, SpriteType};

/// Returns the types whose contact with any sprite removes or changes all sprites of `stype`. Avatars are
/// excluded, because an avatar brings about the contact itself. Types that turn into `stype` and back by
/// themselves are excluded, too.
pub(super) fn openers(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let is_place = |written: SpriteType| analysis.role(written) == Role::Floor;
    let thing = |encounter: &Encounter| match is_avatar(analysis, encounter.first) {
        true => encounter.second,
        false if is_place(encounter.first) => encounter.second.filter(|second| !is_avatar(analysis, *second)),
        false => Some(encounter.first),
    };
    let can_be = |written: SpriteType| {
        let mut types = analysis.game().sprite_types().filter(|stype| analysis.applies(written, *stype));
        types.any(|stype| analysis.facts(stype).possible)
    };
    let is_possible =
        |encounter: &&Encounter| can_be(encounter.first) && encounter.second.is_some_and(can_be);
    let changing = analysis.encounters().iter().filter(|encounter| changes_all(encounter, stype));
    let things = changing.filter(is_possible).filter_map(thing);
    things.filter(|&opener| opener != stype && !alternates(analysis, opener, stype)).collect()
}

/// Returns `true` if an encounter removes or changes all sprites of a type.
pub(super) fn changes_all(encounter: &Encounter, stype: SpriteType) -> bool {
    encounter.does(|effect| match effect {
        EffectSummary::KillAll(of) | EffectSummary::BecomeAll(of, _) => *of == stype,
        _ => false,
    })
}

/// Returns `opened` if every change to all sprites of a type lets the avatar pass, and `changed` otherwise.
pub(super) fn opening_verb(analysis: &Analysis, stype: SpriteType) -> &'static str {
    let bars = |effect: &EffectSummary| match effect {
        EffectSummary::BecomeAll(from, to) => *from == stype && !remarks::is_passable(analysis, *to),
        _ => false,
    };
    let bars = analysis.encounters().iter().any(|encounter| encounter.does(bars));
    if bars { "changed" } else { "opened" }
}

/// Returns `true` if a rule triggered by the passing of time involves the type or one of its groups.
pub(super) fn is_timed(analysis: &Analysis, stype: SpriteType) -> bool {
    let game = analysis.game();
    let concerns = |text: &str| {
        let mut names = text.split(',').filter_map(|name| game.sprite_type(name.trim()));
        names.any(|named| analysis.applies(named, stype))
    };
    let is_clock = |name: &str| name == "TIME";
    game.description().interactions.iter().any(|line| {
        let timed = is_clock(&line.first.text)
            || line.second.iter().any(|second| is_clock(&second.text))
            || line.effect.text == "addTimer";
        let named = concerns(&line.first.text) && line.effect.text != "addTimer";
        let params = line.params.iter().any(|param| concerns(&param.value.text));
        timed && (named || params)
    })
}

/// Returns `true` if a switch turns into the type that it opens, like a portal that is closed for some ticks.
pub(super) fn alternates(analysis: &Analysis, switch: SpriteType, stype: SpriteType) -> bool {
    analysis.turns(switch).iter().any(|(becomes, _)| *becomes == stype)
}

/// Returns `true` if some encounter turns all sprites of a type into a different type at once.
pub(super) fn changes_as_a_whole(analysis: &Analysis, stype: SpriteType) -> bool {
    let changes =
        |effect: &EffectSummary| matches!(effect, EffectSummary::BecomeAll(from, _) if *from == stype);
    analysis.encounters().iter().any(|encounter| encounter.does(changes))
}

/// Returns the type that turns into `stype`. Returns `None` if levels also place `stype` directly.
pub(super) fn earlier(analysis: &Analysis, stype: SpriteType) -> Option<SpriteType> {
    let possible = |from: SpriteType| analysis.facts(from).possible && !is_avatar(analysis, from);
    let change = |encounter: &Encounter| {
        encounter.effects.iter().find_map(|effect| match effect {
            EffectSummary::Become(to) if *to == stype => Some(encounter.first),
            EffectSummary::BecomeAll(from, to) if *to == stype => Some(*from),
            _ => None,
        })
    };
    let is_placed = !analysis.facts(stype).symbols.is_empty();
    analysis.encounters().iter().filter_map(change).find(|&from| possible(from) && !is_placed)
}

/// Returns the types from [`openers`] that are not ground.
pub(super) fn opening_things(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    openers(analysis, stype).into_iter().filter(|&opener| analysis.role(opener) != Role::Floor).collect()
}
