//! Goals of getting friends to safety.

use super::goal;
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Build, Feature, Features, Goal, Pattern, Roles};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

const FOLLOWED: &[Feature] = &[Feature::Movers, Feature::Followers];
const HUNTED: &[Feature] = &[Feature::Movers, Feature::Followers, Feature::Prey];

pub(super) const GOALS: &[Goal] = &[
    friends("goal/catch", Kind::Rescue, &[Role::Friend], FOLLOWED, catch),
    friends("goal/catch-first", Kind::Rescue, &[Role::Friend, Role::Chaser], HUNTED, catch_first)
        .threats(0, 1),
    friends("goal/escort", Kind::Rescue, &[Role::Friend, Role::Haven], FOLLOWED, escort),
    friends(
        "goal/escort-hunted",
        Kind::Rescue,
        &[Role::Friend, Role::Haven, Role::Chaser],
        HUNTED,
        escort_hunted,
    )
    .threats(0, 1),
    friends("goal/herd", Kind::Herding, &[Role::Friend, Role::Haven], FOLLOWED, herd).threats(0, 1),
    friends(
        "goal/herd-hunted",
        Kind::Herding,
        &[Role::Friend, Role::Haven, Role::Chaser],
        HUNTED,
        herd_hunted,
    )
    .threats(0, 1),
    friends("goal/wake", Kind::Rescue, &[Role::Friend, Role::Snuffer], FOLLOWED, wake).threats(0, 1),
];

const fn friends(name: &'static str, kind: Kind, roles: Roles, gives: Features, build: Build) -> Goal {
    let goal = goal(name, kind, roles, gives, build).bars(&[Feature::Crates]);
    Goal { pattern: Pattern { weight: 3, ..goal.pattern }, ..goal }
}

/// A friend that moves randomly or flees from the hero.
fn shy(draft: &mut Draft, sampler: &mut Sampler) -> Part {
    if sampler.ratio(1, 2) {
        return draft.place(Role::Friend, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    }
    fleeing(draft, sampler)
}

fn fleeing(draft: &mut Draft, sampler: &mut Sampler) -> Part {
    let params = [("stype", Value::Part(AVATAR)), ("cooldown", Value::Count(draw(sampler, 2, 4)))];
    draft.place(Role::Friend, SpriteClass::Fleeing, Body::Walker, &params)
}

/// A friend that moves randomly and slowly, and that the hero can push.
fn driven(draft: &mut Draft, sampler: &mut Sampler) -> Part {
    let params =
        [("cooldown", Value::Count(draw(sampler, 10, 16))), ("cons", Value::Count(draw(sampler, 0, 2)))];
    let friend = draft.place(Role::Friend, SpriteClass::RandomNPC, Body::Walker, &params);
    draft.rule(Phase::Push, friend, &[AVATAR], Effect::BounceForward);
    draft.add_fact("<names> stray about, and go where you nudge them", &[friend]);
    friend
}

/// A friend that follows the hero.
fn follower(draft: &mut Draft, sampler: &mut Sampler) -> Part {
    let params = [("stype", Value::Part(AVATAR)), ("cooldown", Value::Count(draw(sampler, 2, 3)))];
    draft.place(Role::Friend, SpriteClass::Chaser, Body::Walker, &params)
}

/// Adds a hunter of the friends; losing a few of them loses the game.
fn hunter(draft: &mut Draft, sampler: &mut Sampler, friend: Part) {
    let params = [("stype", Value::Part(friend)), ("cooldown", Value::Count(draw(sampler, 4, 6)))];
    let hunter = draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    let lost = draft.state(friend, "lost", SpriteClass::Immovable, Body::Flat, &[]);
    let limit = draw(sampler, 1, 2);
    draft.scored(Phase::Meet, friend, &[hunter], Effect::becomes(lost), -3);
    draft.prey(hunter, 2);
    draft.lose_with(lost, limit);
    draft.add_fact(
        &format!("<names> are after every <name>, and {} lost is too many", english::number(limit)),
        &[hunter, friend],
    );
}

fn caught(draft: &mut Draft, friend: Part) {
    draft.scored(Phase::Take, friend, &[AVATAR], Effect::KillSprite, 3);
    draft.win_without(&[friend]);
    draft.goal = draft.phrase("catch every <name> to save it", &[friend]);
}

fn catch(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = shy(draft, sampler);
    caught(draft, friend);
}

fn catch_first(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = shy(draft, sampler);
    caught(draft, friend);
    hunter(draft, sampler, friend);
}

/// Friends are safe in the haven.
fn housed(draft: &mut Draft, friend: Part) -> Part {
    let haven = draft.place(Role::Haven, SpriteClass::Immovable, Body::Spot, &[]);
    draft.scored(Phase::Meet, friend, &[haven], Effect::KillSprite, 4);
    draft.win_without(&[friend]);
    haven
}

fn escort(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = follower(draft, sampler);
    let haven = housed(draft, friend);
    draft.goal = draft.phrase("lead every <name> to the <name>", &[friend, haven]);
    draft.add_fact("<names> follow you wherever you go", &[friend]);
}

fn escort_hunted(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = follower(draft, sampler);
    let haven = housed(draft, friend);
    draft.goal = draft.phrase("lead every <name> to the <name>", &[friend, haven]);
    hunter(draft, sampler, friend);
}

fn herd(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = driven(draft, sampler);
    let haven = housed(draft, friend);
    draft.goal = draft.phrase("drive every <name> into the <name>", &[friend, haven]);
}

fn herd_hunted(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = driven(draft, sampler);
    let haven = housed(draft, friend);
    draft.goal = draft.phrase("drive every <name> into the <name>", &[friend, haven]);
    hunter(draft, sampler, friend);
}

/// Friends that are woken follow the hero, and may be put to sleep again.
fn wake(draft: &mut Draft, sampler: &mut Sampler) {
    let asleep = draft.place(Role::Friend, SpriteClass::Immovable, Body::Spot, &[]);
    let params = [("stype", Value::Part(AVATAR)), ("cooldown", Value::Count(draw(sampler, 2, 3)))];
    let awake = draft.state(asleep, "woken", SpriteClass::Chaser, Body::Walker, &params);
    let lulling =
        draft.place(Role::Snuffer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    draft.scored(Phase::Meet, awake, &[lulling], Effect::becomes(asleep), -2);
    draft.scored(Phase::Take, asleep, &[AVATAR], Effect::becomes(awake), 2);
    draft.win_without(&[asleep]);
    draft.goal = draft.phrase("have every <name> awake at once", &[asleep]);
    draft.add_fact("those that you wake follow you, and <names> send them to sleep again", &[lulling]);
}
