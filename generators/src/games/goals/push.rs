//! Goals of pushing things.

use super::{goal, shut_exit};
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, Part, Phase};
use crate::games::effect::Effect;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal, Pattern};
use crate::games::role::Role;
use engine::{Sampler, SpriteClass};

pub(super) const GOALS: &[Goal] = &[
    puzzle("goal/sockets", &[Role::Crate, Role::Socket], sockets),
    puzzle("goal/fill", &[Role::Crate, Role::Socket], fill),
    puzzle("goal/plate", &[Role::Crate, Role::Plate, Role::Exit], plate),
];

const fn puzzle(name: &'static str, roles: &'static [Role], build: fn(&mut Draft, &mut Sampler)) -> Goal {
    let goal = goal(name, Kind::BoxPuzzle, roles, &[Feature::Crates], build);
    Goal {
        threats: (0, 1),
        obstacles: (0, 1),
        pattern: Pattern { bars: &[Feature::Movers, Feature::Armed], ..goal.pattern },
        ..goal
    }
}

/// Adds a crate to push.
fn block(draft: &mut Draft) -> Part {
    let block = draft.place(Role::Crate, SpriteClass::Passive, Body::Crate, &[]);
    draft.rule(Phase::Push, block, &[AVATAR], Effect::BounceForward);
    block
}

/// A socket takes any number of crates.
fn sockets(draft: &mut Draft, _: &mut Sampler) {
    let block = block(draft);
    let socket = draft.place(Role::Socket, SpriteClass::Immovable, Body::Flat, &[]);
    draft.scored(Phase::Meet, block, &[socket], Effect::KillSprite, 5);
    draft.win_without(&[block]);
    draft.goal = format!("push every {} into {}", draft.spaced_name(block), draft.with_article(socket));
}

/// A socket takes one crate, which then becomes an obstacle.
fn fill(draft: &mut Draft, _: &mut Sampler) {
    let block = block(draft);
    let socket = draft.place(Role::Socket, SpriteClass::Immovable, Body::Flat, &[]);
    let set = draft.state(block, "set", SpriteClass::Immovable, Body::Solid, &[]);
    let mark_handled = Effect::TransformTo { stype: set, kill_second: true };
    draft.scored(Phase::Meet, block, &[socket], mark_handled, 5);
    draft.win_without(&[socket]);
    draft.goal = format!("fill every {} with {}", draft.spaced_name(socket), draft.with_article(block));
}

/// A crate on the plate opens the exit.
fn plate(draft: &mut Draft, _: &mut Sampler) {
    let block = block(draft);
    let plate = draft.place(Role::Plate, SpriteClass::Immovable, Body::Flat, &[]);
    let (shut, open) = shut_exit(draft);
    draft.rule(Phase::Meet, plate, &[block], Effect::TransformToAll { stype: shut, into: open });
    draft.scored(Phase::Meet, plate, &[block], Effect::KillSprite, 5);
    draft.scored(Phase::Arrive, open, &[AVATAR], Effect::KillSprite, 10);
    draft.win_without(&[shut, open]);
    draft.goal = format!(
        "push {} onto the {} to unseal the {}, then leave by it",
        draft.with_article(block),
        draft.spaced_name(plate),
        draft.spaced_name(open)
    );
}
