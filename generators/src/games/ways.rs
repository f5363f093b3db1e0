//! Alternatives for a class, a parameter or an effect, within sensible limits, with the clauses to describe them.

use super::body::Body;
use super::draft::{AVATAR, Claim, Draft, Part, Phase, Rule, Value};
use super::effect::Effect;
use super::role::Role;
use engine::SpriteClass;

/// The alternative classes of strays and pursuers.
const WALKERS: &[SpriteClass] = &[SpriteClass::RandomNPC, SpriteClass::Chaser, SpriteClass::Fleeing];
/// The alternative classes of shots.
const SHOTS: &[SpriteClass] = &[SpriteClass::Missile, SpriteClass::RandomMissile];

/// The other classes that a sprite type may have, if any.
pub(crate) fn siblings(draft: &Draft, part: Part) -> Vec<SpriteClass> {
    let sprite = draft.sprite(part);
    let Some(class) = sprite.class else { return Vec::new() };
    let family = match sprite.body {
        Body::Walker => WALKERS,
        Body::FoeShot => SHOTS,
        _ => &[],
    };
    if !family.contains(&class) {
        return Vec::new();
    }
    family.iter().copied().filter(|&other| other != class).collect()
}

/// Returns `true` if a class needs a target to chase or to flee from.
pub(crate) fn has_target(class: SpriteClass) -> bool {
    class.is_a(SpriteClass::Chaser)
}

/// Gives a sprite type another class, with the parameters of that class; returns `None` if it does not fit.
pub(crate) fn set_class(
    draft: &mut Draft,
    part: Part,
    class: SpriteClass,
    after: Option<Part>,
) -> Option<()> {
    if !siblings(draft, part).contains(&class) {
        return None;
    }
    let own = class.parameters();
    let sprite = &mut draft.sprites[part.0];
    sprite.class = Some(class);
    sprite.params.retain(|&(key, _)| match key {
        "stype" | "cons" => false,
        "orientation" => class != SpriteClass::RandomMissile,
        _ => true,
    });
    if own.contains(&"stype") {
        sprite.params.push(("stype", Value::Part(after.unwrap_or(AVATAR))));
    }
    draft.clauses.retain(|clause| clause.claim != Claim::Way(part));
    let after = after.filter(|&other| other != AVATAR);
    let text = match class {
        SpriteClass::Chaser if after.is_none() => "<names> give chase",
        SpriteClass::Chaser => "<names> go after <names>",
        SpriteClass::Fleeing if after.is_none() => "<names> run from you",
        SpriteClass::Fleeing => "<names> run from <names>",
        SpriteClass::RandomMissile => "<names> fly every which way",
        _ => "<names> stray about",
    };
    draft.gene = draft.sprite(part).gene;
    let parts: Vec<Part> = [part].into_iter().chain(after).collect();
    draft.add_motion_clause(part, text, &parts);
    Some(())
}

/// The sensible minimum and maximum of a parameter; `None` if it must not change because a clause mentions it or the
/// pattern depends on it.
pub(crate) fn range(draft: &Draft, part: Part, key: &str) -> Option<(u32, u32)> {
    use SpriteClass as C;
    let sprite = draft.sprite(part);
    let class = sprite.class?;
    match key {
        "cooldown" if class == C::SpawnPoint => Some((3, 40)),
        "cooldown" if class.is_a(C::SpawnPoint) => Some((1, 6)),
        "cooldown" => Some((1, 6)),
        "prob" => Some((10, 100)),
        "cons" => Some((0, 5)),
        "spreadprob" if sprite.role == Role::Creep => Some((12, 23)),
        "limit" if class == C::Flicker => Some((1, 30)),
        "limit" if class == C::OrientedFlicker => Some((1, 4)),
        _ => None,
    }
}

/// The alternative effects of a rule.
pub(crate) fn effects(draft: &Draft, rule: &Rule) -> Vec<Effect> {
    if rule.phase != Phase::Strike || draft.is_counted(rule.first) {
        return Vec::new();
    }
    let foes = [Role::Wanderer, Role::Chaser, Role::Patroller, Role::Rover];
    let others = draft.parts().filter(|&part| {
        let sprite = draft.sprite(part);
        !sprite.removed && foes.contains(&sprite.role) && part != rule.first
    });
    let is_foe = foes.contains(&draft.sprite(rule.first).role);
    match rule.effect {
        Effect::KillSprite | Effect::KillBoth if is_foe => {
            let kill_second = rule.effect == Effect::KillBoth;
            others.map(|stype| Effect::TransformTo { stype, kill_second }).collect()
        }
        _ => Vec::new(),
    }
}
