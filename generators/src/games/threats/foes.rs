//! Foes that move.

use super::{foe_of, patroller, pursuing, straying};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, Harm, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::role::Role;
use engine::{Sampler, SpriteClass};

pub(super) fn patrol(draft: &mut Draft, sampler: &mut Sampler) {
    let orientation = *sampler.choose(&["RIGHT", "DOWN"]);
    let foe = patroller(draft, Role::Patroller, orientation, draw(sampler, 2, 3));
    foe_of(draft, foe, 2);
    let way = if orientation == "RIGHT" { "to and fro" } else { "up and down" };
    draft.add_motion_clause(foe, &format!("<names> go {way}"), &[foe]);
}

pub(super) fn cross_patrols(draft: &mut Draft, sampler: &mut Sampler) {
    let across = patroller(draft, Role::Patroller, "RIGHT", draw(sampler, 2, 3));
    let along = patroller(draft, Role::Rover, "DOWN", draw(sampler, 2, 3));
    foe_of(draft, across, 2);
    foe_of(draft, along, 2);
    draft.add_fact("<names> go to and fro, <names> up and down", &[across, along]);
}

pub(super) fn stray(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &straying(sampler));
    foe_of(draft, foe, 2);
    draft.add_motion_clause(foe, "<names> stray about", &[foe]);
}

pub(super) fn chase(draft: &mut Draft, sampler: &mut Sampler) {
    let params = pursuing(AVATAR, sampler);
    let foe = draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    foe_of(draft, foe, 3);
    draft.add_motion_clause(foe, "<names> give chase", &[foe]);
}

pub(super) fn sentry(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.place(Role::Chaser, SpriteClass::LOSChaser, Body::Walker, &pursuing(AVATAR, sampler));
    foe_of(draft, foe, 3);
    draft.add_motion_clause(foe, "<names> come after you once they see you", &[foe]);
}

/// Moves straight on, and turns in a random direction at obstacles.
pub(super) fn drift(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [
        ("orientation", Value::Word(["RIGHT", "DOWN"][sampler.below(2)])),
        ("cooldown", Value::Count(draw(sampler, 2, 3))),
    ];
    let foe = draft.place(Role::Rover, SpriteClass::Missile, Body::Drifter, &params);
    foe_of(draft, foe, 2);
    draft.add_motion_clause(foe, "<names> rush straight on and come off obstacles any way", &[foe]);
}

/// A slow foe that turns into a fast one when it is hit.
pub(super) fn split(draft: &mut Draft, sampler: &mut Sampler) {
    let slow = draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &straying(sampler));
    let quick = draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &pursuing(AVATAR, sampler));
    draft.harm(slow, Harm::Spent);
    draft.prey_leaves(slow, quick, 1);
    foe_of(draft, quick, 3);
    draft.add_fact("every <name> that is hit turns into <a name> and gives chase", &[slow, quick]);
}

/// A patroller that drops things.
pub(crate) fn bombers(draft: &mut Draft, sampler: &mut Sampler) -> (Part, Part) {
    throwers(draft, sampler, ["LEFT", "RIGHT"], "DOWN")
}

/// A patroller that starts in one of these directions and throws things in another.
pub(crate) fn throwers(
    draft: &mut Draft,
    sampler: &mut Sampler,
    ways: [&'static str; 2],
    throw: &'static str,
) -> (Part, Part) {
    let params = [("orientation", Value::Word(throw)), ("cooldown", Value::Count(draw(sampler, 1, 2)))];
    let drop = draft.spawn(Role::Drop, SpriteClass::Missile, Body::FoeShot, &params);
    let params = [
        ("stype", Value::Part(drop)),
        ("orientation", Value::Word(ways[sampler.below(2)])),
        ("speed", Value::Count(1)),
        ("cooldown", Value::Count(draw(sampler, 2, 4))),
        ("prob", Value::Hundredths(5 * draw(sampler, 4, 10))),
    ];
    let bomber = draft.place(Role::Bomber, SpriteClass::Bomber, Body::Patroller, &params);
    draft.harm(drop, Harm::Spent);
    (bomber, drop)
}

pub(super) fn bomb(draft: &mut Draft, sampler: &mut Sampler) {
    let (bomber, drop) = bombers(draft, sampler);
    foe_of(draft, bomber, 3);
    draft.add_fact("<names> drop <names>", &[bomber, drop]);
}

/// The hero stays below: only the falling things harm it.
pub(super) fn rain(draft: &mut Draft, sampler: &mut Sampler) {
    let (bomber, drop) = bombers(draft, sampler);
    draft.prey(bomber, 3);
    draft.add_fact("<names> drop <names>", &[bomber, drop]);
}

/// A foe that leaves medicine when it is killed, so that hunting it pays.
pub(super) fn bearer(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &straying(sampler));
    let medicine = draft.spawn(Role::Medicine, SpriteClass::Immovable, Body::Item, &[]);
    let health = draw(sampler, 2, 3);
    draft.hearts(health, health + 1);
    draft.harm(foe, Harm::Spent);
    draft.prey_leaves(foe, medicine, 2);
    draft.scored(Phase::Take, AVATAR, &[medicine], Effect::AddHealthPointsToMax { value: 1 }, 2);
    draft.add_fact(
        &format!(
            "{} wounds are the end, but every <name> that is struck down leaves <name>, which heals",
            english::number(health)
        ),
        &[foe, medicine],
    );
}
