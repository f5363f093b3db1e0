//! Tests the analyses of small games, of six public games, and of every available game.

mod chance;
mod goals;
mod hostile;
mod outlook;
mod reach;
mod scenery;
mod taxonomy;

use engine::analysis::*;
use engine::{Analysis, Direction, Game, SpriteType, State};
use std::path::{Path, PathBuf};

pub(super) fn game(sprites: &str, mapping: &str, interactions: &str, terminations: &str) -> Game {
    let indent =
        |text: &str| text.lines().map(|line| format!("    {}\n", line.trim_end())).collect::<String>();
    let source = format!(
        "BasicGame\n  SpriteSet\n{}  LevelMapping\n{}  InteractionSet\n{}  TerminationSet\n{}",
        indent(sprites),
        indent(mapping),
        indent(interactions),
        indent(terminations)
    );
    Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"))
}

/// Returns the roles of the types in `names`, as `name: Role`.
fn roles(analysis: &Analysis, names: &str) -> String {
    let role = |name: &str| format!("{name}: {:?}", analysis.role(named(analysis, name)));
    names.split(' ').map(role).collect::<Vec<_>>().join(", ")
}

pub(super) fn named(analysis: &Analysis, name: &str) -> SpriteType {
    analysis.game().sprite_type(name).unwrap_or_else(|| panic!("no sprite named {name}"))
}

fn names(analysis: &Analysis, types: &[SpriteType]) -> String {
    types.iter().map(|&stype| analysis.game().name(stype)).collect::<Vec<_>>().join(" ")
}

/// Returns the analysis of a vault game. Coins open the gate, and a cloak turns the thief into a ghost that
/// passes the fence.
pub(super) fn vault() -> Analysis {
    Analysis::of(&game(
        "floor > Immovable hidden=True\nwall > Immovable\nfence > Immovable\ncoin > Resource limit=4 value=2\n\
         cloak > Immovable\ngate > Door\ncrown > Door\nspike > Immovable\nguard > Chaser stype=thief cooldown=2\n\
         post > SpawnPoint stype=guard cooldown=9\nthief >\n  plain > MovingAvatar\n  ghost > MovingAvatar",
        ". > floor\nw > wall\nf > floor fence\nc > floor coin\nk > floor cloak\ng > floor gate\nx > floor crown\n\
         s > floor spike\nu > floor guard\np > floor post\nA > floor plain",
        "thief wall > stepBack\nguard wall gate > stepBack\nplain fence > stepBack\ncoin thief > collectResource\n\
         plain cloak > transformTo stype=ghost killSecond=True\n\
         gate thief > killIfOtherHasMore resource=coin limit=3 subtract=True\nthief gate > stepBack\n\
         crown thief > killSprite scoreChange=9\nthief spike guard > killSprite",
        "SpriteCounter stype=thief win=False\nSpriteCounter stype=crown win=True\nTimeout limit=300 win=False",
    ))
}

#[test]
fn roles_of_a_vault() {
    let analysis = vault();
    assert_eq!(
        roles(&analysis, "floor wall fence coin cloak gate crown spike guard post plain ghost"),
        "floor: Floor, wall: Wall, fence: Gate, coin: Key, cloak: Key, gate: Gate, crown: Exit, spike: Hazard, \
         guard: Enemy, post: Spawner, plain: Avatar, ghost: Avatar"
    );
    assert!(!analysis.is_turn_based() && !analysis.is_deterministic() && analysis.is_fully_observable());
}

#[test]
fn locks_know_their_keys() {
    let analysis = vault();
    let coin = named(&analysis, "coin");
    let lock = |name: &str| {
        let stype = named(&analysis, name);
        analysis.locks().iter().find(|lock| lock.stype == stype).unwrap()
    };
    let gate = lock("gate");
    assert_eq!(gate.key, Key::Resource { resource: coin, amount: 3, spent: true });
    assert_eq!((gate.guards, gate.vanishes, gate.givers.as_slice()), (true, true, &[(coin, 2)][..]));
    let fence = lock("fence");
    assert_eq!(fence.key, Key::Avatar(named(&analysis, "ghost")));
    assert_eq!((fence.guards, fence.vanishes), (true, false));
    assert_eq!(fence.givers, [(named(&analysis, "cloak"), 1)]);
    assert_eq!(analysis.locks().len(), 2);
    let resource = &analysis.resources()[0];
    assert_eq!((resource.limit, resource.needed, resource.is_ammunition), (4, 3, false));
    // Three coins are needed, and each sprite gives two.
    let keys = analysis.requirements().iter().find(|r| r.reason == Reason::Lock(named(&analysis, "gate")));
    assert_eq!(keys.map(|keys| (keys.types.clone(), keys.at_least)), Some((vec![coin], 2)));
}

/// A saved calf is one calf fewer. The bell can ring any number of times.
#[test]
fn a_win_that_turns_three_sprites_requires_three() {
    let least = |mapping: &str, spawned: &str| {
        let sprites = "calf > Passive\npen > Immovable\nbell > Immovable\nsaved > Immovable\necho > Flicker\navatar > MovingAvatar";
        let rules = format!("calf pen > transformTo stype=saved\nbell avatar > spawn stype={spawned}");
        let ends =
            "SpriteCounterMore stype=saved limit=3 win=True\nSpriteCounterMore stype=echo limit=2 win=True";
        let analysis = Analysis::of(&game(sprites, mapping, &rules, ends));
        let least = |name: &str| {
            let of_win = |r: &&Requirement| {
                matches!(r.reason, Reason::WinMethod(_)) && r.types == [named(&analysis, name)]
            };
            analysis.requirements().iter().filter(of_win).map(|r| r.at_least).max()
        };
        ["calf", "pen", "bell"].map(least)
    };
    let mapping = "c > calf\np > pen\nb > bell";
    assert_eq!(least(mapping, "echo"), [Some(3), Some(1), Some(1)]);
    assert_eq!(least(mapping, "calf")[0], Some(1), "another rule creates calves");
    assert_eq!(least(&format!("{mapping}\ns > saved"), "echo")[0], Some(1), "levels can place saved calves");
}

#[test]
fn goals_have_a_sign() {
    let analysis = vault();
    let aims = analysis.aims();
    assert_eq!(names(&analysis, &aims.remove), "crown");
    assert_eq!((aims.avatar_must_live, aims.deadline, aims.survive), (true, Some(300), None));
    assert!(aims.protect.is_empty() && aims.create.is_empty() && aims.prevent.is_empty());
    let level = analysis.game().level("A.x\n").unwrap();
    let state = analysis.game().start(&level, base::Seed::from_text("goals"));
    assert_eq!(analysis.goal_met(&state), None);
    let level = analysis.game().level("A..\n").unwrap();
    let state = analysis.game().start(&level, base::Seed::from_text("goals"));
    assert_eq!(analysis.goal_met(&state).map(|goal| (goal.win, goal.line)), Some((true, 1)));
}

#[test]
fn touches_summarise_contacts() {
    let analysis = vault();
    let touch =
        |avatar: &str, other: &str| analysis.touch(named(&analysis, avatar), named(&analysis, other)).clone();
    assert_eq!(touch("plain", "spike").harm, Harm::Kills);
    assert!(touch("plain", "fence").blocks && touch("ghost", "fence").lets_pass());
    assert_eq!(touch("plain", "cloak").becomes, Some(named(&analysis, "ghost")));
    assert_eq!(touch("plain", "crown").score, 9);
    assert_eq!(touch("plain", "crown").removal, Removal::Always);
    assert_eq!(touch("plain", "floor"), Touch::default());
    assert!(analysis.makes_harm(named(&analysis, "post")) && !analysis.makes_harm(named(&analysis, "guard")));
    assert!(analysis.blocks(named(&analysis, "gate"), named(&analysis, "guard")));
}

#[test]
fn a_shooting_gallery() {
    let analysis = Analysis::of(&game(
        "sky > Immovable\nshield > Immovable\nnest > Immovable\nbolt > Missile orientation=UP singleton=True\n\
         egg > Missile orientation=DOWN\nbird > Bomber stype=egg orientation=RIGHT speed=1\n\
         cave > SpawnPoint stype=bird cooldown=8\ngun > FlakAvatar stype=bolt",
        ". > sky\ns > sky shield\nn > sky nest\nb > sky bird\nc > sky cave\nA > sky gun",
        "bird EOS > turnAround\nbolt EOS > killSprite\negg EOS > killSprite\nshield egg > killBoth\nnest egg > killBoth\n\
         bird bolt > killBoth scoreChange=2\ngun EOS > stepBack\ngun egg > killSprite",
        "SpriteCounter stype=gun win=False\nSpriteCounter stype=nest win=False\n\
         MultiSpriteCounter stype1=bird stype2=cave win=True",
    ));
    assert_eq!(
        roles(&analysis, "sky shield nest bolt egg bird cave gun"),
        "sky: Floor, shield: Cover, nest: Ward, bolt: Shot, egg: Enemy, bird: Enemy, cave: Spawner, gun: Avatar"
    );
    let gun = analysis.start_avatar().unwrap();
    assert_eq!((gun.steering, gun.shots.as_slice()), (Steering::Horizontal, &[named(&analysis, "bolt")][..]));
    assert_eq!(analysis.launches(named(&analysis, "bird")), Some((named(&analysis, "egg"), Direction::DOWN)));
    assert_eq!(names(&analysis, &analysis.aims().protect), "nest");
    assert!(!analysis.facts(named(&analysis, "wall")).possible);
}

#[test]
fn pushed_things_and_where_they_go() {
    let analysis = Analysis::of(&game(
        "floor > Immovable\nwall > Immovable\nditch > Immovable\nseal > Immovable\nrock >\n  grey > Passive\n  done > Passive\n\
         hero > MovingAvatar",
        ". > floor\nd > floor ditch\ns > seal\ng > floor grey\nA > floor hero\nw > wall",
        "hero wall ditch > stepBack\nrock hero > bounceForward\nrock wall rock > undoAll\ngrey ditch > killBoth\n\
         grey seal > transformTo stype=done",
        "SpriteCounter stype=grey win=True",
    ));
    assert_eq!(
        roles(&analysis, "floor wall ditch seal grey done"),
        "floor: Floor, wall: Wall, ditch: Socket, seal: Socket, grey: Pushable, done: Pushable"
    );
    let grey = &analysis.pushables()[0];
    assert_eq!(names(&analysis, &grey.blocked_by), "wall grey done");
    let sinks: Vec<_> = grey.sinks.iter().map(|sink| (sink.partner, sink.fate, sink.fills)).collect();
    assert_eq!(
        sinks,
        [
            (named(&analysis, "ditch"), Fate::Goes, true),
            (named(&analysis, "seal"), Fate::Becomes(named(&analysis, "done")), false),
        ]
    );
    assert_eq!(
        analysis.turns(named(&analysis, "grey")),
        [(named(&analysis, "done"), named(&analysis, "seal"))]
    );
    assert!(analysis.is_turn_based() && analysis.is_deterministic());
}

#[test]
fn conditions_switches_and_portals() {
    let analysis = Analysis::of(&game(
        "wall > Immovable\nlava > Immovable\nboots > Resource limit=1\nlever > Immovable\nbars > Immovable\n\
         hole > Portal stype=exit\nexit > Immovable\nheart > Immovable\nrat > RandomNPC\nprize > Door\n\
         hero > MovingAvatar healthPoints=5",
        "w > wall\nl > lava\nb > boots\nv > lever\nr > bars\nh > hole\ne > exit\nt > heart\na > rat\np > prize\nA > hero",
        "hero wall bars > stepBack\nhero lava > killIfHasLess resource=boots limit=0\nboots hero > collectResource\n\
         lever hero > killAll stype=bars\nhero hole > teleportToExit\nhero heart > addHealthPoints killSecond=True\n\
         hero rat > subtractHealthPoints value=2\nprize hero > killSprite",
        "SpriteCounter stype=hero win=False\nSpriteCounter stype=prize win=True",
    ));
    assert_eq!(
        roles(&analysis, "lava boots lever bars hole exit heart rat prize"),
        "lava: Gate, boots: Key, lever: Key, bars: Gate, hole: Portal, exit: PortalExit, heart: Collectable, rat: Enemy, \
         prize: Exit"
    );
    let bars = analysis.locks().iter().find(|lock| lock.stype == named(&analysis, "bars")).unwrap();
    assert_eq!(bars.key, Key::Switch(named(&analysis, "lever"), None));
    assert_eq!(analysis.harm(named(&analysis, "rat")), Harm::Wounds);
    assert_eq!(analysis.harm(named(&analysis, "lava")), Harm::Conditional);
    assert_eq!(analysis.leads_to(named(&analysis, "hole")), Some(named(&analysis, "exit")));
}

/// Checks cases that the reference's own analysis overlooks (`spec/05` A2).
#[test]
fn harm_has_many_ways() {
    let analysis = Analysis::of(&game(
        "moth > Passive\nember > Passive\nfrost > Passive\ncurse > Immovable\nfuse > Immovable\nveil > Immovable\n\
         dust > Immovable\nnest > SpawnPoint stype=hatch\nhatch > SpawnPoint stype=ember\n\
         form >\n  owl > MovingAvatar\n  stone > Immovable\nwraith > Passive",
        "m > moth\ne > ember\nf > frost\nc > curse\nu > fuse\nv > veil\nd > dust\nn > nest\nA > owl",
        "ember owl > killBoth\nowl frost > transformTo stype=dust\nowl curse > transformToRandomChild stype=form\n\
         fuse owl > addTimer timer=3 ftype=killAll stype=owl\nveil owl > transformToAll stype=owl stypeTo=stone\n\
         moth dust > transformIfCount stype=dust stypeCount=moth geq=3 estype=wraith",
        "SpriteCounter stype=moth win=True",
    ));
    let harm = |name: &str| analysis.harm(named(&analysis, name));
    assert_eq!(
        (harm("ember"), harm("frost"), harm("fuse"), harm("veil")),
        (Harm::Kills, Harm::Kills, Harm::Kills, Harm::Kills)
    );
    assert_eq!((harm("curse"), harm("moth")), (Harm::Conditional, Harm::None));
    // The harm comes from two spawners in a chain.
    assert!(
        analysis.makes_harm(named(&analysis, "nest")) && analysis.facts(named(&analysis, "ember")).possible
    );
    assert!(analysis.facts(named(&analysis, "wraith")).possible, "what a count below the limit brings about");
}

#[test]
fn the_same_game_gives_the_same_analysis() {
    let (one, two) = (vault(), vault());
    let text = |analysis: &Analysis| {
        let types = analysis.game().sprite_types();
        let by_type: Vec<_> = types.map(|stype| (analysis.role(stype), analysis.facts(stype))).collect();
        format!("{by_type:?} {:?} {:?}", analysis.locks(), analysis.requirements())
    };
    assert_eq!(text(&one), text(&two));
}

/// Returns the sorted subfolders of a folder in the workspace. If the folder is missing, prints a message and returns
/// an empty list.
#[allow(clippy::print_stderr, reason = "a skipped test says so")]
fn folders(path: &str) -> Vec<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    let Ok(entries) = std::fs::read_dir(&path) else {
        eprintln!("skipped: there is no folder {}", path.display());
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    folders.sort();
    folders
}

fn game_in(folder: &Path) -> Option<Game> {
    let read = |name: &&str| std::fs::read_to_string(folder.join(name)).ok();
    Game::from_source(&["game.vgdl", "game.txt"].iter().find_map(read)?).ok()
}

#[test]
fn six_public_games() {
    let expected = [
        (
            "aliens",
            "base: Cover, sam: Shot, bomb: Enemy, alienBlue: Enemy, portalSlow: Spawner, background: Floor",
        ),
        (
            "boulderdash",
            "dirt: Soil, exitdoor: Exit, diamond: Key, boulder: Boulder, crab: Enemy, wall: Wall",
        ),
        ("escape", "box: Pushable, exit: Exit, hole: Hazard, wall: Wall, floor: Floor"),
        ("realsokoban", "hole: Socket, box: Pushable, boxin: Pushable, ground: Floor, wall: Wall"),
        ("sokoban", "hole: Socket, box: Pushable, wall: Wall, floor: Floor"),
        ("zelda", "goal: Exit, key: Key, sword: Shot, nokey: Avatar, monsterSlow: Enemy, wall: Wall"),
    ];
    for folder in folders("../shared/gvgai/games") {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Some((_, expected)) = expected.iter().find(|(known, _)| *known == name) else { continue };
        let analysis = Analysis::of(&game_in(&folder).unwrap());
        let listed: Vec<&str> = expected.split(", ").map(|part| part.split(':').next().unwrap()).collect();
        assert_eq!(roles(&analysis, &listed.join(" ")), *expected, "{name}");
        let turn_based = ["escape", "realsokoban", "sokoban"].contains(&name.as_str());
        assert_eq!(analysis.is_turn_based(), turn_based, "{name}");
    }
}

/// Checks that every game can be analysed, and has an initial avatar and a winning termination.
#[test]
fn every_game_at_hand() {
    for folder in folders("corpora").into_iter().chain(folders("../shared/gvgai/games")) {
        let Some(game) = game_in(&folder) else { continue };
        let analysis = Analysis::of(&game);
        assert!(analysis.start_avatar().is_some(), "{}", folder.display());
        assert!(analysis.goals().iter().any(|goal| goal.win), "{}", folder.display());
        for stype in game.sprite_types().filter(|&stype| analysis.facts(stype).possible) {
            assert!(analysis.facts(stype).concrete, "{} {}", folder.display(), game.name(stype));
        }
        assert!(!engine::describe(&game).is_empty());
    }
}
