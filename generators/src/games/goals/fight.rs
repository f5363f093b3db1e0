//! Goals of removing things.

use super::{exit, goal};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, HERO, Harm, Part, Phase, Value, Weapon, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal, Pattern};
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
    Goal {
        kind: Kind::Shooter,
        ..hunt("goal/trophies", &[Role::Nest, Role::Wanderer, Role::Trophy, Role::Exit], trophies)
    },
    Goal {
        hero: &[Feature::Row, Feature::Armed],
        threats: (0, 0),
        obstacles: (0, 0),
        ..goal(
            "goal/gallery",
            Kind::Shooter,
            &[Role::Bomber, Role::Drop, Role::Patroller, Role::Cover],
            HUNT,
            gallery,
        )
    },
    Goal {
        hero: &[Feature::Four, Feature::Blasts],
        threats: (1, 2),
        obstacles: (0, 0),
        ..goal("goal/demolish", Kind::Demolition, &[Role::Idol, Role::Soil], &[Feature::Ruins], demolish)
    },
    Goal {
        threats: (0, 1),
        pattern: Pattern {
            bars: &[Feature::Armed, Feature::Wards, Feature::Health],
            ..goal("goal/feast", Kind::Lure, &[Role::Chaser, Role::Bush, Role::Berry], FEAST, feast).pattern
        },
        ..goal("goal/feast", Kind::Lure, &[], &[], feast)
    },
    lure("goal/lure", &[Role::Chaser, Role::Trap], lure_placed),
    lure("goal/lure-all", &[Role::Nest, Role::Chaser, Role::Trap], lure_spawned),
];

const fn hunt(name: &'static str, roles: &'static [Role], build: fn(&mut Draft, &mut Sampler)) -> Goal {
    let goal = goal(name, Kind::Shooter, roles, HUNT, build);
    Goal {
        hero: &[Feature::Four, Feature::Strikes],
        threats: (0, 1),
        pattern: Pattern { bars: &[Feature::Scarce], ..goal.pattern },
        ..goal
    }
}

const fn lure(name: &'static str, roles: &'static [Role], build: fn(&mut Draft, &mut Sampler)) -> Goal {
    let goal = goal(name, Kind::Lure, roles, HUNT, build);
    Goal {
        threats: (0, 1),
        pattern: Pattern { bars: &[Feature::Armed, Feature::Wards], ..goal.pattern },
        ..goal
    }
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
    draft.goal = format!("strike down every {}", draft.spaced_name(foe));
}

fn hunt_both(draft: &mut Draft, sampler: &mut Sampler) {
    let stray =
        draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    let orientation = *sampler.choose(&["RIGHT", "DOWN"]);
    let guard = threats::patroller(draft, Role::Patroller, orientation, draw(sampler, 1, 3));
    quarry(draft, stray, 2);
    quarry(draft, guard, 4);
    draft.win_without(&[stray, guard]);
    draft.goal =
        format!("strike down every {} and every {}", draft.spaced_name(stray), draft.spaced_name(guard));
}

fn hunt_chasers(draft: &mut Draft, sampler: &mut Sampler) {
    let params = threats::pursuing(AVATAR, sampler);
    let foe = draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    quarry(draft, foe, 3);
    draft.win_without(&[foe]);
    draft.goal = format!("strike down every {} that is after you", draft.spaced_name(foe));
}

fn raze_strays(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.spawn(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    raze(draft, sampler, foe);
}

fn raze_chasers(draft: &mut Draft, sampler: &mut Sampler) {
    let params = threats::pursuing(AVATAR, sampler);
    let foe = draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    raze(draft, sampler, foe);
}

/// Foes keep spawning until their nests are destroyed.
fn raze(draft: &mut Draft, sampler: &mut Sampler, foe: Part) {
    let nest = threats::nest(draft, sampler, foe, 0);
    draft.harm(foe, Harm::Spent);
    draft.prey(foe, 1);
    draft.prey(nest, 5);
    draft.win_without(&[nest]);
    draft.goal = format!("destroy every {}", draft.spaced_name(nest));
    let clause = format!("{} keep coming out of them", draft.plural(foe));
    draft.add_fact(clause);
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
    draft.goal = format!(
        "win {} {} from {} and show them at the {}",
        english::number(price),
        draft.plural(trophy),
        draft.plural(foe),
        draft.spaced_name(exit)
    );
    let clause = format!("{} come out of every {}", draft.plural(foe), draft.spaced_name(nest));
    draft.add_fact(clause);
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
    let clause = format!("{} drop {}", draft.plural(bomber), draft.plural(drop));
    draft.add_fact(clause);
    if sampler.ratio(1, 2) {
        let cover = draft.place(Role::Cover, SpriteClass::Immovable, Body::Solid, &[]);
        draft.mark_handled(drop, cover);
        draft.rule(Phase::Strike, cover, &[drop], Effect::KillBoth);
        if let Some(Weapon::Bolt(_)) = draft.weapon {
            draft.prey(cover, 0);
        }
        let clause = format!("every {} stops one", draft.spaced_name(cover));
        draft.add_fact(clause);
    }
    draft.win_without(&targets);
    let names: Vec<String> =
        targets.iter().map(|&target| format!("every {}", draft.spaced_name(target))).collect();
    draft.goal = format!("bring down {}", english::series(&names));
}

fn demolish(draft: &mut Draft, sampler: &mut Sampler) {
    let idol = draft.place(Role::Idol, SpriteClass::Immovable, Body::Solid, &[]);
    draft.prey(idol, 5);
    if sampler.ratio(2, 3) {
        let soil = draft.place(Role::Soil, SpriteClass::Immovable, Body::Solid, &[]);
        draft.prey(soil, 0);
        let clause = format!("{} is blown away too", draft.spaced_name(soil));
        draft.add_fact(clause);
    }
    draft.win_without(&[idol]);
    draft.goal = format!("blow up every {}", draft.spaced_name(idol));
}

fn lure_placed(draft: &mut Draft, sampler: &mut Sampler) {
    let params = threats::pursuing(AVATAR, sampler);
    let foe = draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    lure_into(draft, foe, &[foe]);
}

/// Nests spawn a few more.
fn lure_spawned(draft: &mut Draft, sampler: &mut Sampler) {
    let params = threats::pursuing(AVATAR, sampler);
    let foe = draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    let total = draw(sampler, 2, 3);
    let nest = threats::nest(draft, sampler, foe, total);
    lure_into(draft, foe, &[nest, foe]);
    let clause = format!("{} of them come out of every {}", english::number(total), draft.spaced_name(nest));
    draft.add_fact(clause);
}

/// The hero is unarmed and can only lure them.
fn lure_into(draft: &mut Draft, foe: Part, all: &[Part]) {
    let trap = draft.place(Role::Trap, SpriteClass::Immovable, Body::Flat, &[]);
    draft.scored(Phase::Strike, foe, &[trap], Effect::KillSprite, 4);
    draft.harm(foe, Harm::Lasting);
    draft.harm(trap, Harm::Lasting);
    draft.win_without(all);
    draft.goal = format!("lead every {} into {}", draft.spaced_name(foe), draft.with_article(trap));
    let clause = format!("{} give chase, and {} harm all alike", draft.plural(foe), draft.plural(trap));
    draft.add_fact(clause);
}

/// One berry gives strength for one catch: until then the hero is the prey.
fn feast(draft: &mut Draft, sampler: &mut Sampler) {
    let params = threats::pursuing(AVATAR, sampler);
    let foe = draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
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
    draft.rule(Phase::Harm, bold, &[foe], Effect::TransformTo { stype: HERO, kill_second: false });
    draft.lose_without(AVATAR);
    draft.win_without(&[foe]);
    draft.goal = format!(
        "eat {} from the {} and catch one {} with each, until none is left",
        draft.plural(berry),
        draft.spaced_name(bush),
        draft.spaced_name(foe)
    );
    let clause = format!("{} give chase, and whoever has not eaten is their prey", draft.plural(foe));
    draft.add_fact(clause);
}
