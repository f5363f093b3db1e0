//! The hero's ways of moving, and its weapons.

use super::body::Body;
use super::draft::{AVATAR, Draft, HERO, Harm, Phase, Value, Weapon, draw};
use super::effect::Effect;
use super::pattern::{Feature, Pattern, pattern};
use super::role::Role;
use engine::{Sampler, SpriteClass};

pub(crate) const MOVEMENTS: &[Pattern] = &[
    pattern("movement/walk", 12, &[], &[Feature::Four], walk),
    pattern("movement/turn", 2, &[], &[Feature::Four], turn).bars(&[Feature::Crates]),
    pattern("movement/blade", 5, &[Role::Blade], &[Feature::Four, Feature::Armed, Feature::Strikes], blade),
    pattern("movement/shoot", 4, &[Role::Bolt], &[Feature::Four, Feature::Armed, Feature::Strikes], shoot),
    pattern(
        "movement/shoot-scarce",
        2,
        &[Role::Bolt, Role::Ammo],
        &[Feature::Four, Feature::Armed, Feature::Strikes, Feature::Scarce],
        shoot_scarce,
    ),
    pattern(
        "movement/shoot-rack",
        2,
        &[Role::Bolt, Role::Ammo, Role::Rack],
        &[Feature::Four, Feature::Armed, Feature::Strikes, Feature::Errands],
        shoot_rack,
    ),
    pattern(
        "movement/blast",
        4,
        &[Role::Charge, Role::Blast],
        &[Feature::Four, Feature::Armed, Feature::Blasts, Feature::Harm],
        blast,
    )
    .needs(&[Feature::Ruins]),
    pattern("movement/flak", 4, &[Role::Bolt], &[Feature::Row, Feature::Armed, Feature::Strikes], flak),
    pattern("movement/slide", 4, &[], &[Feature::Row], slide),
    pattern("movement/climb", 4, &[], &[Feature::Column], climb),
    pattern("movement/drive", 3, &[], &[Feature::Four, Feature::Movers], drive).bars(&[
        Feature::Crates,
        Feature::Followers,
        Feature::Errands,
    ]),
];

fn walk(draft: &mut Draft, _: &mut Sampler) {
    draft.set_hero(SpriteClass::MovingAvatar, &[]);
}

/// Turning costs a tick.
fn turn(draft: &mut Draft, _: &mut Sampler) {
    draft.set_hero(SpriteClass::OrientedAvatar, &[("rotateInPlace", Value::Flag(true))]);
    draft.outfit = "slow to turn".into();
}

fn blade(draft: &mut Draft, sampler: &mut Sampler) {
    let limit = draw(sampler, 1, 3);
    let params = [("limit", Value::Count(limit)), ("singleton", Value::Flag(true))];
    let blade = draft.spawn(Role::Blade, SpriteClass::OrientedFlicker, Body::Flat, &params);
    let turns = sampler.ratio(1, 4);
    draft.set_hero(
        SpriteClass::ShootAvatar,
        &[("stype", Value::Part(blade)), ("rotateInPlace", Value::Flag(turns))],
    );
    draft.weapon = Some(Weapon::Blade(blade));
    draft.outfit = draft.phrase("armed with <a name>", &[blade]);
}

/// Adds a shot, and makes the hero shoot it.
fn shooter(draft: &mut Draft, sampler: &mut Sampler, ammo: Option<Value>) {
    // With at most one shot in the air, every miss has a cost.
    let alone = sampler.ratio(1, 2);
    let alone = alone.then_some(("singleton", Value::Flag(true)));
    let params: Vec<_> = alone.into_iter().collect();
    let bolt = draft.spawn(Role::Bolt, SpriteClass::Missile, Body::Shot, &params);
    let turns = sampler.ratio(1, 4);
    let stype = [("stype", Value::Part(bolt)), ("rotateInPlace", Value::Flag(turns))];
    let ammo = ammo.map(|ammo| ("ammo", ammo));
    let params: Vec<_> = stype.into_iter().chain(ammo).collect();
    draft.set_hero(SpriteClass::ShootAvatar, &params);
    draft.weapon = Some(Weapon::Bolt(bolt));
    draft.outfit = draft.phrase("shooting <names>", &[bolt]);
}

fn shoot(draft: &mut Draft, sampler: &mut Sampler) {
    shooter(draft, sampler, None);
}

fn shoot_scarce(draft: &mut Draft, sampler: &mut Sampler) {
    let value = draw(sampler, 3, 4);
    let params = [("value", Value::Count(value)), ("limit", Value::Count(3 * value))];
    let ammo = draft.place(Role::Ammo, SpriteClass::Resource, Body::Item, &params);
    shooter(draft, sampler, Some(Value::Part(ammo)));
    draft.scored(Phase::Take, ammo, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    draft.add_fact(&format!("<names> give {} shots each", super::english::number(value)), &[ammo]);
}

fn shoot_rack(draft: &mut Draft, sampler: &mut Sampler) {
    let value = draw(sampler, 2, 4);
    let params = [
        ("value", Value::Count(value)),
        ("limit", Value::Count(2 * value)),
        ("singleton", Value::Flag(true)),
    ];
    let ammo = draft.spawn(Role::Ammo, SpriteClass::Resource, Body::Item, &params);
    let params = [("stype", Value::Part(ammo)), ("cooldown", Value::Count(draw(sampler, 4, 10)))];
    let rack = draft.place(Role::Rack, SpriteClass::SpawnPoint, Body::Spot, &params);
    shooter(draft, sampler, Some(Value::Part(ammo)));
    draft.rule(Phase::Take, ammo, &[AVATAR], Effect::CollectResource { stays: false });
    draft.add_fact("every shot costs <a name>, to be had at <a name>", &[ammo, rack]);
}

/// A charge explodes a few ticks after it is laid, in all four directions.
fn blast(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("limit", Value::Count(draw(sampler, 1, 2)))];
    let blast = draft.spawn(Role::Blast, SpriteClass::Flicker, Body::Puff, &params);
    // A Spreader spreads at age 2: a negative age makes a longer fuse.
    let fuse = draw(sampler, 2, 4) as i32;
    let params = [
        ("stype", Value::Part(blast)),
        ("age", Value::Score(-fuse)),
        ("limit", Value::Count(2)),
        ("singleton", Value::Flag(true)),
    ];
    let charge = draft.spawn(Role::Charge, SpriteClass::Spreader, Body::Puff, &params);
    draft.set_hero(
        SpriteClass::ShootAvatar,
        &[("stype", Value::Part(charge)), ("rotateInPlace", Value::Flag(false))],
    );
    draft.weapon = Some(Weapon::Blast(blast));
    draft.harm(blast, Harm::Lasting);
    draft.outfit = draft.phrase("laying <names>", &[charge]);
    draft.add_fact("every <name> goes off to all four sides", &[charge]);
}

fn flak(draft: &mut Draft, sampler: &mut Sampler) {
    let alone = sampler.ratio(2, 3).then_some(("singleton", Value::Flag(true)));
    let params: Vec<_> = [("orientation", Value::Word("UP"))].into_iter().chain(alone).collect();
    let bolt = draft.spawn(Role::Bolt, SpriteClass::Missile, Body::Shot, &params);
    draft.set_hero(SpriteClass::FlakAvatar, &[("stype", Value::Part(bolt))]);
    draft.weapon = Some(Weapon::Bolt(bolt));
    draft.outfit = draft.phrase("shooting <names> upwards", &[bolt]);
}

fn slide(draft: &mut Draft, _: &mut Sampler) {
    draft.set_hero(SpriteClass::HorizontalAvatar, &[]);
    draft.add_fact("the <name> only moves left and right", &[HERO]);
}

fn climb(draft: &mut Draft, _: &mut Sampler) {
    draft.set_hero(SpriteClass::VerticalAvatar, &[]);
    draft.add_fact("the <name> only moves up and down", &[HERO]);
}

/// A vehicle: it can be turned, but not stopped.
fn drive(draft: &mut Draft, sampler: &mut Sampler) {
    draft.set_hero(SpriteClass::OngoingAvatar, &[("cooldown", Value::Count(draw(sampler, 2, 3)))]);
    draft.outfit = "unable to stop".into();
}
