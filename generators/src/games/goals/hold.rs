//! Goals of holding out.

use super::goal;
use crate::games::body::Body;
use crate::games::boons;
use crate::games::draft::{AVATAR, Draft, Ending, Harm, Phase, Value, WALL, draw};
use crate::games::effect::Effect;
use crate::games::english;
use crate::games::kind::Kind;
use crate::games::pattern::{Feature, Goal, Pattern};
use crate::games::role::Role;
use crate::games::threats;
use engine::{Sampler, SpriteClass};

const SIEGE: &[Feature] = &[Feature::Movers, Feature::Harm, Feature::Prey];

pub(super) const GOALS: &[Goal] = &[
    Goal {
        ticks: (6, 10),
        obstacles: (0, 1),
        ..goal(
            "goal/survive",
            Kind::Survival,
            &[Role::Nest, Role::Chaser, Role::Bush, Role::Berry],
            SIEGE,
            survive,
        )
    },
    Goal {
        hero: &[Feature::Row],
        ticks: (6, 8),
        threats: (0, 0),
        obstacles: (0, 0),
        pattern: Pattern {
            bars: &[Feature::Armed],
            ..goal(
                "goal/dodge",
                Kind::Survival,
                &[Role::Bomber, Role::Drop, Role::Tree, Role::Fruit],
                SIEGE,
                dodge,
            )
            .pattern
        },
        ..goal("goal/dodge", Kind::Survival, &[], &[], dodge)
    },
    Goal {
        hero: &[Feature::Four, Feature::Strikes],
        threats: (0, 1),
        ..goal(
            "goal/defend",
            Kind::Defence,
            &[Role::Crop, Role::Pest, Role::Nest],
            &[Feature::Movers, Feature::Prey],
            defend,
        )
    },
    Goal {
        hero: &[Feature::Row],
        threats: (0, 1),
        obstacles: (0, 0),
        pattern: Pattern {
            bars: &[Feature::Armed],
            ..goal(
                "goal/catch-falling",
                Kind::Catching,
                &[Role::Tree, Role::Fruit],
                &[Feature::Movers],
                catch,
            )
            .pattern
        },
        ..goal("goal/catch-falling", Kind::Catching, &[], &[], catch)
    },
];

fn survive(draft: &mut Draft, sampler: &mut Sampler) {
    let params = threats::pursuing(AVATAR, sampler);
    let foe = draft.spawn(Role::Chaser, SpriteClass::Chaser, Body::Walker, &params);
    let nest = threats::nest(draft, sampler, foe, 0);
    draft.harm(foe, Harm::Spent);
    draft.prey(foe, 2);
    boons::bush(draft, sampler);
    outlast(draft);
    let clause = format!("{} come out of every {} and give chase", draft.many(foe), draft.say(nest));
    draft.tell(clause);
}

/// Time up is a win: the limit itself comes later.
fn outlast(draft: &mut Draft) {
    draft.endings.push((Ending::Timeout(0), true));
    draft.goal = "stay alive until time is up".into();
}

/// Some of what falls is good.
fn dodge(draft: &mut Draft, sampler: &mut Sampler) {
    let (bomber, drop) = threats::bombers(draft, sampler);
    let params = [("orientation", Value::Word("DOWN")), ("cooldown", Value::Count(2))];
    let fruit = draft.spawn(Role::Fruit, SpriteClass::Missile, Body::FoeShot, &params);
    let params = [
        ("stype", Value::Part(fruit)),
        ("cooldown", Value::Count(draw(sampler, 8, 16))),
        ("prob", Value::Hundredths(10 * draw(sampler, 4, 8))),
    ];
    let tree = draft.place(Role::Tree, SpriteClass::SpawnPoint, Body::Flat, &params);
    draft.scored(Phase::Take, fruit, &[AVATAR], Effect::KillSprite, 2);
    outlast(draft);
    let clause = format!(
        "{} drop {}, but {} from the {} are worth two points each",
        draft.many(bomber),
        draft.many(drop),
        draft.many(fruit),
        draft.say(tree)
    );
    draft.tell_points(clause);
}

fn defend(draft: &mut Draft, sampler: &mut Sampler) {
    let crop = draft.place(Role::Crop, SpriteClass::Immovable, Body::Spot, &[]);
    let params = [("stype", Value::Part(crop)), ("cooldown", Value::Count(draw(sampler, 3, 4)))];
    let pest = draft.spawn(Role::Pest, SpriteClass::Chaser, Body::Walker, &params);
    let total = draw(sampler, 3, 6);
    let nest = threats::nest(draft, sampler, pest, total);
    draft.scored(Phase::Meet, crop, &[pest], Effect::KillSprite, -2);
    draft.prey(pest, 2);
    draft.lose_without(crop);
    draft.win_without(&[nest, pest]);
    draft.goal = format!(
        "beat off all {} {} that come out of every {} before the last {} is gone",
        english::number(total),
        draft.many(pest),
        draft.say(nest),
        draft.say(crop)
    );
}

fn catch(draft: &mut Draft, sampler: &mut Sampler) {
    let params = [("orientation", Value::Word("DOWN")), ("cooldown", Value::Count(draw(sampler, 2, 3)))];
    let fruit = draft.spawn(Role::Fruit, SpriteClass::Missile, Body::FoeShot, &params);
    let fallen = draft.state(fruit, "fallen", SpriteClass::Immovable, Body::Flat, &[]);
    let total = draw(sampler, 2, 4);
    let params = [
        ("stype", Value::Part(fruit)),
        ("cooldown", Value::Count(draw(sampler, 12, 24))),
        ("prob", Value::Hundredths(10 * draw(sampler, 4, 8))),
        ("total", Value::Count(total)),
    ];
    let tree = draft.place(Role::Tree, SpriteClass::SpawnPoint, Body::Flat, &params);
    let limit = draw(sampler, 2, 4);
    draft.settle(fruit, WALL);
    draft.scored(Phase::Take, fruit, &[AVATAR], Effect::KillSprite, 2);
    let break_it = Effect::TransformTo { stype: fallen, kill_second: false };
    draft.scored(Phase::Strike, fruit, &[WALL], break_it, -1);
    draft.lose_with(fallen, limit);
    draft.win_without(&[tree, fruit]);
    draft.goal = format!(
        "catch what falls from every {}: {} {} on the ground are too many",
        draft.say(tree),
        english::number(limit),
        draft.many(fallen)
    );
}
