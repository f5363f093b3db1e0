//! What endangers the hero.

use super::body::Body;
use super::draft::{AVATAR, Draft, Harm, Part, Value, draw};
use super::pattern::{Feature, Pattern};
use super::role::Role;
use engine::{Sampler, SpriteClass};

/// What harms and moves, and can be hit.
const FOE: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::Prey];
/// What harms and moves, and cannot be hit.
const DANGER: &[Feature] = &[Feature::Movers, Feature::Harm];

const fn threat(
    name: &'static str,
    weight: u32,
    roles: &'static [Role],
    gives: &'static [Feature],
    build: fn(&mut Draft, &mut Sampler),
) -> Pattern {
    Pattern { name, weight, roles, gives, needs: &[Feature::Four], bars: &[], build }
}

/// All threats.
pub(crate) const THREATS: &[Pattern] = &[
    threat("threat/trap", 4, &[Role::Trap], &[Feature::Harm], trap),
    threat("threat/patrol", 4, &[Role::Patroller], FOE, patrol),
    threat("threat/cross-patrols", 2, &[Role::Patroller, Role::Rover], FOE, cross_patrols),
    threat("threat/stray", 4, &[Role::Wanderer], FOE, stray),
    threat("threat/chase", 4, &[Role::Chaser], FOE, chase),
    threat("threat/bomb", 3, &[Role::Bomber, Role::Drop], FOE, bomb),
    threat("threat/slime", 3, &[Role::Slug, Role::Slime], FOE, slime),
    threat("threat/turret", 3, &[Role::Turret, Role::Dart], DANGER, turret),
    threat("threat/nest-of-strays", 2, &[Role::Nest, Role::Wanderer], FOE, nest_of_strays),
    threat("threat/nest-of-chasers", 2, &[Role::Nest, Role::Chaser], FOE, nest_of_chasers),
    threat("threat/geyser", 3, &[Role::Vent, Role::Steam], DANGER, geyser),
    threat("threat/creep", 2, &[Role::Vent, Role::Creep], DANGER, creep),
    Pattern { needs: &[Feature::Row], ..threat("threat/rain", 3, &[Role::Bomber, Role::Drop], FOE, rain) },
];

fn trap(draft: &mut Draft, _: &mut Sampler) {
    let trap = draft.place(Role::Trap, SpriteClass::Immovable, Body::Flat, &[]);
    draft.harm(trap, Harm::Lasting);
    let clause = format!("{} lie in wait", draft.many(trap));
    draft.tell(clause);
}

/// Something that goes straight and turns round; `orientation` is where it starts to.
pub(crate) fn patroller(draft: &mut Draft, role: Role, orientation: &'static str, cooldown: u32) -> Part {
    let params = [("orientation", Value::Word(orientation)), ("cooldown", Value::Count(cooldown))];
    draft.place(role, SpriteClass::Missile, Body::Patroller, &params)
}

fn patrol(draft: &mut Draft, sampler: &mut Sampler) {
    let orientation = *sampler.choose(&["RIGHT", "DOWN"]);
    let foe = patroller(draft, Role::Patroller, orientation, draw(sampler, 2, 3));
    foe_of(draft, foe, 2);
    let way = if orientation == "RIGHT" { "to and fro" } else { "up and down" };
    let clause = format!("{} go {way}", draft.many(foe));
    draft.tell_way(foe, clause);
}

fn cross_patrols(draft: &mut Draft, sampler: &mut Sampler) {
    let across = patroller(draft, Role::Patroller, "RIGHT", draw(sampler, 2, 3));
    let along = patroller(draft, Role::Rover, "DOWN", draw(sampler, 2, 3));
    foe_of(draft, across, 2);
    foe_of(draft, along, 2);
    let clause = format!("{} go to and fro, {} up and down", draft.many(across), draft.many(along));
    draft.tell(clause);
}

/// A foe that its pattern placed: it harms, and can be hit.
fn foe_of(draft: &mut Draft, foe: Part, score: i32) {
    draft.harm(foe, Harm::Spent);
    draft.prey(foe, score);
}

/// How a stray moves: how rarely, and how long in one direction.
pub(crate) fn straying(sampler: &mut Sampler) -> [(&'static str, Value); 2] {
    [("cooldown", Value::Count(draw(sampler, 2, 4))), ("cons", Value::Count(draw(sampler, 0, 3)))]
}

/// How a pursuer moves: after whom, and how rarely.
pub(crate) fn pursuing(target: Part, sampler: &mut Sampler) -> [(&'static str, Value); 2] {
    [("stype", Value::Part(target)), ("cooldown", Value::Count(draw(sampler, 2, 4)))]
}

fn stray(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.place(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &straying(sampler));
    foe_of(draft, foe, 2);
    let clause = format!("{} stray about", draft.many(foe));
    draft.tell_way(foe, clause);
}

fn chase(draft: &mut Draft, sampler: &mut Sampler) {
    let params = pursuing(AVATAR, sampler);
    let foe = draft.place(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    foe_of(draft, foe, 3);
    let clause = format!("{} give chase", draft.many(foe));
    draft.tell_way(foe, clause);
}

/// A patroller that lets things fall.
pub(crate) fn bombers(draft: &mut Draft, sampler: &mut Sampler) -> (Part, Part) {
    let params = [("orientation", Value::Word("DOWN")), ("cooldown", Value::Count(draw(sampler, 1, 2)))];
    let drop = draft.spawn(Role::Drop, SpriteClass::Missile, Body::FoeShot, &params);
    let params = [
        ("stype", Value::Part(drop)),
        ("orientation", Value::Word(["LEFT", "RIGHT"][sampler.below(2)])),
        ("speed", Value::Count(1)),
        ("cooldown", Value::Count(draw(sampler, 2, 4))),
        ("prob", Value::Hundredths(5 * draw(sampler, 4, 10))),
    ];
    let bomber = draft.place(Role::Bomber, SpriteClass::Bomber, Body::Patroller, &params);
    draft.harm(drop, Harm::Spent);
    (bomber, drop)
}

fn bomb(draft: &mut Draft, sampler: &mut Sampler) {
    let (bomber, drop) = bombers(draft, sampler);
    foe_of(draft, bomber, 3);
    let clause = format!("{} drop {}", draft.many(bomber), draft.many(drop));
    draft.tell(clause);
}

/// The hero stays below: only what falls harms it.
fn rain(draft: &mut Draft, sampler: &mut Sampler) {
    let (bomber, drop) = bombers(draft, sampler);
    draft.prey(bomber, 3);
    let clause = format!("{} drop {}", draft.many(bomber), draft.many(drop));
    draft.tell(clause);
}

fn slime(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("limit", Value::Count(draw(sampler, 10, 25)))];
    let slime = draft.spawn(Role::Slime, SpriteClass::Flicker, Body::Puff, &params);
    let params = [
        ("stype", Value::Part(slime)),
        ("cooldown", Value::Count(draw(sampler, 3, 4))),
        ("prob", Value::Hundredths(10 * draw(sampler, 3, 8))),
    ];
    let slug = draft.place(Role::Slug, SpriteClass::RandomBomber, Body::Walker, &params);
    draft.harm(slime, Harm::Lasting);
    foe_of(draft, slug, 2);
    let clause = format!("{} leave {} behind", draft.many(slug), draft.say(slime));
    draft.tell(clause);
}

fn turret(draft: &mut Draft, sampler: &mut Sampler) {
    let cooldown = ("cooldown", Value::Count(draw(sampler, 1, 2)));
    let direction = *sampler.choose(&["LEFT", "RIGHT", "DOWN", "any"]);
    let dart = if direction == "any" {
        draft.spawn(Role::Dart, SpriteClass::RandomMissile, Body::FoeShot, &[cooldown])
    } else {
        let params = [("orientation", Value::Word(direction)), cooldown];
        draft.spawn(Role::Dart, SpriteClass::Missile, Body::FoeShot, &params)
    };
    let params = [
        ("stype", Value::Part(dart)),
        ("cooldown", Value::Count(draw(sampler, 7, 14))),
        ("prob", Value::Hundredths(10 * draw(sampler, 6, 10))),
    ];
    let turret = draft.place(Role::Turret, SpriteClass::SpawnPoint, Body::Den, &params);
    draft.harm(dart, Harm::Spent);
    let aim = if direction == "any" { "every which way".to_owned() } else { direction.to_lowercase() };
    let way = if aim == "left" || aim == "right" { format!("to the {aim}") } else { aim };
    let clause = format!("{} shoot {} {way}", draft.many(turret), draft.many(dart));
    draft.tell_way(dart, clause);
}

/// What comes out of a nest; `total` 0 is without end.
pub(crate) fn nest(draft: &mut Draft, sampler: &mut Sampler, foe: Part, total: u32) -> Part {
    let total = (total > 0).then_some(("total", Value::Count(total)));
    let params = [
        ("stype", Value::Part(foe)),
        ("cooldown", Value::Count(draw(sampler, 15, 35))),
        ("prob", Value::Hundredths(10 * draw(sampler, 5, 10))),
    ];
    let params: Vec<_> = params.into_iter().chain(total).collect();
    draft.place(Role::Nest, SpriteClass::SpawnPoint, Body::Den, &params)
}

fn nest_of_strays(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.spawn(Role::Wanderer, SpriteClass::RandomNPC, Body::Walker, &straying(sampler));
    nest_of(draft, sampler, foe);
}

fn nest_of_chasers(draft: &mut Draft, sampler: &mut Sampler) {
    let foe = draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &pursuing(AVATAR, sampler));
    nest_of(draft, sampler, foe);
}

fn nest_of(draft: &mut Draft, sampler: &mut Sampler, foe: Part) {
    let total = draw(sampler, 2, 5);
    let nest = nest(draft, sampler, foe, total);
    foe_of(draft, foe, 1);
    let clause = format!("{} come out of every {}", draft.many(foe), draft.say(nest));
    draft.tell(clause);
}

/// A vent that bursts with a warning: first it rises in the vent, then it is all around.
fn geyser(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("limit", Value::Count(draw(sampler, 1, 3)))];
    let steam = draft.spawn(Role::Steam, SpriteClass::Flicker, Body::Puff, &params);
    let params = [("stype", Value::Part(steam)), ("limit", Value::Count(2))];
    let rising = draft.state(steam, "rising", SpriteClass::Spreader, Body::Puff, &params);
    vent(draft, sampler, rising, (8, 16));
    draft.harm(steam, Harm::Lasting);
}

/// Two types take turns, since none may spread into itself; one makes fewer than one on average, so it stays small.
fn creep(draft: &mut Draft, sampler: &mut Sampler) {
    let share = ("spreadprob", Value::Hundredths(draw(sampler, 16, 22)));
    let limit = ("limit", Value::Count(draw(sampler, 10, 18)));
    let old = draft.spawn(Role::Creep, SpriteClass::Spreader, Body::Puff, &[share, limit]);
    let young = draft.state(
        old,
        "young",
        SpriteClass::Spreader,
        Body::Puff,
        &[("stype", Value::Part(old)), share, limit],
    );
    draft.give(old, "stype", Value::Part(young));
    vent(draft, sampler, young, (6, 12));
    draft.harm(old, Harm::Lasting);
    draft.harm(young, Harm::Lasting);
}

fn vent(draft: &mut Draft, sampler: &mut Sampler, stype: Part, (low, high): (u32, u32)) {
    let params = [("stype", Value::Part(stype)), ("cooldown", Value::Count(draw(sampler, low, high)))];
    let vent = draft.place(Role::Vent, SpriteClass::SpawnPoint, Body::Den, &params);
    let base = super::english::spaced(draft.name(stype));
    let what = base.split_once(' ').map_or(base.as_str(), |(_, what)| what).to_owned();
    let clause = format!("{} comes out of every {}", what, draft.say(vent));
    draft.tell(clause);
}
