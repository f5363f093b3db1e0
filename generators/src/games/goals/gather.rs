//! Goals of gathering things.

use super::arrive::lanes;
use super::{exit, goal};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

pub(super) const GOALS: &[Goal] = &[
    goal("goal/gather", Kind::CollectAndAvoid, &[Role::Gem], &[], gather),
    goal("goal/gather-both", Kind::CollectAndAvoid, &[Role::Gem, Role::Charm], &[], gather_both),
    goal("goal/toll", Kind::CollectAndAvoid, &[Role::Gem, Role::Exit], &[], toll),
    Goal {
        threats: (0, 1),
        ..goal(
            "goal/forage",
            Kind::Crossing,
            &[Role::Gem, Role::Patroller, Role::Rover],
            &[Feature::Movers, Feature::Harm, Feature::Prey, Feature::Lanes],
            forage,
        )
    },
    Goal {
        threats: (0, 1),
        ..goal(
            "goal/rivals",
            Kind::CollectAndAvoid,
            &[Role::Gem, Role::Pest],
            &[Feature::Movers, Feature::Prey],
            rivals,
        )
    },
];

/// Something to pick up by touching it.
fn pickings(draft: &mut Draft, role: Role, score: i32) -> Part {
    let gem = draft.place(role, SpriteClass::Immovable, Body::Item, &[]);
    draft.scored(Phase::Take, gem, &[AVATAR], Effect::KillSprite, score);
    gem
}

fn gather(draft: &mut Draft, _: &mut Sampler) {
    let gem = pickings(draft, Role::Gem, 2);
    draft.win_without(&[gem]);
    draft.goal = format!("gather every {}", draft.spaced_name(gem));
}

fn gather_both(draft: &mut Draft, _: &mut Sampler) {
    let gem = pickings(draft, Role::Gem, 1);
    let charm = pickings(draft, Role::Charm, 3);
    draft.win_without(&[gem, charm]);
    draft.goal = format!("gather every {} and every {}", draft.spaced_name(gem), draft.spaced_name(charm));
}

fn toll(draft: &mut Draft, sampler: &mut Sampler) {
    let price = draw(sampler, 2, 5);
    let gem =
        draft.place(Role::Gem, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(price + 3))]);
    let exit = exit(draft, Body::Solid);
    draft.scored(Phase::Take, gem, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let open = Effect::KillIfOtherHasMore { resource: gem, limit: price, subtract: false };
    draft.scored(Phase::Open, exit, &[AVATAR], open, 10);
    draft.win_without(&[exit]);
    draft.goal = format!(
        "gather {} {}, the price of leaving through the {}",
        english::number(price),
        draft.plural(gem),
        draft.spaced_name(exit)
    );
}

fn forage(draft: &mut Draft, sampler: &mut Sampler) {
    lanes(draft, sampler);
    let gem = pickings(draft, Role::Gem, 2);
    draft.win_without(&[gem]);
    draft.goal = format!("gather every {} between the lanes", draft.spaced_name(gem));
}

/// Rivals want the same things: the game is lost when they have spoiled too many.
fn rivals(draft: &mut Draft, sampler: &mut Sampler) {
    let gem = pickings(draft, Role::Gem, 2);
    let params = threats::pursuing(gem, sampler);
    let rival = draft.place(Role::Pest, SpriteClass::Chaser, Body::Walker, &params);
    let taken = draft.state(gem, "gnawed", SpriteClass::Immovable, Body::Flat, &[]);
    let spoil = Effect::TransformTo { stype: taken, kill_second: false };
    draft.scored(Phase::Meet, gem, &[rival], spoil, -2);
    draft.prey(rival, 2);
    let limit = draw(sampler, 2, 4);
    draft.lose_with(taken, limit);
    draft.win_without(&[gem]);
    draft.goal = format!(
        "gather every {} before {} of them are spoiled",
        draft.spaced_name(gem),
        english::number(limit)
    );
    let clause = format!("{} spoil every {} that they reach", draft.plural(rival), draft.spaced_name(gem));
    draft.add_fact(clause);
}
