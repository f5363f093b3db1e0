//! Goals of opening locked things.

use super::{exit, goal};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, HERO, Harm, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Build, Feature, Goal, Pattern, Roles};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

const WARDEN: &[Feature] =
    &[Feature::States, Feature::Movers, Feature::Harm, Feature::Prey, Feature::Precious];

pub(super) const GOALS: &[Goal] = &[
    goal("goal/key", Kind::KeyAndDoor, &[Role::Key, Role::Exit], &[Feature::States], key),
    warden("goal/stray-warden", &[Role::Key, Role::Exit, Role::Wanderer], stray_warden),
    warden("goal/keen-warden", &[Role::Key, Role::Exit, Role::Chaser], keen_warden),
    goal("goal/chests", Kind::KeyAndDoor, &[Role::Key, Role::Chest], &[], chests),
];

const fn warden(name: &'static str, roles: Roles, build: Build) -> Goal {
    let goal = goal(name, Kind::KeyAndDoor, roles, WARDEN, build)
        .hero(&[Feature::Four, Feature::Strikes])
        .threats(0, 1)
        .bars(&[Feature::Scarce]);
    Goal { pattern: Pattern { weight: 2, ..goal.pattern }, ..goal }
}

/// Adds an exit that only the hero with the key can take.
fn locked_exit(draft: &mut Draft, key: Part) -> Part {
    let exit = exit(draft, Body::Spot);
    let holder = draft.hero_state("keyed");
    draft.scored(Phase::Take, HERO, &[key], Effect::TransformTo { stype: holder, kill_second: true }, 3);
    draft.rule(Phase::Block, HERO, &[exit], Effect::StepBack);
    draft.scored(Phase::Arrive, exit, &[holder], Effect::KillSprite, 10);
    draft.win_without(&[exit]);
    exit
}

fn key(draft: &mut Draft, _: &mut Sampler) {
    let key = draft.place(Role::Key, SpriteClass::Immovable, Body::Item, &[]);
    let exit = locked_exit(draft, key);
    draft.goal = draft.phrase("find the <name> and bring it to the <name>", &[key, exit]);
}

fn stray_warden(draft: &mut Draft, sampler: &mut Sampler) {
    let warden =
        draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    robbed(draft, warden);
}

fn keen_warden(draft: &mut Draft, sampler: &mut Sampler) {
    let warden =
        draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &threats::pursuing(AVATAR, sampler));
    robbed(draft, warden);
}

/// The warden drops the key when it is killed.
fn robbed(draft: &mut Draft, warden: Part) {
    let key = draft.spawn(Role::Key, SpriteClass::Immovable, Body::Item, &[]);
    draft.prey_leaves(warden, key, 3);
    draft.harm(warden, Harm::Lasting);
    let exit = locked_exit(draft, key);
    draft.goal =
        draft.phrase("strike down <a name> for its <name>, which opens the <name>", &[warden, key, exit]);
}

/// One key opens all chests, or each chest requires several.
fn chests(draft: &mut Draft, sampler: &mut Sampler) {
    let keys = draw(sampler, 1, 3);
    let key = draft.place(Role::Key, SpriteClass::Resource, Body::Item, &[("limit", Value::Count(keys + 1))]);
    let chest = draft.place(Role::Chest, SpriteClass::Door, Body::Solid, &[]);
    draft.scored(Phase::Take, key, &[AVATAR], Effect::CollectResource { stays: false }, 1);
    let open = Effect::KillIfOtherHasMore { resource: key, limit: keys, subtract: false };
    draft.scored(Phase::Open, chest, &[AVATAR], open, 4);
    draft.win_without(&[chest]);
    draft.goal = match keys {
        1 => draft.phrase("open every <name> with <a name>", &[chest, key]),
        _ => {
            let text = format!("find {} <names> and open every <name>", english::number(keys));
            draft.phrase(&text, &[key, chest])
        }
    };
}
