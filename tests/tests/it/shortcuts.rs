//! Tests of shortcuts within a step. Sprites that a step skips, because their movement is predictable, end up
//! at the same positions as without the shortcut.

use base::{Sampler, Seed};
use engine::{Action, Game, Level, Limit, Outcome, State};
use proptest::prelude::*;
use std::path::Path;
use tests::any_game::any_game;
use tests::choices::Choices;
use tests::{games, public_games, sweep, workspace_root};

/// Plays random actions twice, with and without shortcuts. The two episodes must be identical.
fn play(name: &str, game: &Game, level: &Level, ticks: usize) {
    let mut sampler = Seed::from_text(name).child("actions", 0).sampler();
    play_actions(name, game, level, (0..ticks).map(|_| *sampler.choose(&Action::ALL)));
}

/// Plays the same actions with and without shortcuts, and checks that the two episodes are equal. Returns the last
/// state of the episode with shortcuts. Stops early if the work limit ends either episode.
fn play_actions(name: &str, game: &Game, level: &Level, actions: impl Iterator<Item = Action>) -> State {
    let mut state = game.start(level, Seed::from_text(name).child("chance", 0));
    let mut plain = state.clone();
    for action in actions {
        if state.is_over() {
            break;
        }
        let outcomes = (game.step(&mut state, action), game.step_unscheduled(&mut plain, action, &mut ()));
        if [outcomes.0, outcomes.1].contains(&Outcome::Stopped(Limit::Work)) {
            // Sleeping sprites cost no work, but waking them up does.
            return state;
        }
        assert_eq!(outcomes.0, outcomes.1, "{name}");
        if state.state_hash() != plain.state_hash() {
            panic!("{name}, tick {}: {}", state.tick(), difference(game, &state, &plain));
        }
    }
    let written = |state: &State| format!("{:?} {:?}", game.records(state), state.search_key(game));
    assert_eq!(written(&state), written(&plain), "{name}");
    state.recount(game).unwrap_or_else(|found| panic!("{name}: {found}"));
    state
}

/// Returns the first sprites that differ.
fn difference(game: &Game, one: &State, two: &State) -> String {
    let (ones, twos) = (game.records(one), game.records(two));
    let pairs = ones.iter().zip(&twos).find(|(one, two)| format!("{one:?}") != format!("{two:?}"));
    format!("{} and {} sprites, {pairs:#?}", ones.len(), twos.len())
}

fn play_all(folder: &Path, ticks: usize) {
    for (name, game, levels) in games(folder) {
        for (number, level) in levels.iter().enumerate() {
            play(&format!("{name} {number}"), &game, level, ticks);
        }
    }
}

#[test]
fn shortcuts_change_nothing_in_the_corpus() {
    play_all(&workspace_root().join("corpora"), 500);
}

#[test]
fn shortcuts_change_nothing_in_public_games() {
    let Some(folder) = public_games() else { return };
    play_all(&folder, 400);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn shortcuts_change_nothing_in_any_game(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let any = any_game(&mut Choices::new(&bytes));
        if let Ok(game) = Game::from_source_as_reference(&any.source)
            && let Ok(level) = game.level(&any.level)
        {
            play(&format!("{}\n{}\n", any.source, any.level), &game, &level, 60);
        }
    }
}

/// Creates a game in which sprites walk into obstacles that put them back, with many possible interruptions.
fn crowded_house(sampler: &mut Sampler) -> (String, String) {
    let mut source = "BasicGame square_size=10\n  SpriteSet\n    wall > Immovable\n    fence > Immovable\n    rock > Passive\n"
        .to_owned();
    source += *sampler.choose(&["    slab > Immovable\n", "    slab > Immovable wMult=2\n"]);
    source +=
        &format!("    shot > Missile orientation={}\n", sampler.choose(&["UP", "LEFT", "RIGHT speed=0.3"]));
    source +=
        "    stone > Missile orientation=DOWN speed=0.5\n    door > Portal stype=exit\n    exit > Portal\n";
    source += &format!(
        "    nest > SpawnPoint stype={} cooldown=3 prob=0.5\n    walker >\n",
        sampler.choose(&["shot", "cat", "fence"])
    );
    for walker in ["cat", "dog"] {
        let class =
            sampler.choose(&["RandomNPC", "Chaser stype=hero", "Fleeing stype=dog", "RandomNPC cons=3"]);
        let speed = sampler.choose(&["1", "1", "0.5", "0.25", "2"]);
        source +=
            &format!("      {walker} > {class} speed={speed} cooldown={}\n", sampler.choose(&[0, 1, 2]));
    }
    let avatar =
        sampler.choose(&["MovingAvatar", "ShootAvatar stype=shot", "OngoingAvatar", "FlakAvatar stype=shot"]);
    source += &format!("      hero > {avatar} speed={}\n  LevelMapping\n", sampler.choose(&["1", "0.5"]));
    let mapping =
        ["wall", "fence", "rock", "slab", "stone", "shot", "door", "exit", "nest", "cat", "dog", "hero"];
    for (symbol, stype) in ('a'..).zip(mapping) {
        source += &format!("    {symbol} > {stype}\n");
    }
    source += "    x > wall cat\n  InteractionSet\n";
    let first = ["walker", "walker", "cat", "dog", "hero", "rock", "shot", "wall"];
    let second =
        ["wall", "wall", "fence", "slab", "rock", "cat", "hero", "shot", "stone", "EOS", "door", "walker"];
    let effects = [
        "stepBack scoreChange=1",
        "killSprite",
        "killBoth",
        "bounceForward",
        "transformTo stype=fence",
        "transformToAll stype=wall stypeTo=fence",
        "undoAll",
        "cloneSprite",
        "pullWithIt",
        "turnAround",
        "attractGaze",
        "teleportToExit",
        "killAll stype=fence",
        "spawn stype=cat",
        "shieldFrom stype=wall ftype=stepback",
        "addTimer timer=3 ftype=transformToAll stype=fence stypeTo=rock",
    ];
    for _ in 0..sampler.between(2, 9) {
        let effect = match sampler.below(5) {
            0..=2 => "stepBack",
            3 => "stepBack pixelPerfect=True",
            _ => *sampler.choose(&effects),
        };
        source += &format!("    {} {} > {effect}\n", sampler.choose(&first), sampler.choose(&second));
    }
    source += "  TerminationSet\n    SpriteCounter stype=exit limit=-5 win=True\n";
    let (columns, rows) = (sampler.between(3, 9), sampler.between(3, 7));
    let hero = sampler.below(columns * rows);
    let dense = sampler.between(1, 4);
    let mut level = String::new();
    for cell in 0..columns * rows {
        level.push(match cell {
            cell if cell == hero => 'l',
            _ if sampler.ratio(dense, 6) => *sampler.choose(&"aaabcdefghijkjkx".chars().collect::<Vec<_>>()),
            _ => ' ',
        });
        if (cell + 1) % columns == 0 {
            level.push('\n');
        }
    }
    (source, level)
}

#[test]
fn shortcuts_change_nothing_for_walks_into_walls() {
    let mut sampler = sweep::seed("walls").sampler();
    let (mut played, cases) = (0, sweep::many_cases(12_000));
    for _ in 0..cases {
        let (source, level) = crowded_house(&mut sampler);
        if let Ok(game) = Game::from_source_as_reference(&source)
            && let Ok(parsed) = game.level(&level)
        {
            play(&format!("{source}\n{level}\n"), &game, &parsed, 40);
            played += 1;
        }
    }
    assert!(played * 100 > cases * 97, "{played} of {cases}");
}

/// After the rule that puts the avatar back has run, an effect moves the avatar against a wall. The rule does
/// not run again.
#[test]
fn a_move_against_a_wall_is_not_put_back_later() {
    let source = "\
BasicGame square_size=10
    SpriteSet
        wall > Immovable
        egg > Immovable
        nest > Immovable
        dart > Missile orientation=LEFT
        avatar > MovingAvatar speed=0.5
    LevelMapping
        w > wall
        d > dart
        e > egg nest
        A > avatar
    InteractionSet
        avatar wall > stepBack
        avatar dart > turnAround
        egg nest > stepBack scoreChange=1
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("Ad e\nw   \n    \n").expect("it loads");
    let state = play_actions("turn", &game, &level, [Action::Nil; 4].into_iter());
    assert_eq!(state.score(), 4.0);
}

/// The avatar and a cat walk into the same wall, and meet inside the wall before they are put back.
#[test]
fn two_sprites_can_meet_in_a_wall() {
    let source = "\
BasicGame square_size=10
    SpriteSet
        wall > Immovable
        walker >
            cat > Chaser stype=avatar
            avatar > MovingAvatar
    LevelMapping
        w > wall
        c > cat
        A > avatar
    InteractionSet
        avatar cat > killSprite
        walker wall > stepBack
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("Awc\n").expect("it loads");
    let state = play_actions("meet", &game, &level, [Action::Right].into_iter());
    assert_eq!(state.outcome(), Outcome::Lost);
}

/// The rule that puts the dart back does not change the score. However, the preceding rule, in which the dart
/// is the second sprite, is worth a point.
#[test]
fn steps_that_score_are_not_skipped() {
    let source = "\
BasicGame square_size=10
    SpriteSet
        wall > Immovable
        dart > Missile orientation=LEFT
        avatar > MovingAvatar
    LevelMapping
        w > wall
        d > dart
        A > avatar
    InteractionSet
        wall dart > stepBack scoreChange=1
        dart wall > stepBack
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("wd A\n").expect("it loads");
    let state = play_actions("points", &game, &level, [Action::Nil; 5].into_iter());
    assert_eq!(state.score(), 4.0);
}

/// A kite that is off the board moves onto it, where a rule puts it back. When the edge rules run, the kite
/// is on the board.
#[test]
fn sprites_off_the_board_do_not_sleep() {
    let source = "\
BasicGame square_size=10
    SpriteSet
        fence > Immovable
        kite > Missile orientation=UP
        avatar > MovingAvatar
    LevelMapping
        k > fence kite
        A > avatar
    InteractionSet
        kite fence > stepBack
        kite EOS > reverseDirection
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("k \n A\n").expect("it loads");
    let state = play_actions("edge", &game, &level, [Action::Nil; 8].into_iter());
    assert_eq!(state.outcome(), Outcome::Ongoing);
}

/// A door briefly moves one arrow to the other. Until the door is gone, both arrows are put back to their
/// positions.
#[test]
fn sprites_do_not_sleep_on_briefly_blocked_cells() {
    let source = "\
BasicGame square_size=10
    SpriteSet
        lamp > Immovable
        door > Portal stype=lamp
        arrow > Missile orientation=DOWN speed=0.3
        avatar > MovingAvatar
    LevelMapping
        a > arrow lamp
        d > arrow door
        A > avatar
    InteractionSet
        arrow door > teleportToExit
        arrow arrow > stepBack
        door avatar > killSprite
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("a  dA\n     \n     \n     \n").expect("it loads");
    let actions = [Action::Nil; 5].into_iter().chain([Action::Left]).chain([Action::Nil; 4]);
    let state = play_actions("exits", &game, &level, actions);
    assert_eq!(state.outcome(), Outcome::Ongoing);
}

/// A type that spreads into its own kind stops the tick during the updates. Flying sprites that have not been
/// updated yet stay in place.
#[test]
fn a_stop_amid_the_updates_finds_all_sprites_in_place() {
    let source = "\
BasicGame
    SpriteSet
        dart > Missile orientation=RIGHT speed=0.1
        oven > SpawnPoint stype=fire cooldown=9
        fire > Spreader spreadprob=1
        kite > Missile orientation=LEFT speed=0.1
        avatar > MovingAvatar
    LevelMapping
        d > dart
        o > oven
        k > kite
        A > avatar
    InteractionSet
        avatar kite > killSprite
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("d  o  k\nA      \n").expect("it loads");
    let state = play_actions("stop", &game, &level, [Action::Nil; 5].into_iter());
    assert_eq!((state.outcome(), state.tick()), (Outcome::Stopped(Limit::SpawnIntoUpdatedType), 2));
}

/// The avatar's own update stops the tick. After that, no other sprite is updated, not even one that flies.
#[test]
fn a_stop_by_the_avatar_ends_the_updates() {
    let source = "\
BasicGame
    SpriteSet
        stray > RandomNPC
        dart > Missile orientation=LEFT speed=0.1
        avatar > BirdAvatar orientedImg=bird
    LevelMapping
        s > stray
        d > dart
        A > avatar
    InteractionSet
        avatar dart > killSprite
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("s    d\nA     \n      \n").expect("it loads");
    let actions = [Action::Nil, Action::Nil, Action::Left, Action::Use, Action::Use, Action::Use];
    let state = play_actions("stop", &game, &level, actions.into_iter());
    assert_eq!((state.outcome(), state.tick()), (Outcome::Stopped(Limit::UnfitSprite), 4));
}
