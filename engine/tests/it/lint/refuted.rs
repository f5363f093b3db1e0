//! Tests wrong claims of the analysis, each with the smallest game that refuted the claim. The property test
//! of all claims found these games.

use base::Seed;
use engine::analysis::Missing;
use engine::describe::{Guide, describe};
use engine::{Action, Analysis, Game, Outcome};

/// Returns a game with these sections.
#[track_caller]
fn game(sprites: &str, mapping: &str, rules: &str, ends: &str) -> Game {
    let lines = |text: &str| text.split("; ").map(|line| format!("        {line}\n")).collect::<String>();
    let source = format!(
        "BasicGame\n    SpriteSet\n{}    LevelMapping\n{}    InteractionSet\n{}    TerminationSet\n{}",
        lines(sprites),
        lines(mapping),
        lines(rules),
        lines(ends)
    );
    Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"))
}

fn warns(game: &Game, code: &str) -> bool {
    game.warnings().iter().any(|warning| warning.code == code)
}

/// Returns the message of the warning about the level, if there is one.
#[track_caller]
fn told(game: &Game, level: &str) -> String {
    let level = game.level(level).unwrap_or_else(|problems| panic!("{problems}"));
    level.warnings().first().map_or(String::new(), |warning| warning.message.clone())
}

const CLOCK: &str = "Timeout limit=9 win=True";

#[test]
fn some_effects_move_what_stands_still() {
    let meet = |rule: &str| {
        let rules = format!("vase wall > {rule}; vase vase > killSprite");
        game(
            "vase > Immovable; jar > Immovable; hero > MovingAvatar",
            "v > vase wall; A > hero",
            &rules,
            CLOCK,
        )
    };
    assert!(warns(&meet("stepBack"), "never-fires"), "two vases never share a cell");
    assert!(!warns(&meet("turnAround"), "never-fires"), "two steps down, onto another vase");
    // A speed sets the vase off.
    let sprites = "vase > Missile orientation=RIGHT speed=0; jar > Immovable; hero > MovingAvatar";
    let set_off = |rule: &str| {
        game(
            sprites,
            "v > vase; j > jar; A > hero",
            &format!("hero jar > {rule}; vase wall > killSprite"),
            CLOCK,
        )
    };
    assert!(warns(&set_off("stepBack"), "never-fires"));
    assert!(!warns(&set_off("setSpeedForAll stype=vase value=1"), "never-fires"));
}

#[test]
fn stationary_sprites_are_still_moved_by_their_orientation() {
    let of = |class: &str| {
        let sprites = format!("owl > {class} stationary=True; hero > MovingAvatar");
        describe(&game(&sprites, "o > owl; A > hero", "hero owl > stepBack", CLOCK))
    };
    assert!(!of("RandomNPC").contains("The owl "));
    for class in ["RandomMissile", "Walker", "Missile orientation=UP"] {
        assert!(
            of(class).contains("The owl moves") || of(class).contains("The owl wanders"),
            "{}",
            of(class)
        );
    }
    let space = |avatar: &str| {
        let game = game(&format!("hero > {avatar}"), "A > hero", "hero wall > stepBack", CLOCK);
        Guide::of(&game).kind[2].clone()
    };
    assert_eq!(space("MovingAvatar stationary=True"), "Space: you stay where you are.");
    assert_ne!(space("OngoingAvatar stationary=True"), "Space: you stay where you are.");
}

#[test]
fn an_avatar_that_only_shoots_drifts_with_continuous_physics() {
    let of = |physics: &str| {
        let sprites = format!("shot > Missile; hero > ShootOnlyAvatar stype=shot {physics}");
        Guide::of(&game(&sprites, "A > hero", "shot wall > killSprite", CLOCK)).controls[0].clone()
    };
    assert!(of("").starts_with("You are the hero: you stay where you are"));
    assert!(of("physicstype=CONT").starts_with("You are the hero: you drift, and no key steers you"));
}

#[test]
fn walls_slow_down_to_the_speed_of_gravity() {
    let of = |effect: &str| {
        let sprites = "stone > Passive gravity=2; hero > MovingAvatar";
        game(sprites, "s > stone; A > hero", &format!("stone hero > {effect}"), CLOCK)
    };
    assert!(warns(&of("stepBack"), "ignored-parameter"));
    assert!(!warns(&of("wallStop"), "ignored-parameter"));
}

#[test]
fn the_first_termination_that_holds_decides_the_first_tick() {
    let of = |ends: &str| {
        let game = game(
            "gem > Immovable; owl > Immovable; hero > MovingAvatar",
            "g > gem; o > owl; A > hero",
            "gem hero > killSprite; owl hero > killSprite",
            ends,
        );
        told(&game, "A \n")
    };
    let won = "the level is won in its first tick: with 0 `gem`, a SpriteCounter holds";
    assert_eq!(of("SpriteCounter stype=gem win=True; SpriteCounter stype=owl win=False"), won);
    let over = "the level is over in its first tick: with 0 `owl`, a SpriteCounter holds";
    let kinds = "MultiSpriteCounterSubTypes stype1=hero limit=1 subTypesNum=1 win=True";
    assert_eq!(of(&format!("{kinds}; SpriteCounter stype=owl win=False")), over);
}

/// The available actions do not include pressing no key, which may have a different outcome.
#[test]
fn a_first_tick_without_a_key_counts() {
    let game = game(
        "gem > Immovable; mist > Immovable; hero > MovingAvatar",
        "A > mist hero",
        "hero mist > killSprite",
        "SpriteCounter stype=hero; SpriteCounter stype=gem win=True",
    );
    let over = "the level is over in its first tick: with 0 `gem`, a SpriteCounter holds";
    assert_eq!(told(&game, "  \n A\n"), over);
}

#[test]
fn the_first_tick_may_make_or_remove_what_is_counted() {
    // The hero is beside the egg, and turns it into an owl at once.
    let sprites = "egg > Immovable; owl > Immovable; hero > MovingAvatar";
    let of = |rule: &str| game(sprites, "e > egg; A > hero", rule, "SpriteCounter stype=owl win=True");
    let turn = of("egg hero > transformTo stype=owl");
    assert_eq!(told(&turn, "Ae\n"), "");
    assert!(told(&turn, "A e\n").contains("is won in its first tick"));
    let every = &turn.warnings().iter().find(|warning| warning.code == "ends-at-once").unwrap().message;
    assert!(every.ends_with("unless a rule makes such a sprite in that tick"), "{every}");
    // The avatar's shot makes another sprite in the tick in which it appears.
    let sprites = "pod > SpawnPoint stype=owl; owl > Immovable; hero > FlakAvatar stype=pod";
    let chain = game(sprites, "A > hero", "owl hero > killSprite", "SpriteCounter stype=owl win=True");
    assert!(!warns(&chain, "ends-at-once"));
}

#[test]
fn shots_that_levels_place_move_by_themselves() {
    let of = |mapping: &str| {
        let sprites = "shot > Missile orientation=DOWN; bat > Immovable; hero > ShootAvatar stype=shot";
        let rules = "bat shot > killBoth; hero wall > stepBack";
        Analysis::of(&game(sprites, mapping, rules, "SpriteCounter stype=bat win=True")).is_turn_based()
    };
    assert!(of("b > bat; A > hero"));
    assert!(!of("b > bat; A > hero; s > shot"));
}

/// `wallReverse` needs a partner, so it stops nothing at the edge.
#[test]
fn the_edge_is_no_wall() {
    let of = |rule: &str| {
        let sprites = "jar > Immovable; key > Immovable; hero > MovingAvatar";
        let rules = format!("hero wall > stepBack; hero EOS > {rule}; jar hero > killSprite");
        let game = game(sprites, "j > jar; A > hero; w > wall", &rules, "SpriteCounter stype=jar win=True");
        let level = game.level("Awj\n").unwrap();
        (Analysis::of(&game).reach(&level).can_win(), describe(&game))
    };
    assert!(!of("stepBack").0);
    for rule in ["wallReverse", "wallStop", "wallBounce"] {
        let (can_win, text) = of(rule);
        assert!(can_win, "{rule}: the hero walks around the wall, outside the board");
        assert!(text.contains("  When you touch the edge of the board, nothing happens."), "{text}");
    }
}

/// Sprites that overlap, or reach into the next cell, make other sprites in every tick.
#[test]
fn sprites_that_breed_do_not_wait_for_the_player() {
    let of = |size: &str, mapping: &str| {
        let sprites = format!("egg > Immovable; hen > Immovable {size}; hero > MovingAvatar");
        Analysis::of(&game(&sprites, mapping, "egg hen > cloneSprite", CLOCK)).is_turn_based()
    };
    assert!(of("", "e > egg; h > hen; A > hero"));
    assert!(!of("", "e > egg hen; A > hero"));
    assert!(!of("wMult=2", "e > egg; h > hen; A > hero"), "an egg lies in the cell beside");
}

/// `transformToAll` also turns sprites that are already gone, each time that it runs in a tick.
#[test]
fn sprites_that_turn_together_may_become_more() {
    let of = |rule: &str| {
        let sprites = "egg > Immovable;     hen > Immovable; hero > MovingAvatar";
        let ends = "MultiSpriteCounter stype1=egg limit=1 win=False";
        Guide::of(&game(sprites, "e > egg; h > hen; A > hero", rule, ends)).losing[0].clone()
    };
    assert!(of("hen hero > transformTo stype=egg").contains(" only 1 "));
    assert!(!of("hero egg > transformToAll stype=hen stypeTo=egg").contains(" only 1 "));
}

/// Sprites that overlap may change later than in the first tick.
#[test]
fn what_lies_together_may_change_later() {
    let of = |rules: &str| {
        let sprites = "egg > Immovable; hen > Immovable; fox > Immovable; hero > MovingAvatar";
        Analysis::of(&game(sprites, "e > egg hen; A > hero", rules, CLOCK)).is_turn_based()
    };
    assert!(of("egg hen > killSprite"));
    assert!(of("egg hen > transformTo stype=fox"));
    assert!(!of("egg hen > subtractHealthPoints value=1"));
    assert!(!of("egg hen > transformTo stype=fox; hen fox > killSprite"), "the hen dies a tick later");
    assert!(!of("egg hen > addTimer timer=3 ftype=killAll stype=hen"));
}

/// An avatar that is not stationary is pushed along its aim.
#[test]
fn avatars_that_aim_may_move() {
    let of = |stationary: &str| {
        let sprites = format!("shot > Missile; hero > AimedAvatar stype=shot {stationary}");
        let guide = Guide::of(&game(&sprites, "A > hero", "shot wall > killSprite", CLOCK));
        (guide.kind[2].clone(), guide.controls[0].contains("the arrow keys move you"))
    };
    assert_eq!(of(""), ("Space: you stay where you are.".to_owned(), false));
    let (space, is_moved) = of("stationary=False");
    assert!(is_moved && space != "Space: you stay where you are.", "{space}");
}

/// An avatar that turns into a parent type is still the player's.
#[test]
fn avatars_of_parent_types_are_updated() {
    let sprites = "jar > Immovable; ghost > MovingAvatar;     pale >; hero > MovingAvatar";
    let rules = "hero jar > transformTo stype=ghost";
    let game = game(sprites, "j > jar; A > hero", rules, CLOCK);
    let message = &game.warnings().iter().find(|warning| warning.code == "parent-sprite").unwrap().message;
    let expected = "`ghost` is a parent type: its sprites are never updated, apart from the player's avatar";
    assert_eq!(message, expected);
}

/// `transformToAll` and `transformIfCount` make singletons even if one exists.
#[test]
fn several_singletons_can_be_made_at_once() {
    let of = |rule: &str| {
        let sprites = "egg > Immovable; hen > Immovable singleton=True; hero > MovingAvatar";
        describe(&game(sprites, "e > egg; A > hero", rule, CLOCK))
            .contains("no other is made until it is gone")
    };
    assert!(of("egg hero > transformTo stype=hen"));
    assert!(!of("hero wall > transformToAll stype=egg stypeTo=hen"));
    assert!(!of("egg hero > transformIfCount stype=hen stypeCount=egg geq=1"));
    assert!(!of("egg hero > transformIfCount stype=egg stypeCount=egg geq=9 estype=hen"));
}

/// A sprite that stands still never gets to the edge, but other sprites of its type may.
#[test]
fn a_sprite_that_stays_inside_is_told_apart_from_its_type() {
    let sprites = "jar > Immovable; hero > ShootAvatar stype=jar";
    let rules = "jar EOS > killSprite; hero wall > stepBack";
    let game = game(sprites, "j > jar; A > hero; w > wall", rules, "SpriteCounter stype=jar win=True");
    let chains = Analysis::of(&game).causes(&game.level("A  \n   \n  j\n").unwrap());
    let missing: Vec<&Missing> = chains[0].obstacles.iter().map(|obstacle| &obstacle.missing).collect();
    assert_eq!(missing, [&Missing::Inside]);
}

/// A dead avatar stays on the board, and all effects except `transformTo` turn it into another sprite in every tick.
#[test]
fn a_dead_avatar_turns_again_and_again() {
    let of = |rule: &str| {
        let sprites = "jar > Immovable; lid > Resource singleton=True; hero > MovingAvatar";
        let ends =
            "MultiSpriteCounter stype1=hero stype2=jar limit=4 min=True win=True; SpriteCounter stype=lid";
        let game = game(sprites, "j > jar; l > lid; A > hero", &format!("hero jar > {rule}"), ends);
        let mut state = game.start(&game.level("Aj l\n").unwrap(), Seed::from_text("dead"));
        for _ in 0..4 {
            game.step(&mut state, Action::Right);
        }
        (state.outcome(), Analysis::of(&game).can_win())
    };
    assert_eq!(of("transformTo stype=jar"), (Outcome::Ongoing, false));
    assert_eq!(of("transformToSingleton stype=jar stype_other=lid"), (Outcome::Won, true));
}

/// Types without a class have no sprites, but sentences about them still name them.
#[test]
fn endings_name_types_that_have_no_sprites() {
    let source = "BasicGame\n    SpriteSet\n        herd >\n        hero > MovingAvatar\n    LevelMapping\n        A > hero\n    \
        InteractionSet\n        hero wall > stepBack\n    TerminationSet\n        SpriteCounter stype=herd win=True\n";
    let game = Game::from_source_as_reference(source).unwrap();
    assert_eq!(Guide::of(&game).winning, ["You win when no herd is left."]);
}

/// A type that is declared below two parents belongs to both when the game is loaded in reference mode.
#[test]
fn a_type_declared_twice_belongs_to_both_groups() {
    let source = "BasicGame\n    SpriteSet\n        flue > Immovable\n            slow >\n            quick >\n        cart > Immovable\n            \
        slow >\n        hero > MovingAvatar\n    LevelMapping\n        s > slow\n        q > quick\n        A > hero\n    InteractionSet\n        \
        flue hero > killSprite\n    TerminationSet\n        SpriteCounter stype=flue win=True\n";
    let game = Game::from_source_as_reference(source).unwrap();
    assert_eq!(Guide::of(&game).groups, ["Any flue means the slow or quick."]);
}

/// A timed effect may also give a resource.
#[test]
fn resources_may_come_by_the_clock() {
    let of = |rule: &str| {
        let sprites = "key > Resource limit=9; jar > Immovable; hero > MovingAvatar";
        let rules = format!("jar hero > killIfOtherHasMore resource=key limit=1; {rule}");
        warns(&game(sprites, "j > jar; A > hero", &rules, CLOCK), "never-fires")
    };
    assert!(of("hero wall > stepBack"));
    assert!(!of("hero TIME > spawnIfHasMore resource=key stype=jar limit=0 spend=-1 timer=3"));
}

/// A sprite that makes infinitely long steps comes back when a coordinate overflows.
#[test]
fn steps_without_limit_lead_anywhere() {
    let gets_up = |speed: &str| {
        let source = format!(
            "BasicGame\n    SpriteSet\n        vase > Immovable\n        hero > MovingAvatar\n    LevelMapping\n        \
            v > vase wall\n        A > hero\n    InteractionSet\n        hero wall > setSpeedForAll stype=vase value={speed}\n        \
            vase wall > turnAround\n    TerminationSet\n        Timeout limit=9 win=True\n"
        );
        let game = Game::from_source_as_reference(&source).unwrap();
        let reach = Analysis::of(&game).reach(&game.level("A    \nw    \n    v\n").unwrap());
        reach.can_be(game.sprite_type("vase").unwrap(), 4 + 5)
    };
    assert!(gets_up("1e999"), "above the place in which it starts");
    assert!(!gets_up("1"));
}

/// With continuous physics, a push is a force, and the sprite keeps gliding.
#[test]
fn forces_set_off_what_has_continuous_physics() {
    let of = |rule: &str, physics: &str| {
        let sprites = format!("jar > Passive {physics}; hero > MovingAvatar");
        let game = game(&sprites, "j > jar; A > hero", &format!("jar hero > {rule}"), CLOCK);
        (describe(&game), Analysis::of(&game).is_turn_based())
    };
    let (text, is_turn_based) = of("bounceForward", "");
    assert!(!text.contains("The jar stands") && is_turn_based, "{text}");
    for rule in ["bounceForward", "turnAround"] {
        let (text, is_turn_based) = of(rule, "physicstype=CONT");
        assert!(text.contains("The jar stands until a rule gives it speed."), "{text}");
        assert!(text.contains("Each tick you act, then the others act"), "{text}");
        assert!(!is_turn_based, "the jar glides on while you wait");
    }
}

/// With continuous physics, a sprite that is made with a direction moves in that direction, oriented or not.
#[test]
fn continuous_physics_moves_what_faces_somewhere() {
    let of = |maker: &str, physics: &str, rule: &str| {
        let sprites = format!("jar > Passive speed=5 {physics}; pod > {maker}; hero > MovingAvatar");
        describe(&game(&sprites, "j > jar; p > pod; A > hero", rule, CLOCK))
    };
    let (idle, step, pod) = ("Immovable", "hero wall > stepBack", "SpawnPoint stype=jar");
    assert!(of(idle, "physicstype=CONT", step).contains("\n  Everything else does nothing by itself."));
    assert!(!of(pod, "", step).contains("The jar "));
    assert!(of(pod, "physicstype=CONT", step).contains("The jar moves straight ahead"));
    assert!(
        of(idle, "physicstype=CONT", "jar hero > flipDirection").contains("The jar moves straight ahead")
    );
    // A singleton takes over an orientation.
    let taking = "hero pod > transformToSingleton stype=jar stype_other=pod takeOrientation=True";
    assert!(of(idle, "", taking).contains("The jar moves straight ahead"));
}

/// Neither `w` nor `A` is unused merely because the other character also stands for an avatar.
#[test]
fn a_wall_may_be_the_avatar() {
    for mapping in ["j > jar", "j > jar\n        A > avatar"] {
        let source = format!(
            "BasicGame\n    SpriteSet\n        jar > Immovable\n        wall > HorizontalAvatar\n    LevelMapping\n        {mapping}\n    \
            InteractionSet\n        jar wall > killSprite\n    TerminationSet\n        SpriteCounter stype=jar win=True\n"
        );
        let game = Game::from_source_as_reference(&source).unwrap();
        let analysis = Analysis::of(&game);
        let avatars: Vec<&str> = analysis.avatars().iter().map(|avatar| game.name(avatar.stype)).collect();
        assert_eq!(avatars, ["wall", "avatar"], "{mapping}");
    }
}

/// A sprite that a level places may have the type of a group.
#[test]
fn a_group_may_be_one_of_its_members() {
    let game = Game::from_source_as_reference(
        "BasicGame\n    SpriteSet\n        crate > Immovable\n        beast > Missile\n            ox > Immovable\n    LevelMapping\n        \
         c > crate\n        b > beast\n        o > ox\n    InteractionSet\n        beast crate > killSprite\n    TerminationSet\n",
    )
    .unwrap();
    let text = describe(&game);
    assert!(text.contains("Any beast means the beast or ox."), "{text}");
}

/// Before its first update, a new `RandomMissile` has the direction (−1, −1). If it is turned back before that update,
/// it moves diagonally.
#[test]
fn a_new_random_missile_may_move_diagonally() {
    let game = Game::from_source(
        "BasicGame\n    SpriteSet\n        spark > RandomMissile\n        fuse > Immovable\n    LevelMapping\n        s > spark\n        f > fuse\n    \
         InteractionSet\n        fuse TIME > transformToAll stype=fuse stypeTo=spark\n        spark fuse > reverseDirection\n    TerminationSet\n",
    )
    .unwrap();
    let level = game.level("sA\nf \n  \n").unwrap();
    let spark = game.sprite_type("spark").unwrap();
    let mut state = game.start(&level, Seed::from_text("diagonal"));
    for _ in 0..3 {
        game.step(&mut state, Action::Nil);
    }
    let block = state.block();
    assert!(state.places(spark).any(|place| place == (block, 2 * block)));
    assert!(Analysis::of(&game).reach(&level).can_be(spark, 5));
}

/// The taker of a resource lies on the source. What is missing is the resource that must be held first.
#[test]
fn a_taker_on_its_source_reaches_it() {
    let game = Game::from_source(
        "BasicGame\n    SpriteSet\n        goods >\n            mill > SpriteProducer\n            flour > Resource\n    LevelMapping\n        \
         f > flour mill\n    InteractionSet\n        goods mill > collectResourceIfHeld heldResource=flour\n    TerminationSet\n        \
         MultiSpriteCounter stype1=flour win=True\n",
    )
    .unwrap();
    let chains = Analysis::of(&game).causes(&game.level("A\nf\n").unwrap());
    let missing = chains[0].obstacles.iter().map(|obstacle| &obstacle.missing).collect::<Vec<_>>();
    let [Missing::Resource(shortage)] = missing[..] else { panic!("{chains:?}") };
    assert_eq!(shortage.sources, []);
}

/// A sprite that is counted once becomes a sprite that is counted twice.
#[test]
fn a_change_to_a_type_that_counts_twice_adds_to_the_count() {
    let game = Game::from_source(
        "BasicGame\n    SpriteSet\n        group0 > Walker\n            group1 >\n                s1 >\n                s3 >\n        \
         hero > PlatformerAvatar\n    LevelMapping\n        a > s1\n    InteractionSet\n        \
         group1 hero s1 EOS > transformToRandomChild stype=s1\n    TerminationSet\n        \
         MultiSpriteCounter stype1=group1 stype2=s3 limit=3\n",
    )
    .unwrap();
    let analysis = Analysis::of(&game);
    let counted = analysis.goals()[0].condition.types().to_vec();
    assert!(!analysis.only_falls(&counted), "{counted:?}");
}

/// Infinite friction reverses a movement.
#[test]
fn infinite_friction_reverses_a_missile() {
    let game = Game::from_source_as_reference(
        "BasicGame\n    SpriteSet\n        avatar > MissileAvatar physicstype=CONT friction=1e999\n    LevelMapping\n    InteractionSet\n    \
         TerminationSet\n",
    )
    .unwrap();
    let level = game.level(" A\n").unwrap();
    let avatar = game.sprite_type("avatar").unwrap();
    assert!(Analysis::of(&game).reach(&level).can_be(avatar, 0));
}
