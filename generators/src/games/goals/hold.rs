//! Goals of surviving and defending.

use super::goal;
use crate::games::body::Body;
use crate::games::boons;
use crate::games::draft::{AVATAR, Draft, Ending, Harm, Part, Phase, Value, WALL, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

const SIEGE: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::Prey];
/// The same, with the hero's health determined.
const STORM: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::Prey, Feature::Health];

pub(super) const GOALS: &[Goal] = &[
    goal(
        "goal/survive",
        Kind::Survival,
        &[Role::Nest, Role::Chaser, Role::Bush, Role::Berry],
        SIEGE,
        survive,
    )
    .ticks(6, 10)
    .obstacles(0, 1),
    goal("goal/dodge", Kind::Survival, &[Role::Bomber, Role::Drop, Role::Tree, Role::Fruit], STORM, dodge)
        .hero(&[Feature::Row])
        .ticks(8, 12)
        .threats(0, 0)
        .obstacles(0, 0)
        .bars(&[Feature::Armed]),
    goal(
        "goal/defend",
        Kind::Defence,
        &[Role::Crop, Role::Pest, Role::Nest],
        &[Feature::Movers, Feature::Prey],
        defend,
    )
    .hero(&[Feature::Four, Feature::Strikes])
    .threats(0, 1),
    goal("goal/catch-falling", Kind::Catching, &[Role::Tree, Role::Fruit], &[Feature::Movers], catch)
        .hero(&[Feature::Row])
        .threats(0, 1)
        .obstacles(0, 0)
        .bars(&[Feature::Armed]),
    goal(
        "goal/headwind",
        Kind::Survival,
        &[Role::Bomber, Role::Drop, Role::Tree, Role::Fruit],
        STORM,
        headwind,
    )
    .hero(&[Feature::Column])
    .ticks(8, 12)
    .threats(0, 0)
    .obstacles(0, 0),
    goal("goal/waves", Kind::Defence, &[Role::Tree, Role::Pest], &[Feature::Movers, Feature::Prey], waves)
        .hero(&[Feature::Row, Feature::Armed])
        .threats(0, 1)
        .obstacles(0, 0),
];

fn survive(draft: &mut Draft, sampler: &mut Sampler) {
    let foe =
        draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    let nest = threats::nest(draft, sampler, foe, 0);
    draft.harm(foe, Harm::Spent);
    draft.prey(foe, 2);
    boons::bush(draft, sampler);
    outlast(draft);
    draft.add_fact("<names> come out of every <name> and give chase", &[foe, nest]);
}

/// Makes reaching the time limit a win: the limit itself is set later.
fn outlast(draft: &mut Draft) {
    draft.endings.push((Ending::Timeout(0), true));
    draft.goal = "stay alive until time is up".into();
}

/// Some of the falling things are good.
fn dodge(draft: &mut Draft, sampler: &mut Sampler) {
    let thrown = threats::bombers(draft, sampler);
    windfalls(draft, sampler, thrown, "DOWN");
}

/// The same from the side.
fn headwind(draft: &mut Draft, sampler: &mut Sampler) {
    let thrown = threats::throwers(draft, sampler, ["UP", "DOWN"], "LEFT");
    windfalls(draft, sampler, thrown, "LEFT");
}

/// Good things come from the same direction as the harmful ones, and reaching the time limit is a win.
fn windfalls(draft: &mut Draft, sampler: &mut Sampler, (bomber, drop): (Part, Part), way: &'static str) {
    let params = [("orientation", Value::Word(way)), ("cooldown", Value::Count(2))];
    let fruit = draft.spawn(Role::Fruit, SpriteClass::Missile, Body::FoeShot, &params);
    let params = threats::spawning(fruit, draw(sampler, 8, 16), draw(sampler, 4, 8));
    let tree = draft.place(Role::Tree, SpriteClass::SpawnPoint, Body::Flat, &params);
    let health = draw(sampler, 1, 2);
    draft.hearts(health, health + 1);
    draft.scored(Phase::Take, AVATAR, &[fruit], Effect::AddHealthPointsToMax { value: 1 }, 2);
    outlast(draft);
    let verb = if way == "DOWN" { "drop" } else { "throw" };
    let wounds =
        if health == 1 { "one wound is".into() } else { format!("{} wounds are", english::number(health)) };
    draft.add_fact(
        &format!("<names> {verb} <names>, and {wounds} the end, but <names> from the <name> heal"),
        &[bomber, drop, fruit, tree],
    );
}

/// Pests must be shot before they land.
fn waves(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("orientation", Value::Word("DOWN")), ("cooldown", Value::Count(draw(sampler, 2, 4)))];
    let pest = draft.spawn(Role::Pest, SpriteClass::Missile, Body::FoeShot, &params);
    let landed = draft.state(pest, "landed", SpriteClass::Immovable, Body::Flat, &[]);
    let total = draw(sampler, 2, 4);
    let source = threats::spawning(pest, draw(sampler, 10, 24), draw(sampler, 4, 8));
    let params = [&source[..], &[("total", Value::Count(total))]].concat();
    let tree = draft.place(Role::Tree, SpriteClass::SpawnPoint, Body::Flat, &params);
    let limit = draw(sampler, 2, 4);
    draft.prey(pest, 2);
    draft.mark_handled(pest, WALL);
    draft.scored(Phase::Strike, pest, &[WALL], Effect::becomes(landed), -1);
    draft.lose_with(landed, limit);
    draft.win_without(&[tree, pest]);
    draft.goal = draft.phrase(
        &format!(
            "shoot down the <names> that come from every <name>: {} that land are too many",
            english::number(limit)
        ),
        &[pest, tree],
    );
    draft.add_fact(&format!("{} of them come from each", english::number(total)), &[]);
}

fn defend(draft: &mut Draft, sampler: &mut Sampler) {
    let crop = draft.place(Role::Crop, SpriteClass::Immovable, Body::Spot, &[]);
    let params = [("stype", Value::Part(crop)), ("cooldown", Value::Count(draw(sampler, 3, 4)))];
    let pest = draft.spawn(Role::Pest, SpriteClass::Chaser, Body::Walker, &params);
    let total = draw(sampler, 3, 6);
    let nest = threats::nest(draft, sampler, pest, total);
    draft.scored(Phase::Meet, crop, &[pest], Effect::KillSprite, -2);
    draft.prey(pest, 2);
    draft.lose_without(crop);
    draft.win_without(&[nest, pest]);
    draft.goal = draft.phrase(
        &format!(
            "beat off all {} <names> that come out of every <name> before the last <name> is gone",
            english::number(total)
        ),
        &[pest, nest, crop],
    );
}

fn catch(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("orientation", Value::Word("DOWN")), ("cooldown", Value::Count(draw(sampler, 2, 3)))];
    let fruit = draft.spawn(Role::Fruit, SpriteClass::Missile, Body::FoeShot, &params);
    let fallen = draft.state(fruit, "fallen", SpriteClass::Immovable, Body::Flat, &[]);
    let total = draw(sampler, 2, 4);
    let source = threats::spawning(fruit, draw(sampler, 12, 24), draw(sampler, 4, 8));
    let params = [&source[..], &[("total", Value::Count(total))]].concat();
    let tree = draft.place(Role::Tree, SpriteClass::SpawnPoint, Body::Flat, &params);
    let limit = draw(sampler, 2, 4);
    draft.mark_handled(fruit, WALL);
    draft.scored(Phase::Take, fruit, &[AVATAR], Effect::KillSprite, 2);
    draft.scored(Phase::Strike, fruit, &[WALL], Effect::becomes(fallen), -1);
    draft.lose_with(fallen, limit);
    draft.win_without(&[tree, fruit]);
    draft.goal = draft.phrase(
        &format!(
            "catch what falls from every <name>: {} <names> on the ground are too many",
            english::number(limit)
        ),
        &[tree, fallen],
    );
}
