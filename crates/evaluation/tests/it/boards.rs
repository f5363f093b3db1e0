//! Tests of boards, legends and images in prompts.

use crate::walk::{Walk, corpus, game, public_games};
use engine::{Action, Observation};
use evaluation::legend::{AVATAR, EntryRole, Legend, LegendOptions};
use evaluation::prompt::{PromptSettings, Prompter};
use evaluation::{Subject, SubjectFacts, encoding};
use std::collections::BTreeMap;

/// Returns the type names by symbol, without floors.
fn by_symbol(legend: &Legend) -> BTreeMap<char, &str> {
    let told = legend.entries().iter().filter(|entry| entry.role != EntryRole::Floor);
    told.map(|entry| (entry.symbol, entry.name.as_str())).collect()
}

#[test]
fn legends_have_a_character_for_each_thing() {
    for subject in corpus() {
        for (tracking, shuffled) in [(false, None), (true, None), (false, Some(3)), (true, Some(4))] {
            let options = LegendOptions { tracking, shuffled };
            let legend = Legend::new(&subject.analysis, &options);
            let told = legend.entries().iter().filter(|entry| entry.role != EntryRole::Floor);
            let (avatars, things): (Vec<_>, Vec<_>) = told.partition(|entry| entry.role == EntryRole::Avatar);
            let expected = things.len() + if tracking { avatars.len() } else { 1 };
            assert_eq!(by_symbol(&legend).len(), expected, "{}: {:?}", subject.id, legend.lines());
            assert!(things.iter().all(|entry| entry.symbol.is_ascii_graphic() && entry.symbol != '.'));
        }
    }
}

/// Parses the grid and the lines about piles. Returns the names in each cell, from the bottom sprite to the
/// top one.
fn read_back(seen: &Observation, legend: &Legend) -> Vec<Vec<String>> {
    let names = by_symbol(legend);
    let grid = encoding::grid(seen, legend);
    assert_eq!(grid.lines().count(), seen.rows);
    let cell = |symbol: char| if symbol == '.' { Vec::new() } else { vec![names[&symbol].to_owned()] };
    let mut cells: Vec<Vec<String>> = grid.lines().flat_map(str::chars).map(cell).collect();
    for line in encoding::stacks(seen, legend) {
        let (pile, places) = line.split_once(": ").unwrap();
        for place in places.split(' ') {
            let (x, y) = place.trim_matches(['(', ')']).split_once(',').unwrap();
            let (x, y): (usize, usize) = (x.parse().unwrap(), y.parse().unwrap());
            cells[y * seen.columns + x] = pile.rsplit(" over ").map(str::to_owned).collect();
        }
    }
    cells
}

/// Checks that everything except floors is shown, and that the avatar is shown at its position.
fn tells_everything(subject: &Subject, legend: &Legend, seen: &Observation) {
    let id = &subject.id;
    let own = |name: &str| seen.avatar.as_ref().is_some_and(|avatar| avatar.name == name);
    for (cell, (read, all)) in read_back(seen, legend).iter().zip(&seen.cells).enumerate() {
        let place = ((cell % seen.columns) as i32, (cell / seen.columns) as i32);
        let is_here = seen.avatar.as_ref().is_some_and(|avatar| (avatar.column, avatar.row) == place);
        let entry =
            |name: &String| legend.entry(name).unwrap_or_else(|| panic!("{id}: {name} is not in the legend"));
        // Sprites that are never drawn (`invisible=`) are in the observation but are not shown.
        let game = &subject.game;
        let seen =
            |name: &str| !game.sprite_type(name).is_some_and(|stype| subject.analysis.facts(stype).hidden);
        let others =
            all.iter().filter(|name| !own(name) && seen(name) && entry(name).role != EntryRole::Floor);
        let others: Vec<&str> = others.map(String::as_str).collect();
        // All of the avatar's states look the same on the board.
        let (below, top) = if is_here { read.split_at(read.len() - 1) } else { (&read[..], &[][..]) };
        assert!(top.iter().all(|name| entry(name).role == EntryRole::Avatar), "{id}: {read:?} at {place:?}");
        let dead = |name: &String| entry(name).role == EntryRole::Avatar && below.len() == 1;
        assert!(below == others || below.iter().any(dead), "{id}: {below:?} for {others:?} at {place:?}");
    }
}

#[test]
fn boards_can_be_read_back_completely() {
    for subject in corpus() {
        let legend = Legend::new(&subject.analysis, &LegendOptions::default());
        for level in 0..subject.levels.len() {
            let mut walk = Walk::new(&subject, level);
            for _ in 0..40 {
                tells_everything(&subject, &legend, &walk.now);
                if !walk.step() {
                    break;
                }
            }
        }
    }
}

/// Boards of the public games also show everything, although these games were not written for prompts. All
/// their prompts can be rendered.
#[test]
fn boards_of_public_games_can_be_read_back() {
    for subject in public_games() {
        let settings =
            [PromptSettings::default(), PromptSettings { masked_names: true, ..PromptSettings::default() }];
        let [plain, masked] = settings.map(|settings| {
            Prompter::new(&subject, settings).unwrap_or_else(|e| panic!("{}: {e}", subject.id))
        });
        let mut walk = Walk::new(&subject, 0);
        for turn in 0..60 {
            tells_everything(&subject, plain.legend(), &walk.now);
            if turn % 20 == 0 {
                for prompter in [&plain, &masked] {
                    let prompt = prompter.prompt(&walk.turn(), &[], &[]);
                    assert!(!prompt.shown.contains("\n\n\n"), "{}", subject.id);
                    assert!(walk.turn().actions.iter().all(|action| prompter.actions().contains(action)));
                }
            }
            if !walk.step() {
                break;
            }
        }
    }
}

/// A game whose avatar turns into a different avatar when it takes a key, and can shoot afterwards.
const KNIGHT: &str = "BasicGame
  SpriteSet
    moss > Immovable
    keys > Immovable
    spark > Missile
    knight >
      squire > MovingAvatar
      rider > ShootAvatar stype=spark
    imp > Immovable
  LevelMapping
    . > moss
    k > moss keys
    i > moss imp
    A > moss squire
  InteractionSet
    squire keys > transformTo stype=rider killSecond=True
    knight imp > stepBack
    imp spark > killSprite
    spark EOS > killSprite
  TerminationSet
    SpriteCounter stype=imp win=True
";

fn knight() -> Subject {
    let levels = [(0, "k.A.i\n".to_owned(), None)];
    Subject::read("knight", KNIGHT, &levels, SubjectFacts::default()).unwrap()
}

#[test]
fn states_of_the_avatar_share_a_character_or_have_their_own() {
    let subject = knight();
    let lines = |options| Legend::new(&subject.analysis, &options).lines();
    let united = lines(LegendOptions::default());
    assert_eq!(united, [". nothing or moss", "@ you: squire or rider", "k keys", "s spark", "i imp"]);
    let apart = lines(LegendOptions { tracking: true, shuffled: None });
    assert_eq!(apart, [". nothing or moss", "A squire", "r rider", "k keys", "s spark", "i imp"]);
    let shuffled = lines(LegendOptions { tracking: false, shuffled: Some(1) });
    assert_eq!(shuffled, lines(LegendOptions { tracking: false, shuffled: Some(1) }));
    assert_ne!(shuffled, lines(LegendOptions { tracking: false, shuffled: Some(2) }));
    assert!(
        shuffled[1].ends_with("you: squire or rider") && !shuffled[1].starts_with(AVATAR),
        "{shuffled:?}"
    );
}

#[test]
fn available_actions_are_listed_where_they_change() {
    let subject = knight();
    let prompter =
        Prompter::new(&subject, PromptSettings { feedback: Some(true), ..PromptSettings::default() })
            .unwrap();
    assert_eq!(prompter.actions().last(), Some(&Action::Use));
    let mut walk = Walk::new(&subject, 0);
    assert_eq!(
        prompter.prompt(&walk.turn(), &[], &[]).shown,
        "## Turn\nTick 0 of at most 1000. Score 0.\nYou are the squire at (2,0).\nActions now: nil, up, left, down, \
         right\n\n## Board\nk.@.i\n\n## Around you\nup: edge of the board\nleft: 1 free, then keys\ndown: edge of the \
         board\nright: 1 free, then imp\nkeys: (0,0)\nimp: (4,0)"
    );
    walk.play(Action::Left);
    walk.play(Action::Left);
    let shown = prompter.prompt(&walk.turn(), &[], &[]).shown;
    let start = "## Turn\nTick 2 of at most 1000. Score 0.\nYou are the rider at (0,0), facing right.\n\n## Last action\nleft \
                 was played. You moved here from (1,0). ";
    assert!(shown.starts_with(start) && shown.contains("You became the rider."), "{shown}");
    assert!(shown.contains("## Board\n@...i\n"), "{shown}");
}

/// A game with two birds of one type that turn around at walls, rain that always falls, and a field of soil.
const FIELD: &str = "BasicGame
  SpriteSet
    floor > Immovable hidden=True
    soil > Immovable
    coin > Immovable
    bird > Missile orientation=RIGHT speed=1
    rain > Missile orientation=DOWN speed=1
    avatar > MovingAvatar
  LevelMapping
    . > floor
    s > soil
    c > coin
    b > bird
    r > rain
    A > avatar
  InteractionSet
    avatar wall > stepBack
    soil avatar > killSprite
    bird wall > reverseDirection
    bird wall > stepBack
    rain wall > killSprite
    rain soil > stepBack
    coin avatar > killSprite scoreChange=1
  TerminationSet
    SpriteCounter stype=coin win=True
";

#[test]
fn directions_are_told_where_they_vary_and_scenery_is_not_listed() {
    let level =
        "wwwwwwwwww\nwb......bw\nwr......Aw\nwssssssssw\nws.......w\nwccccccccw\nwc.......w\nwwwwwwwwww\n";
    let levels = [(0, level.to_owned(), None)];
    let subject = Subject::read("field", FIELD, &levels, SubjectFacts::default()).unwrap();
    let legend = Legend::new(&subject.analysis, &LegendOptions::default());
    let mut walk = Walk::new(&subject, 0);
    assert_eq!(encoding::directions(&walk.now, &legend), ["bird: right (8,1) (1,1)"]);
    let around = encoding::grounding(&walk.now, &legend);
    assert!(!around.iter().any(|line| line.starts_with("soil:")), "{around:?}");
    assert!(
        around.iter().any(|line| line.starts_with("coin:") && line.ends_with("and 1 more")),
        "{around:?}"
    );
    walk.play(Action::Down);
    // One soil sprite has been removed, so the list is now short enough to be shown.
    let around = encoding::grounding(&walk.now, &legend);
    assert!(around.iter().any(|line| line.starts_with("soil: ")), "{around:?}");
    walk.play(Action::Nil);
    assert_eq!(encoding::directions(&walk.now, &legend), ["bird: left (8,1), right (2,1)"]);
}

/// The directions of sprites that stand still are listed if their directions change.
#[test]
fn points_tell_the_way_to_which_they_are_set() {
    let yard = FIELD
        .replace("soil > Immovable", "soil > Missile speed=0 orientation=UP")
        .replace("soil avatar > killSprite", "soil avatar > reverseDirection")
        .replace("rain soil > stepBack", "bird soil > attractGaze");
    let levels = [(0, "wwwww\nw.A.w\nw.s.w\nw.b.w\nw.c.w\nwwwww\n".to_owned(), None)];
    let subject = Subject::read("yard", &yard, &levels, SubjectFacts::default()).unwrap();
    let legend = Legend::new(&subject.analysis, &LegendOptions::default());
    let mut walk = Walk::new(&subject, 0);
    assert_eq!(encoding::directions(&walk.now, &legend)[0], "soil: up (2,2)");
    walk.play(Action::Down);
    assert_eq!(encoding::directions(&walk.now, &legend)[0], "soil: down (2,2)");
}

#[test]
fn pictures_show_the_visible_sprites() {
    let subject = game("first-ice");
    let legend = Legend::new(&subject.analysis, &LegendOptions::default());
    let mut walk = Walk::new(&subject, 1);
    let first = encoding::picture(&walk.now, &legend, 16).unwrap();
    assert_eq!(first, encoding::picture(&walk.now, &legend, 16).unwrap());
    assert!(first.png.starts_with(b"\x89PNG") && first.width as usize >= walk.now.columns * 16);
    for _ in 0..5 {
        walk.step();
    }
    assert_ne!(first, encoding::picture(&walk.now, &legend, 16).unwrap());
    assert!(encoding::picture(&walk.now, &legend, 2).is_err());
}
