//! Goals of putting everything in order while something undoes the work.

use super::goal;
use crate::games::body::Body;
use crate::games::draft::{AVATAR, Draft, HERO, Phase, Value, draw};
use crate::games::effect::Effect;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal, Pattern};
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

const fn tending(
    name: &'static str,
    roles: &'static [Role],
    gives: &'static [Feature],
    build: fn(&mut Draft, &mut Sampler),
) -> Goal {
    let goal = goal(name, Kind::Tending, roles, gives, build);
    Goal {
        pattern: Pattern { bars: &[Feature::Armed], ..goal.pattern },
        threats: (0, 1),
        ticks: (6, 14),
        ..goal
    }
}

fn light(draft: &mut Draft, sampler: &mut Sampler) {
    let lamp = draft.place(Role::Lamp, SpriteClass::Immovable, Body::Spot, &[]);
    let lit = draft.state(lamp, "lit", SpriteClass::Immovable, Body::Spot, &[]);
    let params = threats::straying(sampler);
    let snuffer = draft.place(Role::Snuffer, SpriteClass::RandomNPC, Body::Walker, &params);
    let turn = |stype| Effect::TransformTo { stype, kill_second: false };
    draft.scored(Phase::Meet, lit, &[snuffer], turn(lamp), -1);
    draft.scored(Phase::Take, lamp, &[AVATAR], turn(lit), 1);
    draft.win_without(&[lamp]);
    draft.goal = format!("have every {} lit at once", draft.spaced_name(lamp));
    let clause = format!("{} put them out again", draft.plural(snuffer));
    draft.add_fact(clause);
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
    let turn = |stype| Effect::TransformTo { stype, kill_second: false };
    draft.scored(Phase::Meet, sprout, &[pest], turn(plot), -2);
    draft.rule(Phase::Take, HERO, &[seed], turn(laden));
    draft.scored(Phase::Take, plot, &[laden], turn(sprout), 2);
    draft.rule(Phase::Take, laden, &[plot], turn(HERO));
    draft.win_without(&[plot]);
    draft.goal = format!(
        "fetch from the {} until every {} bears {}",
        draft.spaced_name(seed),
        draft.spaced_name(plot),
        draft.with_article(sprout)
    );
    let clause = format!("{} undo your work", draft.plural(pest));
    draft.add_fact(clause);
}

/// The pests spread and must be cleared faster than they spread.
fn overrun(draft: &mut Draft, sampler: &mut Sampler) {
    let plot = draft.place(Role::Plot, SpriteClass::Immovable, Body::Spot, &[]);
    let pest = draft.spawn(Role::Pest, SpriteClass::RandomNPC, Body::Walker, &threats::straying(sampler));
    let params = [
        ("stype", Value::Part(pest)),
        ("cooldown", Value::Count(draw(sampler, 14, 28))),
        ("prob", Value::Hundredths(10 * draw(sampler, 3, 6))),
    ];
    let overrun = draft.state(plot, "overrun", SpriteClass::SpawnPoint, Body::Spot, &params);
    draft.show(overrun);
    let mark_handled = Effect::TransformTo { stype: overrun, kill_second: true };
    draft.scored(Phase::Meet, plot, &[pest], mark_handled, -1);
    draft.scored(Phase::Take, pest, &[AVATAR], Effect::KillSprite, 1);
    let clear = Effect::TransformTo { stype: plot, kill_second: false };
    draft.scored(Phase::Take, overrun, &[AVATAR], clear, 3);
    draft.lose_without(plot);
    draft.win_without(&[overrun, pest]);
    draft.goal = format!(
        "clear every {} and catch every {} before the last free {} is lost",
        draft.spaced_name(overrun),
        draft.spaced_name(pest),
        draft.spaced_name(plot)
    );
    let clause =
        format!("{} come out of every {} and overrun others", draft.plural(pest), draft.spaced_name(overrun));
    draft.add_fact(clause);
}
