//! Executes each effect and compares the result with the effect's row. The summary must cover every change of
//! the two sprites and of other sprites.

use base::Seed;
use engine::analysis::{EffectSummary, Side};
use engine::inspect::{EffectRow, is_idle};
use engine::{Action, EFFECTS, Game, ParameterKind, SpriteRecord, effect_parameters};
use std::collections::{BTreeMap, BTreeSet};

/// Returns a game in which one effect is executed once, on a sprite of `one` beside a sprite of `two`. `rule`
/// is the line with the effect.
fn game(one: &str, two: &str, rule: &str) -> Option<Game> {
    let text = format!(
        "BasicGame square_size=10\n  SpriteSet\n    one > {one}\n    two > {two}\n    other > Missile speed=0.3 \
         orientation=LEFT\n    gem > Resource limit=5\n    exit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    \
         x > one two\n    o > other\n    g > gem\n    e > exit\n    A > avatar\n  InteractionSet\n    {rule}\n  \
         TerminationSet\n    Timeout limit=99\n"
    );
    Game::from_source(&text).ok()
}

const LEVEL: &str = "A       \n  x   o \n        \n   e  g \n   o    \n";

/// Returns the parameters of an effect, with the values given by `flags` and `named`.
fn parameters(keyword: &str, flags: bool, named: &str) -> String {
    let value = |kind: ParameterKind| match kind {
        ParameterKind::Int => Some("1"),
        ParameterKind::Number => Some("0.99"),
        ParameterKind::Flag => Some(if flags { "True" } else { "False" }),
        ParameterKind::Scores => Some("2"),
        ParameterKind::Sprite | ParameterKind::OptionalSprite | ParameterKind::Sprites => Some(named),
        ParameterKind::TypeNumber => None,
        ParameterKind::Effect => Some("stepBack"),
        ParameterKind::Planned => Some("killAll"),
    };
    let written = effect_parameters(keyword);
    let written = written.iter().filter_map(|&(key, kind)| Some(format!("{key}={}", value(kind)?)));
    written.collect::<Vec<_>>().join(" ")
}

/// Returns the sprites after a few ticks, because missiles do not move in their first tick. Returns `None` if the game
/// is over by then.
fn played(game: &Game, ticks: usize) -> Option<BTreeMap<u32, SpriteRecord>> {
    let mut state = game.start(&game.level(LEVEL).unwrap(), Seed::from_text("row"));
    for _ in 0..ticks {
        game.step(&mut state, Action::Nil);
    }
    let records = game.records(&state).into_iter().map(|record| (record.id, record));
    (!state.is_over()).then(|| records.collect())
}

/// Returns the differences between a tick with the rule and a tick without the rule that the summary does not
/// declare, and the number of all differences. `named` is the type to which the rule's parameters refer.
fn compare(with: &Game, without: &Game, named: &str, ticks: usize) -> (Vec<String>, usize) {
    let row = EffectRow::of_first(with).unwrap();
    let (Some(ours), Some(plain)) = (played(with, ticks), played(without, ticks)) else {
        return (Vec::new(), 0);
    };
    let [one, two] = ["one", "two"].map(|name| with.sprite_type(name).unwrap());
    let has = |is: &dyn Fn(&EffectSummary) -> bool| row.effects.iter().any(is);
    let replaces = |effect: &EffectSummary| {
        use EffectSummary as E;
        matches!(effect, E::Become(_) | E::BecomeAny(_) | E::BecomeAll(..))
    };
    let makes = |effect: &EffectSummary| {
        matches!(effect, EffectSummary::Make(_) | EffectSummary::Clone) || replaces(effect)
    };
    let (mut undeclared, mut seen) = (Vec::new(), 0);
    let mut expect = |is_declared: bool, difference: &str| {
        seen += 1;
        if !is_declared {
            undeclared.push(difference.to_owned());
        }
    };
    for (id, record) in &plain {
        let is_first = usize::from(record.stype) == one.index();
        let is_second = usize::from(record.stype) == two.index();
        let Some(found) = ours.get(id) else {
            let removes = |effect: &EffectSummary| {
                use EffectSummary as E;
                match effect {
                    E::Kill(side) => *side == if is_first { Side::First } else { Side::Second },
                    E::KillAll(stype) | E::BecomeAll(stype, _) => stype.index() == usize::from(record.stype),
                    E::Collect => is_first,
                    E::Health { .. } => true,
                    effect => is_first && replaces(effect),
                }
            };
            expect(has(&removes), "a sprite goes");
            expect(is_first || is_second || row.affects_distant_sprites, "a distant sprite goes");
            continue;
        };
        if found == record {
            continue;
        }
        expect(is_first || is_second || row.affects_distant_sprites, "a distant sprite changes");
        // The summary covers types to which no parameter refers. Only a sprite that does not move by itself
        // is at its previous position.
        let is_still = !row.moves_anything || is_idle(with, two);
        if is_second && named != "two" && is_still {
            expect(!row.spares_still_second, "the second sprite changes");
        }
        // A sprite that turns, or changes its speed, moves differently in the next tick.
        if (found.rect.x, found.rect.y) != (record.rect.x, record.rect.y) && !row.steers {
            expect(row.moves_anything || row.moves_first && is_first, "a sprite moves");
        }
    }
    if ours.keys().any(|id| !plain.contains_key(id)) {
        expect(has(&makes), "a sprite appears");
    }
    (undeclared, seen)
}

/// The effects that need more than two sprites: resources held, a shield, a timer, or a matching spawner.
const IDLE: [&str; 14] = [
    "addTimer",
    "collectResourceIfHeld",
    "killIfFromAbove",
    "killIfHasMore",
    "killIfOtherHasMore",
    "removeScore",
    "shieldFrom",
    "spawnBehind",
    "spawnIfHasMore",
    "transformToAll",
    "transformToRandomChild",
    "transformToSingleton",
    "updateSpawnType",
    "waterPhysics",
];

#[test]
fn effects_do_what_their_rows_say() {
    let moving = "Missile speed=0.4 orientation=RIGHT";
    let firsts = [moving, "Missile speed=0.4 orientation=UP healthPoints=1", "Resource limit=4", "Immovable"];
    let seconds = [
        "Missile speed=0.3 orientation=DOWN",
        "Immovable",
        "Portal stype=exit",
        "SpawnPoint stype=gem prob=0.0001",
        "OrientedFlicker limit=50 orientation=UP",
    ];
    let (mut undeclared, mut effective) = (BTreeSet::new(), BTreeSet::new());
    for keyword in EFFECTS {
        let values =
            ["other", "gem", "one", "two"].into_iter().flat_map(|named| [(named, false), (named, true)]);
        // Rules without such parameters are tried once.
        let rules: BTreeMap<String, &str> =
            values.map(|(named, flags)| (parameters(keyword, flags, named), named)).rev().collect();
        for (first, second) in
            firsts.iter().flat_map(|first| seconds.iter().map(move |second| (first, second)))
        {
            let without = game(first, second, "").unwrap();
            for (parameters, named) in &rules {
                let Some(with) = game(first, second, &format!("one two > {keyword} {parameters}")) else {
                    continue;
                };
                for ticks in 1..=3 {
                    let (problems, seen) = compare(&with, &without, named, ticks);
                    if seen > 0 {
                        effective.insert(*keyword);
                    }
                    let told = |problem| format!("{keyword} {parameters}, {first} on {second}: {problem}");
                    undeclared.extend(problems.into_iter().map(told));
                }
            }
        }
    }
    assert!(undeclared.is_empty(), "{undeclared:#?}");
    let idle: Vec<_> = EFFECTS.iter().copied().filter(|keyword| !effective.contains(keyword)).collect();
    assert_eq!(idle, IDLE);
}
