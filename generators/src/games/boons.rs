//! Boons: patterns that help the hero.

use super::body::Body;
use super::draft::{AVATAR, Draft, Phase, Stamina, Value, draw};
use super::effect::Effect;
use super::obstacles;
use super::pattern::{Feature, Pattern, pattern};
use super::role::Role;
use super::threats;
use engine::{Sampler, SpriteClass};

pub(crate) const BOONS: &[Pattern] = &[
    pattern("boon/hearts", 4, &[Role::Medicine], &[Feature::Health], hearts)
        .needs(&[Feature::Harm, Feature::Four])
        .bars(&[Feature::Health]),
    pattern("boon/ward", 3, &[Role::Ward], &[Feature::Wards, Feature::Health], ward)
        .needs(&[Feature::Harm, Feature::Four])
        .bars(&[Feature::Precious, Feature::Health, Feature::Stains]),
    pattern("boon/shop", 4, &[Role::Coin, Role::Forge, Role::Medicine], &[Feature::Health], shop)
        .needs(&[Feature::Harm, Feature::Four])
        .bars(&[Feature::Health]),
    pattern("boon/press", 3, &[Role::Crate, Role::Plate, Role::Charm], &[Feature::Crates], press)
        .needs(&[Feature::Four]),
    pattern("boon/coins", 3, &[Role::Coin], &[], coins).needs(&[Feature::Four]),
    pattern("boon/bush", 2, &[Role::Bush, Role::Berry], &[], bush).needs(&[Feature::Four, Feature::Movers]),
];

fn hearts(draft: &mut Draft, sampler: &mut Sampler) {
    let health = draw(sampler, 2, 4);
    draft.hearts(health, health + 2);
    let medicine = draft.place(Role::Medicine, SpriteClass::Immovable, Body::Item, &[]);
    let heal = Effect::AddHealthPointsToMax { value: draw(sampler, 1, 2) };
    draft.scored(Phase::Take, AVATAR, &[medicine], heal, 1);
    draft.add_fact(
        &format!("{} wounds are the end, but <name> heals", super::english::number(health)),
        &[medicine],
    );
}

/// Coins buy medicine, which heals wounds.
fn shop(draft: &mut Draft, sampler: &mut Sampler) {
    let health = draw(sampler, 2, 3);
    let price = draw(sampler, 1, 2);
    draft.hearts(health, health + 2);
    let coin = draft.place(Role::Coin, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(4))]);
    let shop = draft.place(Role::Forge, SpriteClass::Immovable, Body::Spot, &[]);
    let medicine = draft.spawn(Role::Medicine, SpriteClass::Immovable, Body::Item, &[]);
    draft.scored(Phase::Take, coin, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let buy = Effect::SpawnIfHasMore { resource: coin, limit: price, stype: medicine };
    draft.rule(Phase::Take, AVATAR, &[shop], buy);
    draft.scored(Phase::Take, AVATAR, &[medicine], Effect::AddHealthPointsToMax { value: 1 }, 1);
    let wounds = super::english::number(health);
    let cost = if price == 1 { draft.with_article(coin) } else { format!("two {}", draft.plural(coin)) };
    draft.add_fact(
        &format!("{wounds} wounds are the end, but the <name> gives <name> for {cost}, which heals"),
        &[shop, medicine],
    );
}

fn ward(draft: &mut Draft, _: &mut Sampler) {
    let ward = draft.place(Role::Ward, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(2))]);
    draft.stamina = Stamina::Warded(ward);
    draft.scored(Phase::Take, ward, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    draft.add_fact("<a name> protects once", &[ward]);
}

/// An optional task with a reward.
fn press(draft: &mut Draft, sampler: &mut Sampler) {
    let block = obstacles::pushable(draft);
    let plate = draft.place(Role::Plate, SpriteClass::Immovable, Body::Flat, &[]);
    let charm = draft.spawn(Role::Charm, SpriteClass::Immovable, Body::Item, &[]);
    let press = Effect::TransformTo { stype: charm, kill_second: true };
    draft.scored(Phase::Meet, plate, &[block], press, 1);
    draft.scored(Phase::Take, charm, &[AVATAR], Effect::KillSprite, draw(sampler, 3, 5) as i32);
    draft.add_fact("whoever pushes <a name> onto <a name> is rewarded with <a name>", &[block, plate, charm]);
}

fn coins(draft: &mut Draft, _: &mut Sampler) {
    let coin = draft.place(Role::Coin, SpriteClass::Immovable, Body::Item, &[]);
    draft.scored(Phase::Take, coin, &[AVATAR], Effect::KillSprite, 1);
    draft.add_points_clause("<names> are worth a point each", &[coin]);
}

/// Berries ripen at the bushes, one at a time.
pub(crate) fn bush(draft: &mut Draft, sampler: &mut Sampler) {
    let berry =
        draft.spawn(Role::Berry, SpriteClass::Immovable, Body::Item, &[("singleton", Value::Flag(true))]);
    let params = threats::spawning(berry, draw(sampler, 5, 12), draw(sampler, 3, 6));
    let bush = draft.place(Role::Bush, SpriteClass::SpawnPoint, Body::Spot, &params);
    draft.scored(Phase::Take, berry, &[AVATAR], Effect::KillSprite, 1);
    draft.add_points_clause("<names> to be had at <names> are worth a point each", &[berry, bush]);
}
