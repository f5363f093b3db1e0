//! The goals of games: one file for each family.

mod arrive;
mod carry;
mod fight;
mod friends;
mod gather;
mod hold;
mod push;
mod tend;
mod unlock;

use super::body::Body;
use super::draft::{Draft, Part};
use super::kind::Kind;
use super::pattern::{Build, Feature, Features, Goal, Roles, pattern};
use super::role::Role;
use engine::SpriteClass;

pub(crate) fn all() -> Vec<&'static Goal> {
    let families: [&'static [Goal]; 9] = [
        arrive::GOALS,
        gather::GOALS,
        unlock::GOALS,
        fight::GOALS,
        push::GOALS,
        friends::GOALS,
        carry::GOALS,
        tend::GOALS,
        hold::GOALS,
    ];
    families.into_iter().flatten().collect()
}

/// A goal for a hero that moves in four directions, with the usual numbers of other patterns; callers override the rest.
const fn goal(name: &'static str, kind: Kind, roles: Roles, gives: Features, build: Build) -> Goal {
    Goal {
        pattern: pattern(name, 4, roles, gives, build),
        kind,
        hero: &[Feature::Four],
        threats: (1, 2),
        obstacles: (0, 2),
        ticks: (6, 12),
    }
}

/// Adds an exit.
fn exit(draft: &mut Draft, body: Body) -> Part {
    draft.place(Role::Exit, SpriteClass::Door, body, &[])
}

/// Adds an exit that is sealed until something opens it; returns the sealed and the open state.
fn shut_exit(draft: &mut Draft) -> (Part, Part) {
    let open = draft.spawn(Role::Exit, SpriteClass::Door, Body::Spot, &[]);
    let shut = draft.state(open, "sealed", SpriteClass::Immovable, Body::Solid, &[]);
    draft.show(shut);
    (shut, open)
}
