//! The hero's ways of moving, and its weapons.

use super::body::Body;
use super::draft::{AVATAR, Draft, HERO, Harm, Phase, Value, Weapon, draw};
use super::effect::Effect;
use super::pattern::{Feature, Pattern};
use super::role::Role;
use engine::{Sampler, SpriteClass};

/// All ways of moving.
pub(crate) const MOVEMENTS: &[Pattern] = &[
    Pattern {
        name: "movement/walk",
        weight: 12,
        roles: &[],
        gives: &[Feature::Four],
        needs: &[],
        bars: &[],
        build: walk,
    },
    Pattern {
        name: "movement/turn",
        weight: 2,
        roles: &[],
        gives: &[Feature::Four],
        needs: &[],
        bars: &[Feature::Crates],
        build: turn,
    },
    Pattern {
        name: "movement/blade",
        weight: 5,
        roles: &[Role::Blade],
        gives: &[Feature::Four, Feature::Armed, Feature::Strikes],
        needs: &[],
        bars: &[],
        build: blade,
    },
    Pattern {
        name: "movement/shoot",
        weight: 4,
        roles: &[Role::Bolt],
        gives: &[Feature::Four, Feature::Armed, Feature::Strikes],
        needs: &[],
        bars: &[],
        build: shoot,
    },
    Pattern {
        name: "movement/shoot-scarce",
        weight: 2,
        roles: &[Role::Bolt, Role::Ammo],
        gives: &[Feature::Four, Feature::Armed, Feature::Strikes, Feature::Scarce],
        needs: &[],
        bars: &[],
        build: shoot_scarce,
    },
    Pattern {
        name: "movement/shoot-rack",
        weight: 2,
        roles: &[Role::Bolt, Role::Ammo, Role::Rack],
        gives: &[Feature::Four, Feature::Armed, Feature::Strikes, Feature::Errands],
        needs: &[],
        bars: &[],
        build: shoot_rack,
    },
    Pattern {
        name: "movement/blast",
        weight: 4,
        roles: &[Role::Charge, Role::Blast],
        gives: &[Feature::Four, Feature::Armed, Feature::Blasts, Feature::Harm],
        needs: &[Feature::Ruins],
        bars: &[],
        build: blast,
    },
    Pattern {
        name: "movement/flak",
        weight: 4,
        roles: &[Role::Bolt],
        gives: &[Feature::Row, Feature::Armed, Feature::Strikes],
        needs: &[],
        bars: &[],
        build: flak,
    },
    Pattern {
        name: "movement/slide",
        weight: 4,
        roles: &[],
        gives: &[Feature::Row],
        needs: &[],
        bars: &[],
        build: slide,
    },
    Pattern {
        name: "movement/climb",
        weight: 4,
        roles: &[],
        gives: &[Feature::Column],
        needs: &[],
        bars: &[],
        build: climb,
    },
    Pattern {
        name: "movement/drive",
        weight: 3,
        roles: &[],
        gives: &[Feature::Four, Feature::Movers],
        needs: &[],
        bars: &[Feature::Crates, Feature::Followers, Feature::Errands],
        build: drive,
    },
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
    draft.outfit = format!("armed with {}", draft.with_article(blade));
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
    draft.outfit = format!("shooting {}", draft.plural(bolt));
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
    let clause = format!("{} give {} shots each", draft.plural(ammo), super::english::number(value));
    draft.add_fact(clause);
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
    let clause =
        format!("every shot costs {}, to be had at {}", draft.with_article(ammo), draft.with_article(rack));
    draft.add_fact(clause);
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
    draft.outfit = format!("laying {}", draft.plural(charge));
    let clause = format!("every {} goes off to all four sides", draft.spaced_name(charge));
    draft.add_fact(clause);
}

fn flak(draft: &mut Draft, sampler: &mut Sampler) {
    let alone = sampler.ratio(2, 3).then_some(("singleton", Value::Flag(true)));
    let params: Vec<_> = [("orientation", Value::Word("UP"))].into_iter().chain(alone).collect();
    let bolt = draft.spawn(Role::Bolt, SpriteClass::Missile, Body::Shot, &params);
    draft.set_hero(SpriteClass::FlakAvatar, &[("stype", Value::Part(bolt))]);
    draft.weapon = Some(Weapon::Bolt(bolt));
    draft.outfit = format!("shooting {} upwards", draft.plural(bolt));
}

fn slide(draft: &mut Draft, _: &mut Sampler) {
    draft.set_hero(SpriteClass::HorizontalAvatar, &[]);
    let clause = format!("the {} only moves left and right", draft.spaced_name(HERO));
    draft.add_fact(clause);
}

fn climb(draft: &mut Draft, _: &mut Sampler) {
    draft.set_hero(SpriteClass::VerticalAvatar, &[]);
    let clause = format!("the {} only moves up and down", draft.spaced_name(HERO));
    draft.add_fact(clause);
}

/// A vehicle: it can be turned, but not stopped.
fn drive(draft: &mut Draft, sampler: &mut Sampler) {
    draft.set_hero(SpriteClass::OngoingAvatar, &[("cooldown", Value::Count(draw(sampler, 2, 3)))]);
    draft.outfit = "unable to stop".into();
}
