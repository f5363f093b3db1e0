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
    Goal {
        ticks: (8, 14),
        ..goal("goal/craft", Kind::Resource, &[Role::Ore, Role::Forge, Role::Address], LADEN, craft)
    },
    Goal {
        ticks: (8, 14),
        ..goal(
            "goal/smelt",
            Kind::Resource,
            &[Role::Ore, Role::Forge, Role::Ingot, Role::Exit],
            &[Feature::Errands],
            smelt,
        )
    },
];

fn becomes(stype: Part) -> Effect {
    Effect::TransformTo { stype, kill_second: false }
}

/// Every parcel goes to any address.
fn deliver_all(draft: &mut Draft, _: &mut Sampler) {
    let parcel = draft.place(Role::Parcel, SpriteClass::Immovable, Body::Item, &[]);
    let address = draft.place(Role::Address, SpriteClass::Immovable, Body::Spot, &[]);
    let laden = draft.hero_state("laden");
    draft.scored(Phase::Take, HERO, &[parcel], Effect::TransformTo { stype: laden, kill_second: true }, 1);
    draft.scored(Phase::Take, laden, &[address], becomes(HERO), 4);
    draft.win_without(&[parcel, laden]);
    draft.goal = format!(
        "bring every {} to the {}, one at a time",
        draft.spaced_name(parcel),
        draft.spaced_name(address)
    );
}

/// Every address needs a parcel, from an unlimited stock.
fn deliver_each(draft: &mut Draft, _: &mut Sampler) {
    let stock = draft.place(Role::Parcel, SpriteClass::Immovable, Body::Spot, &[]);
    let address = draft.place(Role::Address, SpriteClass::Immovable, Body::Spot, &[]);
    let laden = draft.hero_state("laden");
    draft.rule(Phase::Take, HERO, &[stock], becomes(laden));
    delivered(draft, laden, address);
    draft.win_without(&[address]);
    draft.goal =
        format!("bring {} to every {}, one at a time", draft.with_article(stock), draft.spaced_name(address));
}

/// Delivering uses up both the load and the address.
fn delivered(draft: &mut Draft, laden: Part, address: Part) {
    draft.scored(Phase::Take, address, &[laden], Effect::KillSprite, 5);
    draft.rule(Phase::Take, laden, &[address], becomes(HERO));
}

/// Raw material is picked up, processed and delivered to an address.
fn craft(draft: &mut Draft, _: &mut Sampler) {
    let ore = draft.place(Role::Ore, SpriteClass::Immovable, Body::Spot, &[]);
    let forge = draft.place(Role::Forge, SpriteClass::Immovable, Body::Spot, &[]);
    let address = draft.place(Role::Address, SpriteClass::Immovable, Body::Spot, &[]);
    let laden = draft.hero_state("laden");
    let ready = draft.hero_state("ready");
    draft.rule(Phase::Take, HERO, &[ore], becomes(laden));
    draft.scored(Phase::Take, laden, &[forge], becomes(ready), 2);
    delivered(draft, ready, address);
    draft.win_without(&[address]);
    draft.goal = format!(
        "load up at the {}, work it at the {} and serve every {}",
        draft.spaced_name(ore),
        draft.spaced_name(forge),
        draft.spaced_name(address)
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
    draft.goal = format!(
        "make {} {} at the {} and hand them in at the {}",
        english::number(price),
        draft.plural(ingot),
        draft.spaced_name(forge),
        draft.spaced_name(exit)
    );
    let clause = format!(
        "each takes {} from the {}, and you can carry {}",
        if cost == 1 { "one load".to_owned() } else { format!("{} loads", english::number(cost)) },
        draft.spaced_name(ore),
        english::number(carry)
    );
    draft.add_fact(clause);
}
