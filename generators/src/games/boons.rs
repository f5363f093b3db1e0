//! Boons: patterns that help the hero.

use super::body::Body;
use super::draft::{AVATAR, Draft, Phase, Stamina, Value, draw};
use super::effect::Effect;
use super::pattern::{Feature, Pattern};
use super::role::Role;
use engine::{Sampler, SpriteClass};

/// All boons.
pub(crate) const BOONS: &[Pattern] = &[
    Pattern {
        name: "boon/hearts",
        weight: 4,
        roles: &[Role::Medicine],
        gives: &[Feature::Health],
        needs: &[Feature::Harm, Feature::Four],
        bars: &[Feature::Health],
        build: hearts,
    },
    Pattern {
        name: "boon/ward",
        weight: 3,
        roles: &[Role::Ward],
        gives: &[Feature::Wards, Feature::Health],
        needs: &[Feature::Harm, Feature::Four],
        bars: &[Feature::Precious, Feature::Health, Feature::Stains],
        build: ward,
    },
    Pattern {
        name: "boon/shop",
        weight: 4,
        roles: &[Role::Coin, Role::Forge, Role::Medicine],
        gives: &[Feature::Health],
        needs: &[Feature::Harm, Feature::Four],
        bars: &[Feature::Health],
        build: shop,
    },
    Pattern {
        name: "boon/press",
        weight: 3,
        roles: &[Role::Crate, Role::Plate, Role::Charm],
        gives: &[Feature::Crates],
        needs: &[Feature::Four],
        bars: &[],
        build: press,
    },
    Pattern {
        name: "boon/coins",
        weight: 3,
        roles: &[Role::Coin],
        gives: &[],
        needs: &[Feature::Four],
        bars: &[],
        build: coins,
    },
    Pattern {
        name: "boon/bush",
        weight: 2,
        roles: &[Role::Bush, Role::Berry],
        gives: &[],
        needs: &[Feature::Four, Feature::Movers],
        bars: &[],
        build: bush,
    },
];

fn hearts(draft: &mut Draft, sampler: &mut Sampler) {
    let health = draw(sampler, 2, 4);
    draft.stamina = Stamina::Hearts(health);
    draft.give(AVATAR, "healthPoints", Value::Count(health));
    draft.give(AVATAR, "limitHealthPoints", Value::Count(health + 2));
    let medicine = draft.place(Role::Medicine, SpriteClass::Immovable, Body::Item, &[]);
    let heal = Effect::AddHealthPointsToMax { value: draw(sampler, 1, 2) };
    draft.scored(Phase::Take, AVATAR, &[medicine], heal, 1);
    let clause = format!(
        "{} wounds are the end, but {} heals",
        super::english::number(health),
        draft.spaced_name(medicine)
    );
    draft.add_fact(clause);
}

/// Coins buy medicine, which heals wounds.
fn shop(draft: &mut Draft, sampler: &mut Sampler) {
    let health = draw(sampler, 2, 3);
    let price = draw(sampler, 1, 2);
    draft.stamina = Stamina::Hearts(health);
    draft.give(AVATAR, "healthPoints", Value::Count(health));
    draft.give(AVATAR, "limitHealthPoints", Value::Count(health + 2));
    let coin = draft.place(Role::Coin, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(4))]);
    let shop = draft.place(Role::Forge, SpriteClass::Immovable, Body::Spot, &[]);
    let medicine = draft.spawn(Role::Medicine, SpriteClass::Immovable, Body::Item, &[]);
    draft.scored(Phase::Take, coin, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let buy = Effect::SpawnIfHasMore { resource: coin, limit: price, stype: medicine };
    draft.rule(Phase::Take, AVATAR, &[shop], buy);
    draft.scored(Phase::Take, AVATAR, &[medicine], Effect::AddHealthPointsToMax { value: 1 }, 1);
    let wounds = super::english::number(health);
    let cost = if price == 1 { draft.with_article(coin) } else { format!("two {}", draft.plural(coin)) };
    let clause = format!(
        "{wounds} wounds are the end, but the {} gives {} for {cost}, which heals",
        draft.spaced_name(shop),
        draft.spaced_name(medicine)
    );
    draft.add_fact(clause);
}

fn ward(draft: &mut Draft, _: &mut Sampler) {
    let ward = draft.place(Role::Ward, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(2))]);
    draft.stamina = Stamina::Warded(ward);
    draft.scored(Phase::Take, ward, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let clause = format!("{} protects once", draft.with_article(ward));
    draft.add_fact(clause);
}

/// An optional task with a reward.
fn press(draft: &mut Draft, sampler: &mut Sampler) {
    let block = draft.place(Role::Crate, SpriteClass::Passive, Body::Crate, &[]);
    let plate = draft.place(Role::Plate, SpriteClass::Immovable, Body::Flat, &[]);
    let charm = draft.spawn(Role::Charm, SpriteClass::Immovable, Body::Item, &[]);
    draft.rule(Phase::Push, block, &[AVATAR], Effect::BounceForward);
    let press = Effect::TransformTo { stype: charm, kill_second: true };
    draft.scored(Phase::Meet, plate, &[block], press, 1);
    draft.scored(Phase::Take, charm, &[AVATAR], Effect::KillSprite, draw(sampler, 3, 5) as i32);
    let clause = format!(
        "whoever pushes {} onto {} is rewarded with {}",
        draft.with_article(block),
        draft.with_article(plate),
        draft.with_article(charm)
    );
    draft.add_fact(clause);
}

fn coins(draft: &mut Draft, _: &mut Sampler) {
    let coin = draft.place(Role::Coin, SpriteClass::Immovable, Body::Item, &[]);
    draft.scored(Phase::Take, coin, &[AVATAR], Effect::KillSprite, 1);
    let clause = format!("{} are worth a point each", draft.plural(coin));
    draft.add_points_clause(clause);
}

/// Berries ripen at the bushes, one at a time.
pub(crate) fn bush(draft: &mut Draft, sampler: &mut Sampler) {
    let berry =
        draft.spawn(Role::Berry, SpriteClass::Immovable, Body::Item, &[("singleton", Value::Flag(true))]);
    let params = [
        ("stype", Value::Part(berry)),
        ("cooldown", Value::Count(draw(sampler, 5, 12))),
        ("prob", Value::Hundredths(10 * draw(sampler, 3, 6))),
    ];
    let bush = draft.place(Role::Bush, SpriteClass::SpawnPoint, Body::Spot, &params);
    draft.scored(Phase::Take, berry, &[AVATAR], Effect::KillSprite, 1);
    let clause =
        format!("{} to be had at {} are worth a point each", draft.plural(berry), draft.plural(bush));
    draft.add_points_clause(clause);
}
