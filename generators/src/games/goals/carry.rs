//! Goals of fetching, making and delivering.

use super::{exit, goal};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, HERO, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal};
use crate::games::role::Role;
use engine::{Sampler, SpriteClass};

const LADEN: &[Feature] = &[Feature::States, Feature::Errands];

pub(super) const GOALS: &[Goal] = &[
    goal("goal/deliver-all", Kind::Resource, &[Role::Parcel, Role::Address], LADEN, deliver_all),
    goal("goal/deliver-each", Kind::Resource, &[Role::Parcel, Role::Address], LADEN, deliver_each),
    goal("goal/craft", Kind::Resource, &[Role::Ore, Role::Forge, Role::Address], LADEN, craft).ticks(8, 14),
    goal(
        "goal/smelt",
        Kind::Resource,
        &[Role::Ore, Role::Forge, Role::Ingot, Role::Exit],
        &[Feature::Errands],
        smelt,
    )
    .ticks(8, 14),
];

/// Every parcel goes to any address.
fn deliver_all(draft: &mut Draft, _: &mut Sampler) {
    let parcel = draft.place(Role::Parcel, SpriteClass::Immovable, Body::Item, &[]);
    let address = draft.place(Role::Address, SpriteClass::Immovable, Body::Spot, &[]);
    let laden = draft.hero_state("laden");
    draft.scored(Phase::Take, HERO, &[parcel], Effect::TransformTo { stype: laden, kill_second: true }, 1);
    draft.scored(Phase::Take, laden, &[address], Effect::becomes(HERO), 4);
    draft.win_without(&[parcel, laden]);
    draft.goal = draft.phrase("bring every <name> to the <name>, one at a time", &[parcel, address]);
}

/// Every address needs a parcel, from an unlimited stock.
fn deliver_each(draft: &mut Draft, _: &mut Sampler) {
    let stock = draft.place(Role::Parcel, SpriteClass::Immovable, Body::Spot, &[]);
    let address = draft.place(Role::Address, SpriteClass::Immovable, Body::Spot, &[]);
    let laden = draft.hero_state("laden");
    draft.rule(Phase::Take, HERO, &[stock], Effect::becomes(laden));
    delivered(draft, laden, address);
    draft.win_without(&[address]);
    draft.goal = draft.phrase("bring <a name> to every <name>, one at a time", &[stock, address]);
}

/// Delivering uses up both the load and the address.
fn delivered(draft: &mut Draft, laden: Part, address: Part) {
    draft.scored(Phase::Take, address, &[laden], Effect::KillSprite, 5);
    draft.rule(Phase::Take, laden, &[address], Effect::becomes(HERO));
}

/// Raw material is picked up, processed and delivered to an address.
fn craft(draft: &mut Draft, _: &mut Sampler) {
    let ore = draft.place(Role::Ore, SpriteClass::Immovable, Body::Spot, &[]);
    let forge = draft.place(Role::Forge, SpriteClass::Immovable, Body::Spot, &[]);
    let address = draft.place(Role::Address, SpriteClass::Immovable, Body::Spot, &[]);
    let laden = draft.hero_state("laden");
    let ready = draft.hero_state("ready");
    draft.rule(Phase::Take, HERO, &[ore], Effect::becomes(laden));
    draft.scored(Phase::Take, laden, &[forge], Effect::becomes(ready), 2);
    delivered(draft, ready, address);
    draft.win_without(&[address]);
    draft.goal = draft.phrase(
        "load up at the <name>, work it at the <name> and serve every <name>",
        &[ore, forge, address],
    );
}

/// Material is converted piece by piece, within the hero's capacity.
fn smelt(draft: &mut Draft, sampler: &mut Sampler) {
    let cost = draw(sampler, 1, 2);
    let carry = cost * draw(sampler, 1, 2);
    let price = draw(sampler, 2, 4);
    let ore = draft.place(Role::Ore, SpriteClass::Resource, Body::Spot, &[("limit", Value::Count(carry))]);
    let forge = draft.place(Role::Forge, SpriteClass::Immovable, Body::Spot, &[]);
    let ingot =
        draft.spawn(Role::Ingot, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(price))]);
    let exit = exit(draft, Body::Solid);
    draft.rule(Phase::Take, ore, &[AVATAR], Effect::CollectResource { stays: true });
    let work = Effect::SpawnIfHasMore { resource: ore, limit: cost, stype: ingot };
    draft.rule(Phase::Take, AVATAR, &[forge], work);
    draft.scored(Phase::Take, ingot, &[AVATAR], Effect::CollectResource { stays: false }, 3);
    let open = Effect::KillIfOtherHasMore { resource: ingot, limit: price, subtract: false };
    draft.scored(Phase::Open, exit, &[AVATAR], open, 10);
    draft.win_without(&[exit]);
    draft.goal = draft.phrase(
        &format!("make {} <names> at the <name> and hand them in at the <name>", english::number(price)),
        &[ingot, forge, exit],
    );
    draft.add_fact(
        &format!(
            "each takes {} from the <name>, and you can carry {}",
            if cost == 1 { "one load".to_owned() } else { format!("{} loads", english::number(cost)) },
            english::number(carry)
        ),
        &[ore],
    );
}
