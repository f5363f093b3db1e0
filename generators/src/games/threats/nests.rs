//! Sources of foes.

use super::{foe_of, pursuing, spawning, straying};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::role::Role;
use engine::{Sampler, SpriteClass};

/// Adds a nest that spawns foes; with `total` 0 it never stops.
pub(crate) fn nest(draft: &mut Draft, sampler: &mut Sampler, foe: Part, total: u32) -> Part {
    let total = (total > 0).then_some(("total", Value::Count(total)));
    let params = spawning(foe, draw(sampler, 15, 35), draw(sampler, 5, 10));
    let params: Vec<_> = params.into_iter().chain(total).collect();
    draft.place(Role::Nest, SpriteClass::SpawnPoint, Body::Den, &params)
}

pub(super) fn nest_of_strays(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.spawn(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &straying(sampler));
    nest_of(draft, sampler, foe);
}

pub(super) fn nest_of_chasers(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &pursuing(AVATAR, sampler));
    nest_of(draft, sampler, foe);
}

pub(super) fn nest_of(draft: &mut Draft, sampler: &mut Sampler, foe: Part) {
    let total = draw(sampler, 2, 5);
    let nest = nest(draft, sampler, foe, total);
    foe_of(draft, foe, 1);
    draft.add_fact("<names> come out of every <name>", &[foe, nest]);
}

/// Each nest hatches one pursuer after a while, unless the hero clears it first.
pub(super) fn brood(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &pursuing(AVATAR, sampler));
    let params = [
        ("stype", Value::Part(foe)),
        ("cooldown", Value::Count(draw(sampler, 30, 60))),
        ("total", Value::Count(1)),
    ];
    let nest = draft.place(Role::Nest, SpriteClass::SpawnPoint, Body::Spot, &params);
    draft.scored(Phase::Take, nest, &[AVATAR], Effect::KillSprite, 2);
    foe_of(draft, foe, 2);
    draft.add_fact(
        "every <name> sends <a name> after you in the end, unless you clear it away first",
        &[nest, foe],
    );
}
