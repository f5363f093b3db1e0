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
    Goal {
        threats: (1, 2),
        obstacles: (1, 2),
        ..goal("goal/reach", Kind::Escape, &[Role::Exit], &[], reach)
    },
    goal("goal/unseal", Kind::Escape, &[Role::Exit, Role::Lever], &[], unseal),
    Goal {
        threats: (0, 1),
        ..goal(
            "goal/heist",
            Kind::Escape,
            &[Role::Relic, Role::Statue, Role::Exit],
            &[Feature::States, Feature::Movers, Feature::Harm, Feature::Prey],
            heist,
        )
    },
    Goal {
        threats: (0, 1),
        ..goal(
            "goal/cross",
            Kind::Crossing,
            &[Role::Exit, Role::Patroller, Role::Rover],
            &[Feature::Movers, Feature::Harm, Feature::Prey, Feature::Lanes],
            cross,
        )
    },
];

fn reach(draft: &mut Draft, _: &mut Sampler) {
    let exit = exit(draft, Body::Spot);
    draft.scored(Phase::Arrive, exit, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[exit]);
    draft.goal = format!("reach the {}", draft.spaced_name(exit));
}

fn unseal(draft: &mut Draft, _: &mut Sampler) {
    let lever = draft.place(Role::Lever, SpriteClass::Immovable, Body::Item, &[]);
    let (shut, open) = shut_exit(draft);
    draft.rule(Phase::Take, lever, &[AVATAR], Effect::TransformToAll { stype: shut, into: open });
    draft.scored(Phase::Take, lever, &[AVATAR], Effect::KillSprite, 3);
    draft.scored(Phase::Arrive, open, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[shut, open]);
    draft.goal = format!(
        "throw the {} that unseals the {}, then leave by it",
        draft.spaced_name(lever),
        draft.spaced_name(open)
    );
}

/// Taking the relic wakes its guards.
fn heist(draft: &mut Draft, sampler: &mut Sampler) {
    let relic = draft.place(Role::Relic, SpriteClass::Immovable, Body::Item, &[]);
    let statue = draft.place(Role::Statue, SpriteClass::Immovable, Body::Solid, &[]);
    let params = threats::pursuing(AVATAR, sampler);
    let woken = draft.state(statue, "woken", SpriteClass::Chaser, Body::Walker, &params);
    let exit = exit(draft, Body::Spot);
    let laden = draft.hero_state("laden");
    draft.rule(Phase::Take, relic, &[HERO], Effect::TransformToAll { stype: statue, into: woken });
    draft.scored(Phase::Take, HERO, &[relic], Effect::TransformTo { stype: laden, kill_second: true }, 5);
    draft.rule(Phase::Block, HERO, &[exit], Effect::StepBack);
    draft.scored(Phase::Arrive, exit, &[laden], Effect::KillSprite, 10);
    draft.harm(woken, Harm::Spent);
    draft.prey(woken, 2);
    draft.win_without(&[exit]);
    draft.goal = format!(
        "take the {} and carry it out through the {}",
        draft.spaced_name(relic),
        draft.spaced_name(exit)
    );
    let clause =
        format!("every {} wakes when the {} is taken", draft.spaced_name(statue), draft.spaced_name(relic));
    draft.add_fact(clause);
}

fn cross(draft: &mut Draft, sampler: &mut Sampler) {
    lanes(draft, sampler);
    let exit = exit(draft, Body::Spot);
    draft.scored(Phase::Arrive, exit, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[exit]);
    draft.goal = format!("cross the lanes to the {}", draft.spaced_name(exit));
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
    let clause = format!("{} and {} rush to and fro", draft.plural(one), draft.plural(two));
    draft.add_fact(clause);
}
