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
    goal(
        "goal/forage",
        Kind::Crossing,
        &[Role::Gem, Role::Patroller, Role::Rover],
        &[Feature::Movers, Feature::Harm, Feature::Prey, Feature::Lanes],
        forage,
    )
    .threats(0, 1),
    goal(
        "goal/rivals",
        Kind::CollectAndAvoid,
        &[Role::Gem, Role::Pest],
        &[Feature::Movers, Feature::Prey],
        rivals,
    )
    .threats(0, 1),
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
    draft.goal = draft.phrase("gather every <name>", &[gem]);
}

fn gather_both(draft: &mut Draft, _: &mut Sampler) {
    let gem = pickings(draft, Role::Gem, 1);
    let charm = pickings(draft, Role::Charm, 3);
    draft.win_without(&[gem, charm]);
    draft.goal = draft.phrase("gather every <name> and every <name>", &[gem, charm]);
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
    draft.goal = draft.phrase(
        &format!("gather {} <names>, the price of leaving through the <name>", english::number(price)),
        &[gem, exit],
    );
}

fn forage(draft: &mut Draft, sampler: &mut Sampler) {
    lanes(draft, sampler);
    let gem = pickings(draft, Role::Gem, 2);
    draft.win_without(&[gem]);
    draft.goal = draft.phrase("gather every <name> between the lanes", &[gem]);
}

/// Rivals want the same things: the game is lost when they have spoiled too many.
fn rivals(draft: &mut Draft, sampler: &mut Sampler) {
    let gem = pickings(draft, Role::Gem, 2);
    let rival = draft.place(Role::Pest, SpriteClass::Chaser, Body::Walker, &threats::pursuing(gem, sampler));
    let taken = draft.state(gem, "gnawed", SpriteClass::Immovable, Body::Flat, &[]);
    draft.scored(Phase::Meet, gem, &[rival], Effect::becomes(taken), -2);
    draft.prey(rival, 2);
    let limit = draw(sampler, 2, 4);
    draft.lose_with(taken, limit);
    draft.win_without(&[gem]);
    draft.goal = draft.phrase(
        &format!("gather every <name> before {} of them are spoiled", english::number(limit)),
        &[gem],
    );
    draft.add_fact("<names> spoil every <name> that they reach", &[rival, gem]);
}
