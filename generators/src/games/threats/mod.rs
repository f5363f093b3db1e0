//! Threats to the hero.

mod foes;
mod hazards;
mod nests;

pub(crate) use foes::{bombers, throwers};
pub(crate) use nests::nest;

use crate::games::body::Body;
use crate::games::draft::{Draft, Harm, Part, Value, draw};
use crate::games::pattern::{Build, Feature, Features, Pattern, Roles, pattern};
use crate::games::role::Role;
use engine::{Sampler, SpriteClass};

/// Moving dangers that can be hit.
const FOE: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::Prey];
/// The same, with a harmful trail.
const STAINING: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::Prey, Feature::Stains];
/// Moving dangers that cannot be hit.
const DANGER: &[Feature] = &[Feature::Movers, Feature::Harm];

const fn threat(name: &'static str, weight: u32, roles: Roles, gives: Features, build: Build) -> Pattern {
    pattern(name, weight, roles, gives, build).needs(&[Feature::Four])
}

pub(crate) const THREATS: &[Pattern] = &[
    threat("threat/trap", 4, &[Role::Trap], &[Feature::Harm], hazards::trap),
    threat("threat/patrol", 4, &[Role::Patroller], FOE, foes::patrol),
    threat("threat/cross-patrols", 2, &[Role::Patroller, Role::Rover], FOE, foes::cross_patrols),
    threat("threat/stray", 4, &[Role::Wanderer], FOE, foes::stray),
    threat("threat/chase", 4, &[Role::Chaser], FOE, foes::chase),
    threat("threat/bomb", 3, &[Role::Bomber, Role::Drop], FOE, foes::bomb),
    threat("threat/slime", 3, &[Role::Slug, Role::Slime], STAINING, hazards::slime),
    threat("threat/turret", 3, &[Role::Turret, Role::Dart], DANGER, hazards::turret),
    threat("threat/nest-of-strays", 2, &[Role::Nest, Role::Wanderer], FOE, nests::nest_of_strays),
    threat("threat/nest-of-chasers", 2, &[Role::Nest, Role::Chaser], FOE, nests::nest_of_chasers),
    threat("threat/geyser", 3, &[Role::Vent, Role::Steam], DANGER, hazards::geyser),
    threat(
        "threat/creep",
        2,
        &[Role::Vent, Role::Creep],
        &[Feature::Movers, Feature::Harm, Feature::Stains],
        hazards::creep,
    ),
    threat("threat/split", 3, &[Role::Wanderer, Role::Chaser], FOE, foes::split)
        .needs(&[Feature::Four, Feature::Strikes]),
    threat(
        "threat/bearer",
        4,
        &[Role::Wanderer, Role::Medicine],
        &[Feature::Movers, Feature::Harm, Feature::Prey, Feature::Health],
        foes::bearer,
    )
    .needs(&[Feature::Four, Feature::Strikes])
    .bars(&[Feature::Health]),
    threat("threat/brood", 3, &[Role::Nest, Role::Chaser], FOE, nests::brood),
    threat("threat/sentry", 4, &[Role::Chaser], FOE, foes::sentry),
    threat("threat/drift", 3, &[Role::Rover], FOE, foes::drift),
    threat("threat/hunger", 4, &[Role::Berry], &[Feature::Health], hazards::hunger).bars(&[Feature::Health]),
    threat("threat/rain", 3, &[Role::Bomber, Role::Drop], FOE, foes::rain).needs(&[Feature::Row]),
];

/// Adds a patroller that moves straight and turns round; `orientation` is its first direction.
pub(crate) fn patroller(draft: &mut Draft, role: Role, orientation: &'static str, cooldown: u32) -> Part {
    let params = [("orientation", Value::Word(orientation)), ("cooldown", Value::Count(cooldown))];
    draft.place(role, SpriteClass::Missile, Body::Patroller, &params)
}

/// Makes a placed foe harm the hero and be a target of its weapon.
fn foe_of(draft: &mut Draft, foe: Part, score: i32) {
    draft.harm(foe, Harm::Spent);
    draft.prey(foe, score);
}

/// The parameters of random movement: the cooldown, and the number of steps in one direction.
pub(crate) fn straying(sampler: &mut Sampler) -> [(&'static str, Value); 2] {
    [("cooldown", Value::Count(draw(sampler, 2, 4))), ("cons", Value::Count(draw(sampler, 0, 3)))]
}

/// The parameters of a source of something: what it makes, how often it may, and in how many of ten times it does.
pub(crate) fn spawning(stype: Part, cooldown: u32, tenths: u32) -> [(&'static str, Value); 3] {
    let prob = Value::Hundredths(10 * tenths);
    [("stype", Value::Part(stype)), ("cooldown", Value::Count(cooldown)), ("prob", prob)]
}

/// The parameters of pursuit: the target and the cooldown.
pub(crate) fn pursuing(target: Part, sampler: &mut Sampler) -> [(&'static str, Value); 2] {
    [("stype", Value::Part(target)), ("cooldown", Value::Count(draw(sampler, 2, 4)))]
}
