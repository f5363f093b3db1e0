//! Tests reachable cells, drawn as boards.

mod chains;
mod goals;
mod hostile;

use super::{game, named, vault};
use engine::analysis::*;
use engine::{Analysis, SpriteType};

/// Draws the cells in which a type can be: `#` between two ticks, `+` only within a tick.
fn picture(analysis: &Analysis, reach: &Reach, name: &str) -> String {
    let stype = named(analysis, name);
    let (columns, rows) = reach.size();
    let mark = |cell: usize| match (reach.can_be(stype, cell), reach.can_touch(stype, cell)) {
        (true, _) => '#',
        (false, true) => '+',
        (false, false) => '.',
    };
    let marks: Vec<char> = (0..columns * rows).map(mark).collect();
    let rows: Vec<String> = marks.chunks(columns).map(|row| row.iter().collect()).collect();
    rows.join("\n")
}

fn reach(analysis: &Analysis, level: &str) -> Reach {
    let level = analysis.game().level(level).unwrap_or_else(|problems| panic!("{problems}"));
    let reach = analysis.reach(&level);
    assert!(!reach.is_coarse());
    reach
}

/// Checks the reachable cells of the named types in a level of a game with walls and the given sprites.
#[track_caller]
fn check(sprites: &str, rules: &str, level: &str, expect: &[(&str, &str)]) {
    let symbols = sprites.lines().map(str::trim).filter_map(|line| line.split_once(' '));
    let mapping: Vec<String> = symbols.map(|(name, _)| format!("{} > {name}", &name[..1])).collect();
    let sprites = format!("{sprites}\nwall > Immovable solid=True");
    let ends = "SpriteCounter stype=wall win=True";
    let analysis = Analysis::of(&game(&sprites, &format!("{}\nw > wall", mapping.join("\n")), rules, ends));
    let reach = reach(&analysis, level);
    for (name, expected) in expect {
        assert_eq!(picture(&analysis, &reach, name), *expected, "{name} in\n{level}");
    }
}

#[test]
fn walls_stop_and_the_edge_does_not() {
    let stop = "hero wall > stepBack";
    check("hero > MovingAvatar", stop, "wwwww\nwhw w\nwwwww", &[("hero", ".+...\n+#+..\n.+...")]);
    // The hero can go around the wall, off the board.
    check("hero > MovingAvatar", stop, "h w \n  w ", &[("hero", "##+#\n##+#")]);
    let all = format!("{stop}\nhero EOS > stepBack");
    check("hero > MovingAvatar", &all, "h w \n  w ", &[("hero", "##+.\n##+.")]);
    let undo = "hero wall > undoAll\nhero EOS > stepBack";
    check("hero > MovingAvatar", undo, "h w \n  w ", &[("hero", "##+.\n##+.")]);
    // Nothing stops the hero.
    check("hero > MovingAvatar", "hero EOS > stepBack", "hw \n", &[("hero", "###")]);
    // Two cells per step skip one wall, but not two.
    check("hero > MovingAvatar speed=2", &all, "hw w ww \n", &[("hero", "#+#+#++.")]);
    // At half a cell per step, the hero also stops before the wall.
    check("hero > MovingAvatar speed=0.5", &all, "h w ", &[("hero", "##+.")]);
}

#[test]
fn the_order_of_a_tick_counts() {
    let sprites = "hero > MovingAvatar\ncart > Missile orientation=RIGHT";
    let edge = "hero EOS > stepBack\ncart EOS > killSprite";
    // A cart carries the hero against the wall before the wall stops it, or afterwards.
    let before = format!("{edge}\nhero cart > pullWithIt\nhero wall > stepBack");
    check(sprites, &before, "chw  ", &[("hero", "##+..")]);
    let after = format!("{edge}\nhero wall > stepBack\nhero cart > pullWithIt");
    check(sprites, &after, "chw  ", &[("hero", "#####")]);
}

#[test]
fn each_moves_in_its_own_way() {
    let rules = "hero wall EOS > stepBack";
    let level = "w   w\n  h  \nw   w";
    for (class, expected) in [
        ("MovingAvatar", "+###+\n#####\n+###+"),
        ("HorizontalAvatar", ".....\n#####\n....."),
        ("VerticalAvatar", "..#..\n..#..\n..#.."),
        ("NullAvatar", ".....\n..#..\n....."),
        ("MissileAvatar orientation=LEFT", ".....\n###..\n....."),
        ("OngoingAvatar", "+###+\n#####\n+###+"),
        ("AimedAvatar stype=wall", ".....\n..#..\n....."),
        ("MovingAvatar stationary=True", ".....\n..#..\n....."),
    ] {
        let hero = [("hero", expected)];
        check(&format!("hero > {class}"), &format!("{rules}\nhero EOS > stepBack"), level, &hero);
    }
    let rules = "cow wall > stepBack\ncow EOS > stepBack";
    for (class, expected) in [
        ("RandomNPC", "+###+\n#####\n+###+"),
        ("Chaser stype=hero", "+###+\n#####\n+###+"),
        ("Missile orientation=UP", "..#..\n..#..\n....."),
        ("Missile", ".....\n..#..\n....."),
        ("Missile orientation=UP speed=0", ".....\n..#..\n....."),
        ("RandomMissile", "..#..\n#####\n..#.."),
        ("Immovable", ".....\n..#..\n....."),
    ] {
        let cow = [("cow", expected)];
        let sprites = format!("hero > MovingAvatar\ncow > {class}");
        check(&sprites, rules, "wh  w\n  c  \nw   w", &cow);
    }
}

#[test]
fn missiles_turn_wrap_and_end() {
    let sprites = "hero > NullAvatar\nbolt > Missile orientation=RIGHT";
    let level = "h    \n b w \n     ";
    let row = |marks: &str| format!(".....\n{marks}\n.....");
    for (rule, expected) in [
        ("bolt wall > killSprite", row(".##+.")),
        ("bolt wall > stepBack", row(".##+.")),
        ("bolt wall > reverseDirection\nbolt wall > stepBack", row("###+.")),
        ("bolt EOS > wrapAround", row("#####")),
        ("bolt wall > killBoth", row(".####")),
        ("bolt wall > transformTo stype=hero", row(".####")),
    ] {
        check(sprites, rule, level, &[("bolt", expected.as_str())]);
    }
    // The bolt moves two rows further down, and back up.
    let down = "bolt wall > turnAround\nbolt EOS > killSprite";
    check(sprites, down, "hb w\n    \n    \n    ", &[("bolt", "###+\n....\n####\n....")]);
    // The missile flies in either direction, but does not turn.
    let sprites = "hero > NullAvatar\nbolt > RandomMissile";
    let rules = "bolt wall > killSprite\nbolt EOS > killSprite";
    check(sprites, rules, "hw \n b \n   ", &[("bolt", ".+.\n###\n.#.")]);
    // Something nearby may turn the missiles.
    let gust = format!("{sprites}\ngust > Immovable");
    let turned = format!("{rules}\nbolt gust > flipDirection");
    check(&gust, &turned, "hw \n bg\n   ", &[("bolt", ".+#\n###\n###")]);
}

#[test]
fn shots_spawns_and_their_transformations() {
    // The first type in the SpriteSet is not searched for the avatar.
    let sprites = "floor > Immovable\nhero > ShootAvatar stype=arrow\narrow > Missile\nnest > SpawnPoint stype=egg\n\
                   egg > Passive\nduck > Missile orientation=DOWN";
    let rules = "hero wall EOS > stepBack\nhero EOS > stepBack\narrow wall > killSprite\narrow EOS > killSprite\n\
                 egg arrow > transformTo stype=duck\nduck EOS > killSprite";
    let level = "wwwww\nwh nw\nw www\nw   w";
    check(
        sprites,
        rules,
        level,
        &[
            ("arrow", ".+++.\n+###+\n+#++.\n+###+"),
            ("egg", ".....\n...#.\n.....\n....."),
            ("duck", ".....\n...#.\n...#.\n...#."),
        ],
    );
    // Without arrows there are no ducks.
    let bare = sprites.replace("stype=arrow", "stype=arrow ammo=quiver") + "\nquiver > Resource";
    check(
        &bare,
        rules,
        level,
        &[("arrow", ".....\n.....\n.....\n....."), ("duck", ".....\n.....\n.....\n.....")],
    );
    let flak = "floor > Immovable\nhero > FlakAvatar stype=arrow\narrow > Missile orientation=UP";
    let rules = "hero wall > stepBack\nhero EOS > stepBack\narrow wall > killSprite\narrow EOS > killSprite";
    check(
        flak,
        rules,
        "w    \n     \nwh  w",
        &[("arrow", "...#.\n.###.\n.###.".replace("...#.", ".###.").as_str())],
    );
}

#[test]
fn things_are_pushed_away_only() {
    let sprites = "hero > MovingAvatar\nbox > Passive";
    let rules = "hero wall > stepBack\nhero EOS > stepBack\nbox hero > bounceForward\nbox wall > undoAll\nbox EOS > undoAll";
    // A box moves along the wall, and not away from it.
    check(
        sprites,
        rules,
        "wwwww\nw b w\nw   w\nw h w\nwwwww",
        &[("box", ".+++.\n+###+\n.....\n.....\n.....")],
    );
    check(
        sprites,
        rules,
        "wwwww\nwb  w\nw   w\nw h w\nwwwww",
        &[("box", ".+...\n+#...\n.....\n.....\n.....")],
    );
    // A hero that faces a different direction pushes in that direction, so the box leaves the corner.
    let odd = sprites.replace("MovingAvatar", "MovingAvatar orientation=RIGHT");
    check(&odd, rules, "wwwww\nwb  w\nwh  w\nwwwww", &[("box", ".+++.\n+###+\n+###+\n.+++.")]);
}

#[test]
fn keys_open_locks_one_after_the_other() {
    let sprites = "hero > MovingAvatar\nkey > Resource limit=9\ngate > Door\nlock > Door";
    let rules = "hero wall > stepBack\nhero EOS > stepBack\nkey hero > collectResource\n\
                 gate hero > killIfOtherHasMore resource=key limit=1\nhero gate > stepBack\n\
                 lock hero > killIfOtherHasMore resource=key limit=3\nhero lock > stepBack";
    let open = [("hero", "#########+")];
    check(sprites, rules, "hk gkk l w", &open);
    let two = [("hero", "#######+..")];
    check(sprites, rules, "hk gk  l w", &two);
    let none = [("hero", "###+......")];
    check(sprites, rules, "h  gkk l w", &none);
    // A key that is not used up when it is taken is enough for all locks.
    let kept = rules.replace("key hero > collectResource", "key hero > collectResource killResource=False");
    check(sprites, &kept, "hk gk  l w", &open);
    // A spawner makes an unlimited number of keys.
    let forge = format!("{sprites}\nforge > SpawnPoint stype=key");
    check(&forge, rules, "hf g   l w", &[("hero", "#########+")]);
}

#[test]
fn portals_and_disguises() {
    let sprites = "hero > MovingAvatar\nportal > Portal stype=xit\nxit > Immovable";
    let rules = "hero wall > stepBack\nhero EOS > stepBack\nhero portal > teleportToExit";
    check(sprites, rules, "h p w  x w  ", &[("hero", "####+####+..")]);
    check(sprites, rules, "h p w    w  ", &[("hero", "####+.......")]);
    // As a ghost, the avatar passes the fence.
    let analysis = vault();
    let reach = reach(&analysis, "wwwwwwww\nwA.kf.xw\nwwwwwwww");
    assert_eq!(picture(&analysis, &reach, "plain"), ".+++....\n+###+...\n.+++....");
    assert_eq!(picture(&analysis, &reach, "ghost"), ".++++++.\n+######+\n.++++++.");
    let cell = |column: usize| 8 + column;
    assert!(reach.avatar_reaches(cell(6)) && reach.avatar_touches(cell(7)) && !reach.avatar_reaches(cell(7)));
    let ghost = named(&analysis, "ghost");
    assert_eq!(reach.cells(ghost).collect::<Vec<_>>(), (1..7).map(cell).collect::<Vec<_>>());
    assert!(reach.touched(ghost).count() > 6);
}

#[test]
fn jumps_have_a_height() {
    let jump = |strength: &str| {
        format!("hero > PlatformerAvatar physicstype=CONT gravity=1 max_speed=15 jump_strength={strength}")
    };
    let rules = "hero wall > wallStop\nhero EOS > stepBack";
    let level = "          \n          \n          \n          \n  h       \nwwww  wwww";
    // A cell is 80 pixels. A speed of 10 lifts the hero by less than one cell, and a speed of 14 by less than two, from
    // the height at which it falls to the ground.
    let floor = "##########\n##########\n++++##++++";
    let (none, all) = ("..........", "##########");
    let expected = |rows: [&str; 3]| format!("{}\n{floor}", rows.join("\n"));
    for (strength, rows) in [("10", [none, none, all]), ("14", [none, all, all]), ("30", [all; 3])] {
        check(&jump(strength), rules, level, &[("hero", &expected(rows))]);
    }
    // A lift that carries the hero frees it from this limit.
    let carried = format!("{rules}\nhero lift > pullWithIt");
    let sprites = format!("{}\nlift > Missile orientation=UP speed=0.1", jump("10"));
    let level = level.replacen("h ", "hl", 1);
    check(
        &sprites,
        &carried,
        &level,
        &[("hero", "##########\n##########\n##########\n##########\n##########\n##########")],
    );
}

/// Checks possibilities that random episodes have revealed.
#[test]
fn odd_ways_through_walls() {
    let none = "hero > NullAvatar\n";
    let edge = "cow EOS > stepBack";
    // A timed effect grants a shield.
    let shielded =
        format!("cow wall > stepBack\ncow TIME > shieldFrom stype=wall ftype=stepBack timer=3\n{edge}");
    check(&format!("{none}cow > RandomNPC"), &shielded, "hcw  ", &[("cow", "#####")]);
    // A portal that is a spawner leads to whatever it can make.
    let portal = format!(
        "{none}cow > RandomNPC\nport > BomberRandomMissile stype=mob stypeMissile=mob,xit\nmob > Immovable\nxit > Immovable"
    );
    let leads = format!("cow wall > stepBack\ncow port > teleportToExit\n{edge}");
    check(&portal, &leads, "hcpwx", &[("cow", "###+#")]);
    // The egg can move from two rows outside to one row outside, or to the first row.
    let drop = format!("{none}cow > Missile orientation=UP\negg > Passive");
    let laid = "cow cow > spawn stype=egg\negg EOS > spawnBelow stype=egg\negg cow > spawnBelow stype=egg";
    check(&drop, laid, "   \n c \nh  ", &[("egg", ".#.\n.#.\n.#.")]);
    // A sprite that is transformed on its way is moved back in its new form.
    let turned = format!("{none}cow > Missile orientation=RIGHT\nbull > Passive\nox > Passive");
    let back = "cow wall > transformTo stype=bull\nbull wall > transformTo stype=ox\nox wall > undoAll";
    check(&turned, back, "hc w", &[("ox", ".###")]);
    // The sprite leaves eggs at the position that it had in its old form.
    let left = format!("{none}cow > Missile orientation=RIGHT\nbull > Passive\negg > Passive");
    let behind = "cow EOS > transformTo stype=bull\nbull bull > spawnBehind stype=egg";
    check(&left, behind, "hc ", &[("egg", ".##")]);
}

#[test]
fn goals_out_of_reach() {
    let sprites = "hero > MovingAvatar\ngem > Immovable\nfly > RandomNPC";
    let rules = "hero wall > stepBack\nhero EOS > stepBack\ngem hero > killSprite\nfly wall > stepBack\nfly EOS > stepBack\n\
                 hero fly > killSprite";
    let ends = "SpriteCounter stype=hero win=False\nSpriteCounter stype=gem win=True\nSpriteCounterMore stype=gem limit=3 win=False\n\
                SpriteCounter stype=gem limit=1 win=True";
    let mapping = "h > hero\ng > gem\nf > fly\nw > wall";
    let analysis = Analysis::of(&game(&format!("{sprites}\nwall > Immovable"), mapping, rules, ends));
    let goals = |level: &str| -> Vec<usize> {
        reach(&analysis, level)
            .impossible_goals()
            .iter()
            .map(|impossible_goal| impossible_goal.goal)
            .collect()
    };
    assert_eq!(goals("h g g f"), [2]);
    assert_eq!(goals("h gwg f"), [0, 1, 2]);
    assert_eq!(goals("hwgwg f"), [0, 1, 2, 3]);
    assert_eq!(goals("h gggwf"), [0]);
}

#[test]
fn too_much_gets_a_coarse_answer() {
    let mut sprites = "hero > MovingAvatar\nroot >\n".to_owned();
    for number in 0..400 {
        sprites += &format!("  t{number} > RandomNPC\n");
    }
    let names: Vec<String> = (0..400).map(|number| format!("t{number}")).collect();
    let mapping = format!("h > hero\nr > {}", names.join(" "));
    let analysis =
        Analysis::of(&game(&sprites, &mapping, "root root > killBoth", "SpriteCounter stype=root win=True"));
    let level = analysis.game().level("h   \n   r").unwrap();
    let reach = analysis.reach(&level);
    assert!(reach.is_coarse() && reach.impossible_goals().is_empty());
    assert_eq!(picture(&analysis, &reach, "t7"), "####\n####");
    assert_eq!(picture(&analysis, &reach, "wall"), "....\n....", "impossible types are nowhere");
}
