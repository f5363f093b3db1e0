//! Tests of attainable goals, and of the amounts that they require.

use super::*;
use base::Seed;

const SPRITES: &str = "gem > Immovable\nice > Immovable\nsnow > Immovable\nghost > Immovable\nkey > Resource limit=2\n\
                       safe > Door\nkiln > SpawnPoint stype=brick\nbrick > Passive\nhero > MovingAvatar";
const MAPPING: &str = "g > gem\ni > ice\nk > key\ns > safe\nn > kiln\nA > hero";
const RULES: &str = "gem hero > killSprite\nice hero > transformTo stype=snow\nkey hero > collectResource\n\
                     safe hero > killIfOtherHasMore resource=key limit=2 subtract=True";

/// Checks whether each termination is attainable, and whether the game can be won and lost.
#[track_caller]
fn check(rules: &str, terminations: &str, expect: &[Attainable], ends: (bool, bool)) {
    let analysis = Analysis::of(&game(SPRITES, MAPPING, rules, terminations));
    let attainable: Vec<Attainable> = analysis.goals().iter().map(|goal| goal.attainable).collect();
    assert_eq!(attainable, expect, "{terminations}");
    assert_eq!((analysis.can_win(), analysis.can_lose()), ends, "{terminations}");
}

#[test]
fn attainable_terminations() {
    use Attainable::{AtOnce, FromStart, InPlay, Never};
    check(RULES, "SpriteCounter stype=gem win=True", &[InPlay], (true, false));
    // Nothing removes a brick, and nothing kills the hero.
    let ends = "SpriteCounter stype=brick win=True\nSpriteCounter stype=hero win=False";
    check(RULES, ends, &[FromStart, FromStart], (false, false));
    // Ice becomes snow, so the sum of both stays the same.
    let ends = "MultiSpriteCounter stype1=ice stype2=snow win=True\nSpriteCounter stype=ice win=False";
    check(RULES, ends, &[FromStart, InPlay], (false, true));
    let ends = "SpriteCounterMore stype=snow limit=3 win=True\nSpriteCounterMore stype=gem limit=3 win=False";
    check(RULES, ends, &[InPlay, FromStart], (true, false));
    check(RULES, "SpriteCounterMore stype=brick limit=40 win=True", &[InPlay], (true, false));
    // There is never a ghost.
    let ends = "SpriteCounterMore stype=ghost limit=1 win=True\nSpriteCounter stype=ghost win=False";
    check(RULES, ends, &[Never, AtOnce], (false, true));
    // A termination that ends every game in its first tick hides the terminations after it.
    let ends = "Timeout limit=0 win=False\nSpriteCounter stype=gem win=True\nTimeout limit=3000 win=True";
    check(RULES, ends, &[AtOnce, InPlay, Never], (false, true));
    let ends = "SpriteCounter stype=gem limit=-1 win=True\nMultiSpriteCounter stype1=gem limit=2 win=True";
    check(RULES, ends, &[Never, InPlay], (true, false));
    // A player without a score loses.
    check(RULES, "Timeout limit=9 count_score=True", &[InPlay], (true, true));
    // A level without bricks is won when the gem is removed, not earlier.
    let ends = "StopCounter stype1=gem min=True\nSpriteCounter stype=brick win=True";
    check(RULES, ends, &[InPlay], (true, false));
    let ends = "SpriteCounter stype=ghost win=False canEnd=False\nTimeout limit=9 win=True";
    check(RULES, ends, &[InPlay, InPlay], (true, true));
    // The key of a lock cannot be obtained, either in the required amount or at all.
    check(RULES, "SpriteCounter stype=safe win=True", &[InPlay], (true, false));
    let dear = RULES.replace("limit=2 subtract", "limit=3 subtract");
    check(&dear, "SpriteCounter stype=safe win=True", &[FromStart], (false, false));
    let keyless = RULES.replace("key hero > collectResource\n", "");
    check(&keyless, "SpriteCounter stype=safe win=True", &[FromStart], (false, false));
    // A timed effect may also remove the bricks.
    let timed = format!("{RULES}\nhero TIME > killAll stype=brick timer=50");
    check(&timed, "SpriteCounter stype=brick win=True", &[InPlay], (true, false));
}

#[test]
fn resources_are_given_taken_and_asked_for() {
    let analysis = Analysis::of(&game(SPRITES, MAPPING, RULES, "SpriteCounter stype=safe win=True"));
    let [key] = analysis.resources() else { panic!("{:?}", analysis.resources()) };
    assert_eq!((key.limit, key.needed, key.obtainable), (2, 2, true));
    assert_eq!(key.givers, [(named(&analysis, "key"), 1)]);
    assert_eq!(key.takers, [(named(&analysis, "safe"), 2)]);
}

#[test]
fn distances_from_goals() {
    let ends = "MultiSpriteCounter stype1=gem stype2=ice limit=1 win=True\nSpriteCounterMore stype=snow limit=4 win=True\n\
                Timeout limit=30 win=False";
    let analysis = Analysis::of(&game(SPRITES, MAPPING, RULES, ends));
    let game = analysis.game();
    let mut state = game.start(&game.level("Agig\n").unwrap(), Seed::from_text("missing"));
    let missing = |state: &State| -> Vec<u32> {
        analysis.goals().iter().map(|goal| analysis.missing(goal, state)).collect()
    };
    assert_eq!(missing(&state), [2, 4, 31]);
    game.step(&mut state, engine::Action::Right);
    game.step(&mut state, engine::Action::Right);
    assert_eq!(missing(&state), [0, 3, 29]);
}

/// In reference mode, an undeclared sprite at the edge stops the game in the first tick. No effect belongs to that rule.
#[test]
fn a_game_with_an_undeclared_sprite_at_the_edge_has_a_highest_score() {
    let source = "BasicGame\n  SpriteSet\n    hero > MovingAvatar\n  LevelMapping\n    A > hero\n  InteractionSet\n    \
                  nope EOS > killSprite\n  TerminationSet\n    Timeout limit=9\n";
    let game = Game::from_source_as_reference(source).unwrap();
    let level = game.level("A").unwrap();
    let start = game.start(&level, Seed::from_text("edge"));
    assert_eq!(Analysis::of(&game).most_points(&start), Some(0));
}
