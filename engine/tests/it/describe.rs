//! Tests guides to games.

use base::Seed;
use engine::describe::{self, Guide};
use engine::{Action, Analysis, Game, SpriteRecord};

/// A game whose description has most kinds of sentences.
const ORCHARD: &str = "
BasicGame
    SpriteSet
        wall > Immovable
        pear > Resource limit=3
        gate > Door
        pond > Immovable
        wasp > Chaser stype=picker speed=0.5
        hive > SpawnPoint stype=wasp cooldown=8 prob=0.5 total=4
        stone > Missile orientation=DOWN speed=0.8 cooldown=3
        cart > Passive
        pest >
            slug > RandomNPC cooldown=4
            snail > Fleeing stype=picker cooldown=2
        net > Flicker limit=3 singleton=True
        picker > ShootAvatar stype=net ammo=pear
    LevelMapping
        p > pear
        g > gate
        o > pond
        h > hive
        s > stone
        c > cart
        n > snail
        k > slug
        A > picker
    InteractionSet
        picker wall pond > stepBack
        pear picker > collectResource scoreChange=1
        gate picker > killIfOtherHasMore resource=pear limit=3 subtract=True scoreChange=5
        picker wasp pest > killSprite scoreChange=-2
        picker stone > killIfFromAbove
        pest net > transformTo stype=pear
        cart picker > bounceForward
        cart pond > killBoth
        EOS stone wasp > killSprite
    TerminationSet
        SpriteCounter stype=picker win=False
        MultiSpriteCounter stype1=gate stype2=pest win=True
        Timeout limit=600 win=False
";

#[test]
fn a_guide_reads_well() {
    let expected = "\
How you play:
  You are the picker: an arrow key turns you that way, or moves you if you face it already; the use key puts a net into the cell ahead of you, empty or not, which costs 1 pear.

How you win:
  You win when no gate, no slug and no snail is left.

How you lose:
  You lose when you are gone.
  You lose when tick 601 is reached.

How a tick goes:
  Each tick you act, then the others act, then contacts count, in the order of the lines below.
  Sprites touch in each tick in which they overlap after the moves; swapping places is no touch. Sprites that no line names together pass over each other.
  What moves every N ticks does so N, 2N, 3N ticks after it appeared; a blocked move is lost.
  While gliding between two cells, a sprite touches everything in both.
  What disappears still blocks and touches others in that tick.
  At the limit of what can be held, more stays where it is and brings no points.
  Chasers take a step nearer, not around obstacles, at random if several are.
  Fleeing ones take a step further away, sideways too, at random if several are.
  If you win and lose in the same tick, you win, unless you died.

What the others do:
  The pear can be held, up to 3.
  The wasp chases you, gliding, a cell in about 2 ticks.
  The hive makes a wasp every 8 ticks, first in tick 1, with a chance of 50%, 4 in all, and then disappears.
  The stone moves down, gliding, a cell in about 4 ticks.
  The slug wanders, a cell every 4 ticks, each time up, left, down or right at random.
  The snail flees from you, a cell every 2 ticks.
  The net vanishes 4 ticks after it appears; only one exists at a time: no other is made until it is gone.
  Everything else does nothing by itself.
  You can walk over the hive and net.

Words for several:
  Any pest means the slug or snail.

What happens when sprites meet:
  The stone or wasp disappears on touching the edge of the board.
  You cannot enter the wall or pond.
  You collect the pear. You gain 1 point.
  The gate disappears on touching you if you hold at least 3 pears, which costs 3 pears. If it disappears, you gain 5 points.
  You die on touching the wasp or any pest. You lose 2 points.
  You die if the stone comes down on you from above.
  Any pest turns into a pear on touching the net.
  You push the cart.
  The cart and the pond both disappear when they touch.

What the level's characters stand for:
  A  picker
  c  cart
  g  gate
  h  hive
  k  slug
  n  snail
  o  pond
  p  pear
  s  stone
  w  wall
";
    let game = Game::from_source(ORCHARD).unwrap();
    assert_eq!(describe::describe(&game), expected);
    assert_eq!(
        Guide::of(&game).kind,
        [
            "Genre: puzzle, shooter, collect and escape.",
            "Real-time: things happen while you do nothing.",
            "Space: you move on a grid.",
            "Chance plays a part.",
            "Everything that matters is shown.",
        ]
    );
}

#[test]
fn a_sprite_that_is_alone_has_a_whole_sentence() {
    let source = ORCHARD
        .replace("net > Flicker limit=3 singleton=True", "net > Immovable singleton=True")
        .replace("cart > Passive", "cart > Passive singleton=True hidden=True");
    let guide = Guide::of(&Game::from_source(&source).unwrap());
    for line in [
        "The net exists only once at a time: no other is made until it is gone.",
        "The cart exists only once at a time: no other is made until it is gone; cannot be seen.",
    ] {
        assert!(guide.sprites.iter().any(|told| told == line), "{:?}", guide.sprites);
    }
}

/// A type that would vanish after the time limit stays, as far as players can see.
#[test]
fn ends_beyond_the_time_limit_are_not_told() {
    for (limit, is_told) in [(100, true), (5000, false)] {
        let source = ORCHARD.replace("net > Flicker limit=3", &format!("net > Flicker limit={limit}"));
        let guide = Guide::of(&Game::from_source(&source).unwrap());
        assert_eq!(
            guide.sprites.iter().any(|told| told.contains("vanishes")),
            is_told,
            "{:?}",
            guide.sprites
        );
    }
}

#[test]
fn several_avatars_are_distinguished() {
    let game = Game::from_source(
        "BasicGame\n  SpriteSet\n    key > Immovable\n    door > Door\n    hero >\n      bare > MovingAvatar\n      armed > \
         MovingAvatar\n  LevelMapping\n    k > key\n    d > door\n    A > bare\n  InteractionSet\n    bare key > transformTo \
         stype=armed killSecond=True\n    bare door > stepBack\n    door armed > killSprite\n    hero EOS > stepBack\n  \
         TerminationSet\n    SpriteCounter stype=door win=True\n",
    )
    .unwrap();
    let guide = Guide::of(&game);
    assert_eq!(guide.controls.len(), 2);
    assert_eq!(
        guide.meetings,
        [
            "You cannot enter the edge of the board.",
            "You as bare turn into an armed on touching the key, and the key disappears.",
            "You as bare cannot enter the door.",
            "The door disappears on touching you as armed.",
        ]
    );
    assert_eq!(guide.losing, Vec::<String>::new());
}

#[test]
fn several_forms_of_the_player_are_named_one_by_one() {
    let source = "BasicGame\n  SpriteSet\n    lamb > Immovable\n    avatar >\n      free > MovingAvatar\n      bearing >\n        \
                  laden > MovingAvatar\n        tainted > MovingAvatar\n  LevelMapping\n    l > lamb\n    A > free\n    B > laden\n    \
                  C > tainted\n  InteractionSet\n    bearing lamb > stepBack\n  TerminationSet\n    SpriteCounter stype=lamb win=True\n";
    let guide = Guide::of(&Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(guide.meetings, ["You as laden or tainted cannot enter the lamb."]);
}

#[test]
fn groups_that_are_chased_are_told() {
    let source = "BasicGame\n  SpriteSet\n    lure >\n      bait > Immovable\n      avatar > MovingAvatar\n    bear > Chaser \
                  stype=lure cooldown=2\n  LevelMapping\n    b > bait\n    c > bear\n  InteractionSet\n    avatar bear > \
                  killSprite\n  TerminationSet\n    Timeout limit=9 win=True\n";
    let guide = Guide::of(&Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(guide.sprites[0], "The bear chases the nearest lure, a cell every 2 ticks.");
    assert_eq!(guide.groups, ["Any lure means you or the bait."]);
}

#[test]
fn what_no_member_of_a_group_can_enter_is_told() {
    let source = "BasicGame\n  SpriteSet\n    burden >\n      crate > Passive\n      barrel > Passive\n    pit > Immovable\n    avatar > \
                  MovingAvatar\n  LevelMapping\n    c > crate\n    b > barrel\n    p > pit\n  InteractionSet\n    burden avatar > \
                  bounceForward\n    burden pit > stepBack\n    avatar burden > undoAll\n    burden wall > undoAll\n  TerminationSet\n    \
                  Timeout limit=9 win=True\n";
    let guide = Guide::of(&Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(guide.meetings[1], "No burden can enter the pit.");
    let undone = "No burden can enter the wall: when any burden touches the wall, every move of that tick is taken back.";
    assert!(guide.meetings.iter().any(|line| line == undone), "{:?}", guide.meetings);
}

/// The guide states the direction of signs that turn other sprites, and of no other still sprites.
#[test]
fn signs_tell_where_they_point() {
    let source = "BasicGame\n  SpriteSet\n    sign > Immovable orientation=UP\n    points > Missile speed=0 orientation=LEFT\n    \
                  pond > Immovable orientation=UP\n    cart > Missile orientation=RIGHT\n    avatar > MovingAvatar\n  LevelMapping\n    \
                  s > sign\n    p > points\n    o > pond\n    c > cart\n  InteractionSet\n    cart sign points > attractGaze\n    \
                  points cart > reverseDirection\n    avatar pond > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n";
    let guide = Guide::of(&Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}")));
    let expected = [
        "The sign faces up.",
        "The points faces left at first.",
        "The cart moves right at first, a cell a tick.",
        "Everything else does nothing by itself.",
        "You can walk over the sign and points.",
    ];
    assert_eq!(guide.sprites, expected);
}

#[test]
fn counters_and_their_decisions() {
    let source = "BasicGame no_counters=2\n  SpriteSet\n    key > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    k > key\n  InteractionSet\n    avatar key > stepBack counter=1,-2 counterElse=0,-1\n  TerminationSet\n    Timeout limit=9 use_counter=True compare=True\n";
    let guide = Guide::of(&Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(
        guide.meetings,
        ["You cannot enter the key. Counter 1 changes by +1. Counter 2 changes by -3."]
    );
    assert_eq!(guide.winning, ["You win if you last until tick 10, if the counters are not all the same."]);
}

#[test]
fn levels_with_goals_out_of_reach() {
    let check = |text: &str, expected: &[&str]| {
        let game = Game::from_source(ORCHARD).unwrap_or_else(|problems| panic!("{problems}"));
        let level = game.level(text).unwrap_or_else(|problems| panic!("{problems}"));
        let analysis = Analysis::of(&game);
        assert_eq!(describe::level(&analysis, &level, &analysis.reach(&level)), expected, "{text}");
    };
    let lost = "You lose when you are gone, but here nothing can ever end the picker in column 2, row 2.";
    check("wwwwwww\nwApppgw\nwwwwwww\n", &["You can get to 5 of its 21 cells, at most.", lost]);
    // The first gate costs three pears, and there is only one pear.
    let won = "You win when no gate, no slug and no snail is left, but here nothing can ever end the gate in column 4, row 2, \
               the gate in column 5, row 2, the gate in column 6, row 2 and 1 more.";
    check("wwwwwwwww\nwA ggggpw\nwwwwwwwww\n", &["You can get to 7 of its 27 cells, at most.", lost, won]);
}

/// A pair runs at the position of the line that names it first, and so the guide describes the pair there.
#[test]
fn lines_are_in_the_order_in_which_they_count() {
    let source = "BasicGame\n  SpriteSet\n    gem > Immovable\n    nut > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > \
                  gem\n    n > nut\n  InteractionSet\n    gem avatar > transformTo stype=nut\n    nut avatar > killSprite\n    \
                  gem nut avatar > spawn stype=gem\n  TerminationSet\n    Timeout limit=9 win=True\n";
    let guide = Guide::of(&Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}")));
    assert_eq!(
        guide.meetings,
        [
            "The gem turns into a nut on touching you.",
            "When the gem touches you, a gem appears there.",
            "The nut disappears on touching you.",
            "When the gem touches the nut, a gem appears there.",
        ]
    );
}

/// A squire who becomes a king or a frog lives on, so the count of one form does not decide whether the
/// player lives.
#[test]
fn a_form_of_the_player_is_not_the_player() {
    let endings = |forms: &str, start: &str, ends: &str| {
        let source = format!(
            "BasicGame\n  SpriteSet\n    crown > Immovable\n    me >\n      squire > MovingAvatar\n{forms}  LevelMapping\n    c > \
             crown\n    A > squire\n  InteractionSet\n    {start}\n    me EOS > stepBack\n  TerminationSet\n    {ends}\n"
        );
        let guide = Guide::of(&Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}")));
        [guide.winning, guide.losing].concat()
    };
    let king = "      king > MovingAvatar\n";
    let turns = "squire crown > transformTo stype=king";
    assert_eq!(
        endings(king, turns, "SpriteCounter stype=squire win=True"),
        ["You win when no squire is left."]
    );
    assert_eq!(endings(king, turns, "SpriteCounter stype=squire"), ["You lose when no squire is left."]);
    assert_eq!(endings(king, turns, "SpriteCounter stype=me"), ["You lose when you are gone."]);
    let both = "MultiSpriteCounter stype1=squire stype2=king";
    assert_eq!(endings(king, turns, both), ["You lose when you are gone."]);
    // Nobody becomes a king, or there is no king.
    let alone = "squire crown > killSprite";
    assert_eq!(endings(king, alone, "SpriteCounter stype=squire"), ["You lose when you are gone."]);
    assert_eq!(endings("", alone, "SpriteCounter stype=squire"), ["You lose when you are gone."]);
}

/// If the score or the counters decide a termination, it can win or lose, whatever its `win` says.
#[test]
fn endings_that_are_decided_late_win_or_lose() {
    let guide = |header: &str, ends: &str| {
        let source = format!(
            "BasicGame {header}\n  SpriteSet\n    pear > Immovable\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    \
             p > pear\n    o > pit\n  InteractionSet\n    pear pit avatar > killSprite scoreChange=1\n  TerminationSet\n    {ends}\n"
        );
        Guide::of(&Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}")))
    };
    for (ends, win, loss) in [
        ("SpriteCounter stype=pit", "when no pit is left", "when no pit is left"),
        (
            "SpriteCounterMore stype=pit limit=2",
            "when there are at least 2 pits",
            "when there are at least 2 pits",
        ),
        (
            "MultiSpriteCounter stype1=pit limit=3",
            "when there are exactly 3 pits",
            "when only 3 pits are left",
        ),
        (
            "MultiSpriteCounterSubTypes stype1=pit limit=3 subTypesNum=1",
            "when there are exactly 3 pits, of exactly 1 kind",
            "when only 3 pits are left, of exactly 1 kind",
        ),
    ] {
        for written in ["", " win=True", " win=False"] {
            let guide = guide("", &format!("{ends} count_score=True{written}"));
            assert_eq!(guide.winning, [format!("You win {win}, if your score is not 0.")]);
            assert_eq!(guide.losing, [format!("You lose {loss} and your score is 0.")]);
        }
    }
    let timed = guide("", "Timeout limit=9 count_score=True");
    assert_eq!(timed.winning, ["You win if you last until tick 10, if your score is not 0."]);
    assert_eq!(timed.losing, ["You lose when tick 10 is reached and your score is 0."]);
    let compared = guide("no_counters=2", "Timeout limit=9 use_counter=True compare=True");
    assert_eq!(compared.losing, ["You lose when tick 10 is reached and the counters are all the same."]);
    let counted = guide("no_counters=1", "Timeout limit=9 use_counter=True limits=5,0");
    assert_eq!(counted.winning, ["You win if you last until tick 10, if the counter is at 5."]);
    assert_eq!(counted.losing, ["You lose when tick 10 is reached and the counter is not at 5."]);
    // A single counter cannot differ from another counter.
    let one = guide("no_counters=1", "Timeout limit=9 use_counter=True compare=True");
    assert_eq!((one.winning.len(), &*one.losing), (0, &["You lose when tick 10 is reached.".to_owned()][..]));
    // A count can never be below 0.
    let below = guide("", "SpriteCounter stype=pit limit=-1 win=True");
    assert_eq!(below.winning, ["You win when at most -1 pits are left."]);

    let tie = |ends: &str| guide("", ends).order.pop().unwrap();
    let score = "SpriteCounter stype=pit count_score=True";
    assert!(!tie(&format!("{score}\n    Timeout limit=9 count_score=True")).starts_with("If you win"));
    assert_eq!(
        tie(&format!("{score}\n    SpriteCounter stype=pear win=True")),
        "If you win and lose in the same tick, you lose."
    );
    assert_eq!(
        tie(&format!("SpriteCounter stype=pear win=True\n    {score}")),
        "If you win and lose in the same tick, you win."
    );
    assert_eq!(
        tie(&format!("{score}\n    Timeout limit=9\n    SpriteCounter stype=pear win=True")),
        "Of several ways to win or lose in one tick, the first of these counts: you win or lose when no pit is left; you \
         lose when tick 10 is reached; you win when no pear is left."
    );
}

/// Sprites of parent types are never updated, so they do not do what their class usually does.
#[test]
fn sprites_of_parent_types_do_nothing_by_themselves() {
    let source = "BasicGame\n  SpriteSet\n    boat > Missile orientation=RIGHT\n      ferry >\n    spark > Flicker limit=3\n      ember >\n    \
                  hive > SpawnPoint stype=boat\n      nest >\n    avatar > MovingAvatar\n  LevelMapping\n    b > boat\n    s > spark\n    \
                  h > hive\n  InteractionSet\n    avatar boat > killSprite\n  TerminationSet\n    SpriteCounter stype=avatar\n";
    let still = ["Everything else does nothing by itself.", "You can walk over the hive."];
    let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(Guide::of(&game).sprites, still);
    let leaves =
        source.replace("      ferry >\n", "").replace("      ember >\n", "").replace("      nest >\n", "");
    assert_eq!(Guide::of(&Game::from_source(&leaves).unwrap()).sprites.len(), 4);
    let level = game.level("bshA  \n").unwrap();
    let mut state = game.start(&level, Seed::from_text("parents"));
    let first = game.records(&state);
    for _ in 0..9 {
        game.step(&mut state, Action::Nil);
    }
    let place =
        |records: &[SpriteRecord]| records.iter().map(|one| (one.stype, one.rect)).collect::<Vec<_>>();
    assert_eq!(place(&game.records(&state)), place(&first));
}

/// The engine looks for the avatar among leaf types and `avatar`. No key moves a sprite of another parent type.
#[test]
fn avatars_that_are_never_found_are_not_the_player() {
    let source = "BasicGame\n  SpriteSet\n    pear > Immovable\n    hero > MovingAvatar\n      young >\n      old >\n  LevelMapping\n    \
                  p > pear\n    H > hero\n  InteractionSet\n    pear hero > killSprite\n    hero EOS > stepBack\n  TerminationSet\n    \
                  SpriteCounter stype=pear win=True\n    SpriteCounter stype=hero\n";
    for load in [Game::from_source, Game::from_source_as_reference] {
        let guide = Guide::of(&load(source).unwrap_or_else(|problems| panic!("{problems}")));
        assert_eq!(guide.controls.len(), 1);
        assert!(guide.controls[0].starts_with("You control nothing"), "{:?}", guide.controls);
        assert_eq!(guide.losing, ["You lose when no hero is left."]);
        assert_eq!(guide.sprites, ["Everything else does nothing by itself."]);
        assert!(guide.meetings.iter().all(|line| !line.contains("you")), "{:?}", guide.meetings);
    }
    // The player controls the type that an avatar turns into, even if it is a parent type.
    let turned = source
        .replace("H > hero", "H > young")
        .replace("    hero EOS", "    young pear > transformTo stype=hero\n    hero EOS");
    let guide = Guide::of(&Game::from_source(&turned).unwrap());
    assert_eq!(guide.controls.len(), 2, "{:?}", guide.controls);
    assert_eq!(guide.losing, ["You lose when you are gone."]);
    // The player does not control sprites that a spawner makes.
    let made =
        source.replace("pear > Immovable", "pear > SpawnPoint stype=old").replace("H > hero", "H > young");
    let guide = Guide::of(&Game::from_source(&made).unwrap());
    assert!(
        guide.controls.len() == 1 && guide.controls[0].starts_with("You are the young"),
        "{:?}",
        guide.controls
    );
}

/// `A` and `w` stand for `avatar` and `wall` in every game, so a line that says so changes nothing.
#[test]
fn default_characters_are_told_like_written_ones() {
    let source = "BasicGame\n  SpriteSet\n    avatar > MovingAvatar\n      calm >\n      cross >\n    block > Immovable\n      wall >\n      \
                  stone >\n    pear > Immovable\n  LevelMapping\n    p > pear\n    s > stone\n  InteractionSet\n    pear avatar > \
                  killSprite\n    avatar block > stepBack\n  TerminationSet\n    SpriteCounter stype=pear win=True\n    SpriteCounter stype=avatar\n";
    let written = source.replace("    p > pear\n", "    p > pear\n    A > avatar\n    w > wall\n");
    let [own, written] = [source, &written].map(|source| Guide::of(&Game::from_source(source).unwrap()));
    assert_eq!(own, written);
    assert!(own.controls[0].starts_with("You are the avatar: the arrow keys move you"), "{:?}", own.controls);
    assert_eq!(own.groups, ["Any block means the wall or stone."]);
    assert!(own.legend.contains(&"w  wall".to_owned()));
}
