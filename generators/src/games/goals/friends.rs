//! Goals of getting friends to safety.

use super::goal;
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, Part, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal, Pattern};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

const FOLLOWED: &[Feature] = &[Feature::Movers, Feature::Followers];
const HUNTED: &[Feature] = &[Feature::Movers, Feature::Followers, Feature::Prey];

pub(super) const GOALS: &[Goal] = &[
    friends("goal/catch", Kind::Rescue, &[Role::Friend], FOLLOWED, (1, 2), catch),
    friends("goal/catch-first", Kind::Rescue, &[Role::Friend, Role::Chaser], HUNTED, (0, 1), catch_first),
    friends("goal/escort", Kind::Rescue, &[Role::Friend, Role::Haven], FOLLOWED, (1, 2), escort),
    friends(
        "goal/escort-hunted",
        Kind::Rescue,
        &[Role::Friend, Role::Haven, Role::Chaser],
        HUNTED,
        (0, 1),
        escort_hunted,
    ),
    friends("goal/herd", Kind::Herding, &[Role::Friend, Role::Haven], FOLLOWED, (0, 1), herd),
    friends(
        "goal/herd-hunted",
        Kind::Herding,
        &[Role::Friend, Role::Haven, Role::Chaser],
        HUNTED,
        (0, 1),
        herd_hunted,
    ),
    friends("goal/wake", Kind::Rescue, &[Role::Friend, Role::Snuffer], FOLLOWED, (0, 1), wake),
];

const fn friends(
    name: &'static str,
    kind: Kind,
    roles: &'static [Role],
    gives: &'static [Feature],
    threats: (usize, usize),
    build: fn(&mut Draft, &mut Sampler),
) -> Goal {
    let goal = goal(name, kind, roles, gives, build);
    Goal { threats, pattern: Pattern { weight: 3, bars: &[Feature::Crates], ..goal.pattern }, ..goal }
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
    let clause = format!("{} stray about, and go where you nudge them", draft.plural(friend));
    draft.add_fact(clause);
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
    let lose = Effect::TransformTo { stype: lost, kill_second: false };
    draft.scored(Phase::Meet, friend, &[hunter], lose, -3);
    draft.prey(hunter, 2);
    draft.lose_with(lost, limit);
    let clause = format!(
        "{} are after every {}, and {} lost is too many",
        draft.plural(hunter),
        draft.spaced_name(friend),
        english::number(limit)
    );
    draft.add_fact(clause);
}

fn caught(draft: &mut Draft, friend: Part) {
    draft.scored(Phase::Take, friend, &[AVATAR], Effect::KillSprite, 3);
    draft.win_without(&[friend]);
    draft.goal = format!("catch every {} to save it", draft.spaced_name(friend));
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
    draft.goal = format!("lead every {} to the {}", draft.spaced_name(friend), draft.spaced_name(haven));
    let clause = format!("{} follow you wherever you go", draft.plural(friend));
    draft.add_fact(clause);
}

fn escort_hunted(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = follower(draft, sampler);
    let haven = housed(draft, friend);
    draft.goal = format!("lead every {} to the {}", draft.spaced_name(friend), draft.spaced_name(haven));
    hunter(draft, sampler, friend);
}

fn herd(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = driven(draft, sampler);
    let haven = housed(draft, friend);
    draft.goal = format!("drive every {} into the {}", draft.spaced_name(friend), draft.spaced_name(haven));
}

fn herd_hunted(draft: &mut Draft, sampler: &mut Sampler) {
    let friend = driven(draft, sampler);
    let haven = housed(draft, friend);
    draft.goal = format!("drive every {} into the {}", draft.spaced_name(friend), draft.spaced_name(haven));
    hunter(draft, sampler, friend);
}

/// Friends that are woken follow the hero, and may be put to sleep again.
fn wake(draft: &mut Draft, sampler: &mut Sampler) {
    let asleep = draft.place(Role::Friend, SpriteClass::Immovable, Body::Spot, &[]);
    let params = [("stype", Value::Part(AVATAR)), ("cooldown", Value::Count(draw(sampler, 2, 3)))];
    let awake = draft.state(asleep, "woken", SpriteClass::Chaser, Body::Walker, &params);
    let params = threats::straying(sampler);
    let lulling = draft.place(Role::Snuffer, SpriteClass::RandomNPC, Body::Walker, &params);
    let turn = |stype| Effect::TransformTo { stype, kill_second: false };
    draft.scored(Phase::Meet, awake, &[lulling], turn(asleep), -2);
    draft.scored(Phase::Take, asleep, &[AVATAR], turn(awake), 2);
    draft.win_without(&[asleep]);
    draft.goal = format!("have every {} awake at once", draft.spaced_name(asleep));
    let clause =
        format!("those that you wake follow you, and {} send them to sleep again", draft.plural(lulling));
    draft.add_fact(clause);
}
