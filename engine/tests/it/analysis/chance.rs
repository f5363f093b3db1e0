//! Tests the smallest games in which randomness decides something, or nothing, for each class and effect that
//! draws.

use super::*;
use engine::Action;

/// Returns the analysis of a game with the given sprites, rules and terminations, and with paths (`obs=wall`), the
/// player's `hero` and an inert `rock`.
fn with(sprites: &str, rules: &str, ends: &str) -> Analysis {
    let source = format!(
        "BasicGame obs=wall\n  SpriteSet\n    hero > MovingAvatar\n    rock > Immovable\n{}  LevelMapping\n    A > hero\n    r > rock\n    x > one\n    y > two\n  InteractionSet\n{}  TerminationSet\n{}",
        lines(sprites),
        lines(rules),
        lines(ends)
    );
    Analysis::of(&Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}")))
}

fn lines(text: &str) -> String {
    text.lines().map(|line| format!("    {}\n", line.trim_end())).collect()
}

/// Returns whether randomness decides nothing in any level, and whether it decides nothing in a level with one sprite
/// of each type.
fn certain(sprites: &str, rules: &str, ends: &str) -> (bool, bool) {
    let two = if sprites.contains("two >") { "" } else { "\ntwo > Immovable" };
    let analysis = with(&format!("{sprites}{two}"), rules, ends);
    let level = analysis.game().level("A.x.y.r...\n".replace('.', " ").as_str()).unwrap();
    let (any, this) = (analysis.is_deterministic(), analysis.is_deterministic_in(&level));
    assert_eq!(any, !analysis.is_stochastic());
    assert!(this || !any, "what holds in any level holds in one");
    if this {
        plays_alike(&analysis, &level);
    }
    (any, this)
}

/// Plays the same keys under several seeds, and checks that everything except the random numbers stays equal.
fn plays_alike(analysis: &Analysis, level: &engine::Level) {
    let game = analysis.game();
    let seed = base::Seed::from_text("alike");
    for run in 0..8 {
        let mut sampler = seed.child("keys", run).sampler();
        let mut states = [0, 1, 2].map(|number| game.start(level, seed.child("chance", number)));
        for _ in 0..40 {
            let action = *sampler.choose(&Action::ALL);
            let outcomes = states.each_mut().map(|state| game.step(state, action));
            let [first, others @ ..] = &states;
            assert!(others.iter().all(|state| game.records(state) == game.records(first)));
            assert!(outcomes.iter().all(|outcome| *outcome == outcomes[0]));
        }
    }
}

const END: &str = "Timeout limit=99 win=True";

#[test]
fn classes_that_draw() {
    for (sprite, expected) in [
        ("Immovable", true),
        ("Missile orientation=LEFT", true),
        ("Flicker limit=3", true),
        ("ErraticMissile orientation=LEFT speed=1", true),
        ("RandomMissile speed=1", false),
        ("RandomMissile speed=1 orientation=LEFT", true),
        ("Spreader stype=rock spreadprob=1", true),
        ("Spreader stype=rock spreadprob=0", true),
        ("Spreader stype=rock spreadprob=0.5", false),
        ("SpawnPoint stype=rock prob=1 cooldown=4", true),
        ("SpawnPoint stype=rock prob=0", true),
        ("SpawnPoint stype=rock prob=0.5", false),
        ("SpawnPointMultiSprite stypes=rock,two prob=1 cooldown=4", true),
        ("SpawnPointMultiSprite stypes=rock,two prob=0.5", false),
        ("Bomber stype=rock prob=1 cooldown=4 orientation=LEFT speed=1", true),
        ("Bomber stype=rock prob=0.5", false),
        ("RandomBomber stype=rock prob=0", false),
        ("BomberRandomMissile stypeMissile=rock prob=1 cooldown=4", true),
        ("BomberRandomMissile stypeMissile=rock,two prob=1 cooldown=4", false),
        ("RandomNPC", false),
        ("RandomInertial", false),
        ("Chaser stype=hero", false),
        ("Fleeing stype=hero", false),
        ("LOSChaser stype=hero", false),
        ("AlternateChaser stype1=hero", false),
        ("RandomAltChaser stype1=hero epsilon=0", false),
        ("PathChaser stype=hero", true),
        ("PathAltChaser stype1=hero", true),
        ("PathAltChaser stype1=hero stype2=rock", true),
        ("PathAltChaser stype1=hero,rock", false),
        ("PathAltChaser stype1=hero randomTarget=True", false),
        ("RandomPathAltChaser stype1=hero epsilon=0", true),
        ("RandomPathAltChaser stype1=hero epsilon=0.1", false),
        ("Walker", false),
        ("WalkerJumper probability=0.5", false),
        ("WalkerJumper probability=0", true),
    ] {
        let found = certain(&format!("one > {sprite}"), "", END);
        // `A` is the only avatar, unless the game has another avatar with that character.
        assert_eq!(found.1, expected, "{sprite}: {found:?}");
    }
}

#[test]
fn a_path_to_the_avatar_always_ends_somewhere() {
    let chaser = "one > PathChaser stype=hero";
    for (sprites, rules, ends, expected) in [
        // A dead avatar stays on the board, and its hunters come to it.
        (chaser, "hero one > killSprite", END, true),
        (chaser, "hero one > killBoth", END, true),
        (chaser, "hero one > subtractHealthPoints", END, true),
        (chaser, "hero rock > killAll stype=hero", END, true),
        // These effects remove avatars from the board, or are not known to leave them there.
        (chaser, "rock hero > transformTo stype=two killSecond=True", END, false),
        (chaser, "hero rock > transformTo stype=two", END, false),
        (chaser, "one hero > changeResource resource=coin killResource=True", END, false),
        (chaser, "hero rock > removeScore killSecond=True", END, true),
        (chaser, "rock hero > removeScore stype=hero killSecond=True", END, false),
        // A different avatar, which is not a hero, replaces the hero.
        (chaser, "hero rock > transformTo stype=ghost", END, false),
        // The game ends with the last hero, whether the game is won or lost.
        (chaser, "hero rock > transformTo stype=two", "SpriteCounter stype=hero win=False", true),
        (
            chaser,
            "hero rock > transformTo stype=two",
            "MultiSpriteCounter stype1=hero limit=0 win=True",
            true,
        ),
        // The game does not end with the last hero: `two` must be gone as well, or the limit is never reached.
        (
            chaser,
            "hero rock > transformTo stype=two",
            "MultiSpriteCounter stype1=hero stype2=two limit=0 win=True",
            false,
        ),
        (chaser, "hero rock > transformTo stype=two", "SpriteCounter stype=hero limit=-1 win=False", false),
        (
            chaser,
            "hero rock > transformTo stype=two",
            "SpriteCounterMore stype=hero limit=1 win=False",
            false,
        ),
        (
            chaser,
            "hero rock > transformTo stype=two",
            "StopCounter stype1=rock limit=0\nSpriteCounter stype=hero win=False",
            false,
        ),
        (
            "coat > Immovable\none > PathChaser stype=hero",
            "hero rock > transformTo stype=two\ntwo rock > addTimer timer=3 ftype=killAll stype=one",
            "SpriteCounter stype=coat win=False",
            false,
        ),
    ] {
        let extra = "\nghost > MovingAvatar\ncoin > Resource limit=3";
        let found = certain(&format!("{sprites}{extra}"), rules, ends);
        assert_eq!(found.1, expected, "{sprites}\n{rules}\n{ends}: {found:?}");
    }
}

#[test]
fn relatives_of_a_target_count_where_it_is_gone() {
    let analysis = |target: &str, rules: &str| {
        let game = game(
            &format!(
                "rock > Immovable\nbeast > PathChaser stype={target}\npeople >\n  hero > MovingAvatar\n  ghost > MovingAvatar\n  sheep > Immovable"
            ),
            "A > hero\nb > beast\nr > rock\ns > sheep",
            rules,
            END,
        );
        let game = Game::from_source(&format!(
            "BasicGame obs=wall\n{}",
            engine::syntax::print(game.description()).split_once('\n').unwrap().1
        ));
        Analysis::of(&game.unwrap())
    };
    let (turns, kills) = ("hero rock > transformTo stype=ghost", "sheep beast > killSprite");
    for (target, rules, level, expected) in [
        ("people", turns, "A b r", true),
        // A ghost is only a relative of people.
        ("hero", turns, "A b r", false),
        ("people", kills, "A b s", true),
        ("sheep", kills, "A b s", false),
        ("sheep", turns, "A b s", true),
        // Without sheep, the beast wanders until there is a sheep.
        ("sheep", turns, "A b r", false),
        ("people", "hero rock > transformTo stype=rock", "A b s", true),
    ] {
        let analysis = analysis(target, rules);
        let level = analysis.game().level(level).unwrap();
        assert_eq!(analysis.is_deterministic_in(&level), expected, "{target}, {rules}");
        if expected {
            plays_alike(&analysis, &level);
        }
    }
}

#[test]
fn exits_and_directions_that_come_from_elsewhere() {
    let exits = "one > Portal stype=rock\ntwo > Immovable";
    let spawner = "one > SpawnPoint stype=rock prob=0\ntwo > Immovable";
    let redirects = "hero one > teleportToExit\nhero rock > updateSpawnType stype=two spawnPoint=one";
    let unset = "one > Missile orientation=LEFT speed=1\ntwo > RandomMissile orientation=LEFT speed=1";
    let passes = "two one > transformTo stype=two forceOrientation=True";
    for (sprites, rules, level, expected) in [
        (exits, "hero one > teleportToExit", "A x  y y r", true),
        (exits, "hero one > teleportToExit", "A x  r  r", false),
        // The spawner comes to lead to either of two sprites.
        (spawner, redirects, "A x  y y r", false),
        (unset, passes, "A x  y", true),
        // A direction that is still to be drawn may pass to another missile.
        (
            &unset.replace("Missile orientation=LEFT speed=1\n", "RandomMissile speed=1\n"),
            passes,
            "A y",
            true,
        ),
        (
            &unset.replace("Missile orientation=LEFT speed=1\n", "RandomMissile speed=1\n"),
            passes,
            "A x y",
            false,
        ),
    ] {
        let analysis = with(sprites, rules, END);
        let level = analysis.game().level(level).unwrap();
        assert_eq!(analysis.is_deterministic_in(&level), expected, "{sprites}\n{rules}");
        if expected {
            plays_alike(&analysis, &level);
        }
    }
}
