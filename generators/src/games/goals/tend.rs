//! Goals of putting everything in order while something undoes the work.

use super::goal;
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, HERO, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::kind::Kind;
use crate::games::pattern::{Build, Feature, Features, Goal, Roles};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

pub(super) const GOALS: &[Goal] = &[
    tending("goal/light", &[Role::Lamp, Role::Snuffer], &[Feature::Movers, Feature::Errands], light),
    tending(
        "goal/sow",
        &[Role::Seed, Role::Plot, Role::Sprout, Role::Pest],
        &[Feature::Movers, Feature::States, Feature::Errands],
        sow,
    ),
    tending("goal/overrun", &[Role::Plot, Role::Pest], &[Feature::Movers, Feature::Errands], overrun),
];

const fn tending(name: &'static str, roles: Roles, gives: Features, build: Build) -> Goal {
    goal(name, Kind::Tending, roles, gives, build).bars(&[Feature::Armed]).threats(0, 1).ticks(6, 14)
}

fn light(draft: &mut Draft, sampler: &mut Sampler) {
    let lamp = draft.place(Role::Lamp, SpriteClass::Immovable, Body::Spot, &[]);
    let lit = draft.state(lamp, "lit", SpriteClass::Immovable, Body::Spot, &[]);
    let snuffer =
        draft.place(Role::Snuffer, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    draft.scored(Phase::Meet, lit, &[snuffer], Effect::becomes(lamp), -1);
    draft.scored(Phase::Take, lamp, &[AVATAR], Effect::becomes(lit), 1);
    draft.win_without(&[lamp]);
    draft.goal = draft.phrase("have every <name> lit at once", &[lamp]);
    draft.add_fact("<names> put them out again", &[snuffer]);
}

fn sow(draft: &mut Draft, sampler: &mut Sampler) {
    let seed = draft.place(Role::Seed, SpriteClass::Immovable, Body::Spot, &[]);
    let plot = draft.place(Role::Plot, SpriteClass::Immovable, Body::Spot, &[]);
    let sprout = draft.spawn(Role::Sprout, SpriteClass::Immovable, Body::Spot, &[]);
    let pest = if sampler.ratio(1, 2) {
        draft.place(Role::Pest, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler))
    } else {
        // Chases the sprouts; it strays while there are none.
        let params = [("stype", Value::Part(sprout)), ("cooldown", Value::Count(draw(sampler, 5, 8)))];
        draft.place(Role::Pest, SpriteClass::Chaser, Body::Walker, &params)
    };
    let laden = draft.hero_state("laden");
    draft.scored(Phase::Meet, sprout, &[pest], Effect::becomes(plot), -2);
    draft.rule(Phase::Take, HERO, &[seed], Effect::becomes(laden));
    draft.scored(Phase::Take, plot, &[laden], Effect::becomes(sprout), 2);
    draft.rule(Phase::Take, laden, &[plot], Effect::becomes(HERO));
    draft.win_without(&[plot]);
    draft.goal =
        draft.phrase("fetch from the <name> until every <name> bears <a name>", &[seed, plot, sprout]);
    draft.add_fact("<names> undo your work", &[pest]);
}

/// The pests spread and must be cleared faster than they spread.
fn overrun(draft: &mut Draft, sampler: &mut Sampler) {
    let plot = draft.place(Role::Plot, SpriteClass::Immovable, Body::Spot, &[]);
    let pest = draft.spawn(Role::Pest, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    let params = threats::spawning(pest, draw(sampler, 14, 28), draw(sampler, 3, 6));
    let overrun = draft.state(plot, "overrun", SpriteClass::SpawnPoint, Body::Spot, &params);
    draft.show(overrun);
    let mark_handled = Effect::TransformTo { stype: overrun, kill_second: true };
    draft.scored(Phase::Meet, plot, &[pest], mark_handled, -1);
    draft.scored(Phase::Take, pest, &[AVATAR], Effect::KillSprite, 1);
    draft.scored(Phase::Take, overrun, &[AVATAR], Effect::becomes(plot), 3);
    draft.lose_without(plot);
    draft.win_without(&[overrun, pest]);
    draft.goal = draft.phrase(
        "clear every <name> and catch every <name> before the last free <name> is lost",
        &[overrun, pest, plot],
    );
    draft.add_fact("<names> come out of every <name> and overrun others", &[pest, overrun]);
}
