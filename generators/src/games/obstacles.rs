//! Obstacles in the hero's way, with the means to overcome them.

use super::body::Body;
use super::draft::{AVATAR, Draft, Part, Phase, Value, draw};
use super::effect::Effect;
use super::english;
use super::pattern::{Build, Feature, Pattern, Roles, pattern};
use super::role::Role;
use engine::{Sampler, SpriteClass};

const fn obstacle(name: &'static str, weight: u32, roles: Roles, build: Build) -> Pattern {
    pattern(name, weight, roles, &[], build).needs(&[Feature::Four])
}

/// An obstacle that shuts off a part of the level.
const fn shut(name: &'static str, weight: u32, roles: Roles, build: Build) -> Pattern {
    obstacle(name, weight, roles, build).bars(&[Feature::Lanes])
}

pub(crate) const OBSTACLES: &[Pattern] = &[
    shut("obstacle/lock", 4, &[Role::Key, Role::Door], lock),
    obstacle("obstacle/dig", 3, &[Role::Soil], dig),
    obstacle("obstacle/break", 4, &[Role::Soil], break_through).needs(&[Feature::Four, Feature::Strikes]),
    shut("obstacle/lever", 3, &[Role::Lever, Role::Gate], lever),
    shut("obstacle/dark", 3, &[Role::Torch, Role::Dark], dark),
    obstacle("obstacle/portal", 3, &[Role::PortalIn, Role::PortalOut], portal),
    obstacle("obstacle/collapse", 3, &[Role::Archway, Role::Rubble], collapse).bars(&[
        Feature::Errands,
        Feature::Crates,
        Feature::Followers,
    ]),
    obstacle("obstacle/cart", 2, &[Role::Cart], cart).gives(&[Feature::Movers]).bars(&[Feature::Crates]),
    obstacle("obstacle/crates", 1, &[Role::Crate], crates).gives(&[Feature::Crates]),
    shut("obstacle/toll", 4, &[Role::Coin, Role::Gate], toll),
    obstacle("obstacle/ford", 2, &[Role::Crate, Role::Pool], ford).gives(&[Feature::Crates]),
];

/// Doors that open to a key: each uses up one, or one key opens them all.
fn lock(draft: &mut Draft, sampler: &mut Sampler) {
    let subtract = sampler.ratio(1, 2);
    let key = draft.place(Role::Key, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(3))]);
    let door = draft.place(Role::Door, SpriteClass::Door, Body::Solid, &[]);
    draft.scored(Phase::Take, key, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let open = Effect::KillIfOtherHasMore { resource: key, limit: 1, subtract };
    draft.scored(Phase::Open, door, &[AVATAR], open, 2);
    if subtract {
        draft.add_fact("every <name> takes <a name> to open", &[door, key]);
    } else {
        draft.add_fact("whoever has <a name> can open every <name>", &[key, door]);
    }
}

fn dig(draft: &mut Draft, _: &mut Sampler) {
    let soil = draft.place(Role::Soil, SpriteClass::Immovable, Body::Soft, &[]);
    draft.rule(Phase::Meet, soil, &[AVATAR], Effect::KillSprite);
    draft.add_fact("<name> can be dug away", &[soil]);
}

fn break_through(draft: &mut Draft, _: &mut Sampler) {
    let soil = draft.place(Role::Soil, SpriteClass::Immovable, Body::Solid, &[]);
    draft.prey(soil, 0);
    draft.add_fact("<name> can be broken", &[soil]);
}

fn lever(draft: &mut Draft, _: &mut Sampler) {
    let lever = draft.place(Role::Lever, SpriteClass::Immovable, Body::Item, &[]);
    let gate = draft.place(Role::Gate, SpriteClass::Door, Body::Solid, &[]);
    draft.rule(Phase::Take, lever, &[AVATAR], Effect::KillAll { stype: gate });
    draft.scored(Phase::Take, lever, &[AVATAR], Effect::KillSprite, 2);
    draft.add_fact("<a name> opens every <name>", &[lever, gate]);
}

fn dark(draft: &mut Draft, _: &mut Sampler) {
    let torch = draft.place(Role::Torch, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(3))]);
    let dark = draft.place(Role::Dark, SpriteClass::Immovable, Body::Solid, &[]);
    draft.scored(Phase::Take, torch, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let open = Effect::KillIfOtherHasMore { resource: torch, limit: 1, subtract: true };
    draft.scored(Phase::Open, dark, &[AVATAR], open, 1);
    draft.add_fact("each patch of <name> uses up <a name>", &[dark, torch]);
}

fn portal(draft: &mut Draft, _: &mut Sampler) {
    let exit = draft.place(Role::PortalOut, SpriteClass::Immovable, Body::Spot, &[]);
    let entry = draft.place(Role::PortalIn, SpriteClass::Portal, Body::Spot, &[("stype", Value::Part(exit))]);
    draft.rule(Phase::Meet, AVATAR, &[entry], Effect::TeleportToExit);
    draft.add_fact("<a name> leads to <a name>", &[entry, exit]);
}

fn collapse(draft: &mut Draft, _: &mut Sampler) {
    let arch = draft.place(Role::Archway, SpriteClass::Immovable, Body::Spot, &[]);
    let rubble = draft.spawn(Role::Rubble, SpriteClass::Immovable, Body::Solid, &[]);
    draft.rule(Phase::Meet, arch, &[AVATAR], Effect::SpawnBehind { stype: rubble });
    draft.add_fact("the way back from <a name> is closed by <name>", &[arch, rubble]);
}

fn cart(draft: &mut Draft, sampler: &mut Sampler) {
    let orientation = *sampler.choose(&["RIGHT", "DOWN"]);
    let params = [("orientation", Value::Word(orientation)), ("cooldown", Value::Count(draw(sampler, 1, 2)))];
    let cart = draft.place(Role::Cart, SpriteClass::Missile, Body::Carrier, &params);
    draft.rule(Phase::Carry, AVATAR, &[cart], Effect::PullWithIt);
    draft.add_fact("<a name> carries whoever boards it", &[cart]);
}

/// Crates that the hero can push, and that nothing else can pass.
fn crates(draft: &mut Draft, _: &mut Sampler) {
    let block = pushable(draft);
    draft.add_fact("<names> can be pushed", &[block]);
}

/// Adds a crate to push.
pub(crate) fn pushable(draft: &mut Draft) -> Part {
    let block = draft.place(Role::Crate, SpriteClass::Passive, Body::Crate, &[]);
    draft.rule(Phase::Push, block, &[AVATAR], Effect::BounceForward);
    block
}

/// Coins on the board pay for opening gates.
fn toll(draft: &mut Draft, sampler: &mut Sampler) {
    let price = draw(sampler, 1, 3);
    let params = [("limit", Value::Count(price + 2))];
    let coin = draft.place(Role::Coin, SpriteClass::Resource, Body::Item, &params);
    let gate = draft.place(Role::Gate, SpriteClass::Door, Body::Solid, &[]);
    draft.scored(Phase::Take, coin, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let open = Effect::KillIfOtherHasMore { resource: coin, limit: price, subtract: true };
    draft.scored(Phase::Open, gate, &[AVATAR], open, 2);
    let toll = if price == 1 {
        draft.with_article(coin)
    } else {
        format!("{} {}", english::number(price), draft.plural(coin))
    };
    draft.add_fact(&format!("every <name> takes {toll} to pass"), &[gate]);
}

/// A crate pushed into the pool fills it and clears the way.
fn ford(draft: &mut Draft, _: &mut Sampler) {
    let block = pushable(draft);
    let pool = draft.place(Role::Pool, SpriteClass::Immovable, Body::Solid, &[]);
    draft.mark_handled(block, pool);
    draft.scored(Phase::Push, pool, &[block], Effect::KillBoth, 2);
    draft.add_fact("<a name> pushed into the <name> fills it", &[block, pool]);
}
