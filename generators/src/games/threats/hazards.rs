//! Hazards to avoid, and health that fades over time.

use super::{foe_of, spawning};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, CLOCK, Draft, Harm, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::role::Role;
use engine::{Sampler, SpriteClass};

pub(super) fn trap(draft: &mut Draft, _: &mut Sampler) {
    let trap = draft.place(Role::Trap, SpriteClass::Immovable, Body::Flat, &[]);
    draft.harm(trap, Harm::Lasting);
    draft.add_fact("<names> lie in wait", &[trap]);
}

pub(super) fn slime(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("limit", Value::Count(draw(sampler, 10, 25)))];
    let slime = draft.spawn(Role::Slime, SpriteClass::Flicker, Body::Puff, &params);
    let params = spawning(slime, draw(sampler, 3, 4), draw(sampler, 3, 8));
    let slug = draft.place(Role::Slug, SpriteClass::RandomBomber, Body::Walker, &params);
    draft.harm(slime, Harm::Lasting);
    foe_of(draft, slug, 2);
    draft.add_fact("<names> leave <name> behind", &[slug, slime]);
}

pub(super) fn turret(draft: &mut Draft, sampler: &mut Sampler) {
    let cooldown = ("cooldown", Value::Count(draw(sampler, 1, 2)));
    let direction = *sampler.choose(&["LEFT", "RIGHT", "DOWN", "any"]);
    let dart = if direction == "any" {
        draft.spawn(Role::Dart, SpriteClass::RandomMissile, Body::FoeShot, &[cooldown])
    } else {
        let params = [("orientation", Value::Word(direction)), cooldown];
        draft.spawn(Role::Dart, SpriteClass::Missile, Body::FoeShot, &params)
    };
    let params = spawning(dart, draw(sampler, 7, 14), draw(sampler, 6, 10));
    let turret = draft.place(Role::Turret, SpriteClass::SpawnPoint, Body::Den, &params);
    draft.harm(dart, Harm::Spent);
    let aim = if direction == "any" { "every which way".to_owned() } else { direction.to_lowercase() };
    let way = if aim == "left" || aim == "right" { format!("to the {aim}") } else { aim };
    draft.add_motion_clause(dart, &format!("<names> shoot <names> {way}"), &[turret, dart]);
}

/// A vent that erupts with a warning: the steam first rises in the vent, then it spreads all around.
pub(super) fn geyser(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("limit", Value::Count(draw(sampler, 1, 3)))];
    let steam = draft.spawn(Role::Steam, SpriteClass::Flicker, Body::Puff, &params);
    let params = [("stype", Value::Part(steam)), ("limit", Value::Count(2))];
    let rising = draft.state(steam, "rising", SpriteClass::Spreader, Body::Puff, &params);
    vent(draft, sampler, rising, (8, 16));
    draft.harm(steam, Harm::Lasting);
}

/// Two types alternate, since none may spread into itself; each makes fewer than one on average, so the spread stays
/// small.
pub(super) fn creep(draft: &mut Draft, sampler: &mut Sampler) {
    let share = ("spreadprob", Value::Hundredths(draw(sampler, 16, 22)));
    let limit = ("limit", Value::Count(draw(sampler, 10, 18)));
    let old = draft.spawn(Role::Creep, SpriteClass::Spreader, Body::Puff, &[share, limit]);
    let young = draft.state(
        old,
        "young",
        SpriteClass::Spreader,
        Body::Puff,
        &[("stype", Value::Part(old)), share, limit],
    );
    draft.give(old, "stype", Value::Part(young));
    vent(draft, sampler, young, (6, 12));
    draft.harm(old, Harm::Lasting);
    draft.harm(young, Harm::Lasting);
}

pub(super) fn vent(draft: &mut Draft, sampler: &mut Sampler, stype: Part, (low, high): (u32, u32)) {
    let params = [("stype", Value::Part(stype)), ("cooldown", Value::Count(draw(sampler, low, high)))];
    let vent = draft.place(Role::Vent, SpriteClass::SpawnPoint, Body::Den, &params);
    let base = english::spaced(draft.name(stype));
    let what = base.split_once(' ').map_or(base.as_str(), |(_, what)| what).to_owned();
    draft.add_fact(&format!("{} comes out of every <name>", what), &[vent]);
}

/// Health fades over time, and wounds reduce it too.
pub(super) fn hunger(draft: &mut Draft, sampler: &mut Sampler) {
    let (health, timer) = (draw(sampler, 5, 8), draw(sampler, 8, 16));
    draft.hearts(health, health + 1);
    let food = draft.place(Role::Berry, SpriteClass::Immovable, Body::Item, &[]);
    draft.rule(Phase::Harm, AVATAR, &[CLOCK], Effect::Wane { timer });
    let eat = Effect::AddHealthPointsToMax { value: draw(sampler, 2, 4) };
    draft.scored(Phase::Take, AVATAR, &[food], eat, 1);
    draft.add_fact("strength fades with time, and <names> give it back", &[food]);
}
