//! Goals of removing things.

use super::{exit, goal};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, HERO, Harm, Part, Phase, Value, Weapon, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Build, Feature, Goal, Roles};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

const HUNT: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::Prey];

const FEAST: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::States, Feature::Errands];

pub(super) const GOALS: &[Goal] = &[
    hunt("goal/hunt-strays", &[Role::Wanderer], hunt_strays),
    hunt("goal/hunt-both", &[Role::Wanderer, Role::Patroller], hunt_both),
    hunt("goal/hunt-chasers", &[Role::Chaser], hunt_chasers),
    hunt("goal/raze-strays", &[Role::Nest, Role::Wanderer], raze_strays),
    hunt("goal/raze-chasers", &[Role::Nest, Role::Chaser], raze_chasers),
    hunt("goal/trophies", &[Role::Nest, Role::Wanderer, Role::Trophy, Role::Exit], trophies),
    goal(
        "goal/gallery",
        Kind::Shooter,
        &[Role::Bomber, Role::Drop, Role::Patroller, Role::Cover],
        HUNT,
        gallery,
    )
    .hero(&[Feature::Row, Feature::Armed])
    .threats(0, 0)
    .obstacles(0, 0),
    goal("goal/demolish", Kind::Demolition, &[Role::Idol, Role::Soil], &[Feature::Ruins], demolish)
        .hero(&[Feature::Four, Feature::Blasts])
        .obstacles(0, 0),
    goal("goal/feast", Kind::Lure, &[Role::Chaser, Role::Bush, Role::Berry], FEAST, feast)
        .threats(0, 1)
        .bars(&[Feature::Armed, Feature::Wards, Feature::Health]),
    lure("goal/lure", &[Role::Chaser, Role::Trap], lure_placed),
    lure("goal/lure-all", &[Role::Nest, Role::Chaser, Role::Trap], lure_spawned),
];

const fn hunt(name: &'static str, roles: Roles, build: Build) -> Goal {
    goal(name, Kind::Shooter, roles, HUNT, build)
        .hero(&[Feature::Four, Feature::Strikes])
        .threats(0, 1)
        .bars(&[Feature::Scarce])
}

const fn lure(name: &'static str, roles: Roles, build: Build) -> Goal {
    goal(name, Kind::Lure, roles, HUNT, build).threats(0, 1).bars(&[Feature::Armed, Feature::Wards])
}

/// Foes to be hunted: they harm the hero by touch, and survive it.
fn quarry(draft: &mut Draft, foe: Part, score: i32) {
    draft.harm(foe, Harm::Lasting);
    draft.prey(foe, score);
}

fn hunt_strays(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    quarry(draft, foe, 3);
    draft.win_without(&[foe]);
    draft.goal = draft.phrase("strike down every <name>", &[foe]);
}

fn hunt_both(draft: &mut Draft, sampler: &mut Sampler) {
    let stray =
        draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    let orientation = *sampler.choose(&["RIGHT", "DOWN"]);
    let guard = threats::patroller(draft, Role::Patroller, orientation, draw(sampler, 1, 3));
    quarry(draft, stray, 2);
    quarry(draft, guard, 4);
    draft.win_without(&[stray, guard]);
    draft.goal = draft.phrase("strike down every <name> and every <name>", &[stray, guard]);
}

fn hunt_chasers(draft: &mut Draft, sampler: &mut Sampler) {
    let foe =
        draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    quarry(draft, foe, 3);
    draft.win_without(&[foe]);
    draft.goal = draft.phrase("strike down every <name> that is after you", &[foe]);
}

fn raze_strays(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.spawn(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    raze(draft, sampler, foe);
}

fn raze_chasers(draft: &mut Draft, sampler: &mut Sampler) {
    let foe =
        draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    raze(draft, sampler, foe);
}

/// Foes keep spawning until their nests are destroyed.
fn raze(draft: &mut Draft, sampler: &mut Sampler, foe: Part) {
    let nest = threats::nest(draft, sampler, foe, 0);
    draft.harm(foe, Harm::Spent);
    draft.prey(foe, 1);
    draft.prey(nest, 5);
    draft.win_without(&[nest]);
    draft.goal = draft.phrase("destroy every <name>", &[nest]);
    draft.add_fact("<names> keep coming out of them", &[foe]);
}

fn trophies(draft: &mut Draft, sampler: &mut Sampler) {
    let price = draw(sampler, 2, 4);
    let foe = draft.spawn(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    let nest = threats::nest(draft, sampler, foe, 0);
    let params = [("limit", Value::Count(price + 2))];
    let trophy = draft.spawn(Role::Trophy, SpriteClass::Resource, Body::Item, &params);
    let exit = exit(draft, Body::Solid);
    draft.harm(foe, Harm::Spent);
    draft.prey_leaves(foe, trophy, 1);
    draft.scored(Phase::Take, trophy, &[AVATAR], Effect::CollectResource { stays: false }, 2);
    let open = Effect::KillIfOtherHasMore { resource: trophy, limit: price, subtract: false };
    draft.scored(Phase::Open, exit, &[AVATAR], open, 10);
    draft.win_without(&[exit]);
    draft.goal = draft.phrase(
        &format!("win {} <names> from <names> and show them at the <name>", english::number(price)),
        &[trophy, foe, exit],
    );
    draft.add_fact("<names> come out of every <name>", &[foe, nest]);
}

/// Targets above, some of which drop things; sometimes with cover below.
fn gallery(draft: &mut Draft, sampler: &mut Sampler) {
    let (bomber, drop) = threats::bombers(draft, sampler);
    draft.prey(bomber, 2);
    let mut targets = vec![bomber];
    if sampler.ratio(1, 2) {
        let orientation = *sampler.choose(&["LEFT", "RIGHT"]);
        let scout = threats::patroller(draft, Role::Patroller, orientation, draw(sampler, 1, 2));
        draft.prey(scout, 4);
        targets.push(scout);
    }
    draft.add_fact("<names> drop <names>", &[bomber, drop]);
    if sampler.ratio(1, 2) {
        let cover = draft.place(Role::Cover, SpriteClass::Immovable, Body::Solid, &[]);
        draft.mark_handled(drop, cover);
        draft.rule(Phase::Strike, cover, &[drop], Effect::KillBoth);
        if let Some(Weapon::Bolt(_)) = draft.weapon {
            draft.prey(cover, 0);
        }
        draft.add_fact("every <name> stops one", &[cover]);
    }
    draft.win_without(&targets);
    let names: Vec<String> =
        targets.iter().map(|&target| format!("every {}", draft.spaced_name(target))).collect();
    draft.goal = draft.phrase(&format!("bring down {}", english::series(&names)), &[]);
}

fn demolish(draft: &mut Draft, sampler: &mut Sampler) {
    let idol = draft.place(Role::Idol, SpriteClass::Immovable, Body::Solid, &[]);
    draft.prey(idol, 5);
    if sampler.ratio(2, 3) {
        let soil = draft.place(Role::Soil, SpriteClass::Immovable, Body::Solid, &[]);
        draft.prey(soil, 0);
        draft.add_fact("<name> is blown away too", &[soil]);
    }
    draft.win_without(&[idol]);
    draft.goal = draft.phrase("blow up every <name>", &[idol]);
}

fn lure_placed(draft: &mut Draft, sampler: &mut Sampler) {
    let foe =
        draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    lure_into(draft, foe, &[foe]);
}

/// Nests spawn a few more.
fn lure_spawned(draft: &mut Draft, sampler: &mut Sampler) {
    let foe =
        draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    let total = draw(sampler, 2, 3);
    let nest = threats::nest(draft, sampler, foe, total);
    lure_into(draft, foe, &[nest, foe]);
    draft.add_fact(&format!("{} of them come out of every <name>", english::number(total)), &[nest]);
}

/// The hero is unarmed and can only lure them.
fn lure_into(draft: &mut Draft, foe: Part, all: &[Part]) {
    let trap = draft.place(Role::Trap, SpriteClass::Immovable, Body::Flat, &[]);
    draft.scored(Phase::Strike, foe, &[trap], Effect::KillSprite, 4);
    draft.harm(foe, Harm::Lasting);
    draft.harm(trap, Harm::Lasting);
    draft.win_without(all);
    draft.goal = draft.phrase("lead every <name> into <a name>", &[foe, trap]);
    draft.add_fact("<names> give chase, and <names> harm all alike", &[foe, trap]);
}

/// One berry gives strength for one catch: until then the hero is the prey.
fn feast(draft: &mut Draft, sampler: &mut Sampler) {
    let foe =
        draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    let berry =
        draft.spawn(Role::Berry, SpriteClass::Immovable, Body::Item, &[("singleton", Value::Flag(true))]);
    let params = [("stype", Value::Part(berry)), ("cooldown", Value::Count(draw(sampler, 6, 12)))];
    let bush = draft.place(Role::Bush, SpriteClass::SpawnPoint, Body::Spot, &params);
    let bold = draft.hero_state("bold");
    let strengthen = Effect::TransformTo { stype: bold, kill_second: true };
    draft.scored(Phase::Take, HERO, &[berry], strengthen, 1);
    draft.scored(Phase::Strike, foe, &[bold], Effect::KillSprite, 4);
    // In this order: a hero that has just made a catch is not harmed by it.
    draft.scored(Phase::Harm, HERO, &[foe], Effect::KillSprite, -2);
    draft.rule(Phase::Harm, bold, &[foe], Effect::becomes(HERO));
    draft.lose_without(AVATAR);
    draft.win_without(&[foe]);
    draft.goal = draft.phrase(
        "eat <names> from the <name> and catch one <name> with each, until none is left",
        &[berry, bush, foe],
    );
    draft.add_fact("<names> give chase, and whoever has not eaten is their prey", &[foe]);
}
