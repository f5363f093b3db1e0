//! Goals of reaching a place.

use super::{exit, goal, shut_exit};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, HERO, Harm, Phase, draw};
use crate::games::effect::Effect;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

pub(super) const GOALS: &[Goal] = &[
    goal("goal/reach", Kind::Escape, &[Role::Exit], &[], reach).obstacles(1, 2),
    goal("goal/unseal", Kind::Escape, &[Role::Exit, Role::Lever], &[], unseal),
    goal(
        "goal/heist",
        Kind::Escape,
        &[Role::Relic, Role::Statue, Role::Exit],
        &[Feature::States, Feature::Movers, Feature::Harm, Feature::Prey],
        heist,
    )
    .threats(0, 1),
    goal(
        "goal/cross",
        Kind::Crossing,
        &[Role::Exit, Role::Patroller, Role::Rover],
        &[Feature::Movers, Feature::Harm, Feature::Prey, Feature::Lanes],
        cross,
    )
    .threats(0, 1),
];

fn reach(draft: &mut Draft, _: &mut Sampler) {
    let exit = exit(draft, Body::Spot);
    draft.scored(Phase::Arrive, exit, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[exit]);
    draft.goal = draft.phrase("reach the <name>", &[exit]);
}

fn unseal(draft: &mut Draft, _: &mut Sampler) {
    let lever = draft.place(Role::Lever, SpriteClass::Immovable, Body::Item, &[]);
    let (shut, open) = shut_exit(draft);
    draft.rule(Phase::Take, lever, &[AVATAR], Effect::TransformToAll { stype: shut, into: open });
    draft.scored(Phase::Take, lever, &[AVATAR], Effect::KillSprite, 3);
    draft.scored(Phase::Arrive, open, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[shut, open]);
    draft.goal = draft.phrase("throw the <name> that unseals the <name>, then leave by it", &[lever, open]);
}

/// Taking the relic wakes its guards.
fn heist(draft: &mut Draft, sampler: &mut Sampler) {
    let relic = draft.place(Role::Relic, SpriteClass::Immovable, Body::Item, &[]);
    let statue = draft.place(Role::Statue, SpriteClass::Immovable, Body::Solid, &[]);
    let woken =
        draft.state(statue, "woken", SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    let exit = exit(draft, Body::Spot);
    let laden = draft.hero_state("laden");
    draft.rule(Phase::Take, relic, &[HERO], Effect::TransformToAll { stype: statue, into: woken });
    draft.scored(Phase::Take, HERO, &[relic], Effect::TransformTo { stype: laden, kill_second: true }, 5);
    draft.rule(Phase::Block, HERO, &[exit], Effect::StepBack);
    draft.scored(Phase::Arrive, exit, &[laden], Effect::KillSprite, 10);
    draft.harm(woken, Harm::Spent);
    draft.prey(woken, 2);
    draft.win_without(&[exit]);
    draft.goal = draft.phrase("take the <name> and carry it out through the <name>", &[relic, exit]);
    draft.add_fact("every <name> wakes when the <name> is taken", &[statue, relic]);
}

fn cross(draft: &mut Draft, sampler: &mut Sampler) {
    lanes(draft, sampler);
    let exit = exit(draft, Body::Spot);
    draft.scored(Phase::Arrive, exit, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[exit]);
    draft.goal = draft.phrase("cross the lanes to the <name>", &[exit]);
}

/// Adds two types of traffic in opposite directions, one faster than the other.
pub(super) fn lanes(draft: &mut Draft, sampler: &mut Sampler) {
    let slow = draw(sampler, 2, 3);
    let mut ways = ["LEFT", "RIGHT"];
    sampler.shuffle(&mut ways);
    let one = threats::patroller(draft, Role::Patroller, ways[0], slow);
    let two = threats::patroller(draft, Role::Rover, ways[1], slow - 1);
    for foe in [one, two] {
        draft.harm(foe, Harm::Spent);
        draft.prey(foe, 1);
    }
    draft.add_fact("<names> and <names> rush to and fro", &[one, two]);
}
