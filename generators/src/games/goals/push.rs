//! Goals of pushing things.

use super::{goal, shut_exit};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, Phase};
use crate::games::effect::Effect;
use crate::games::kind::Kind;
use crate::games::obstacles;
use crate::games::pattern::{Build, Feature, Goal, Roles};
use crate::games::role::Role;
use engine::{Sampler, SpriteClass};

pub(super) const GOALS: &[Goal] = &[
    puzzle("goal/sockets", &[Role::Crate, Role::Socket], sockets),
    puzzle("goal/fill", &[Role::Crate, Role::Socket], fill),
    puzzle("goal/plate", &[Role::Crate, Role::Plate, Role::Exit], plate),
];

const fn puzzle(name: &'static str, roles: Roles, build: Build) -> Goal {
    goal(name, Kind::BoxPuzzle, roles, &[Feature::Crates], build)
        .threats(0, 1)
        .obstacles(0, 1)
        .bars(&[Feature::Movers, Feature::Armed])
}

/// A socket takes any number of crates.
fn sockets(draft: &mut Draft, _: &mut Sampler) {
    let block = obstacles::pushable(draft);
    let socket = draft.place(Role::Socket, SpriteClass::Immovable, Body::Flat, &[]);
    draft.scored(Phase::Meet, block, &[socket], Effect::KillSprite, 5);
    draft.win_without(&[block]);
    draft.goal = draft.phrase("push every <name> into <a name>", &[block, socket]);
}

/// A socket takes one crate, which then becomes an obstacle.
fn fill(draft: &mut Draft, _: &mut Sampler) {
    let block = obstacles::pushable(draft);
    let socket = draft.place(Role::Socket, SpriteClass::Immovable, Body::Flat, &[]);
    let set = draft.state(block, "set", SpriteClass::Immovable, Body::Solid, &[]);
    let mark_handled = Effect::TransformTo { stype: set, kill_second: true };
    draft.scored(Phase::Meet, block, &[socket], mark_handled, 5);
    draft.win_without(&[socket]);
    draft.goal = draft.phrase("fill every <name> with <a name>", &[socket, block]);
}

/// A crate on the plate opens the exit.
fn plate(draft: &mut Draft, _: &mut Sampler) {
    let block = obstacles::pushable(draft);
    let plate = draft.place(Role::Plate, SpriteClass::Immovable, Body::Flat, &[]);
    let (shut, open) = shut_exit(draft);
    draft.rule(Phase::Meet, plate, &[block], Effect::TransformToAll { stype: shut, into: open });
    draft.scored(Phase::Meet, plate, &[block], Effect::KillSprite, 5);
    draft.scored(Phase::Arrive, open, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[shut, open]);
    draft.goal = draft.phrase(
        "push <a name> onto the <name> to unseal the <name>, then leave by it",
        &[block, plate, open],
    );
}
