//! Tests of the levels of all games: the corpus games and, if available, public games.

mod measures;
mod puzzles;
mod search;
mod symmetry;
mod variation;
mod yards;

use crate::corpora::{self, game_in, levels_in, name_of};
use base::Seed;
use engine::analysis::{Role, Steering};
use engine::{Action, Analysis, Game, Level, Outcome};
use generators::levels::{ConstructiveLevels, Examples, LevelConfig, cover};
use generators::{GenerateError, Generator};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The number of levels to generate per game.
const SEEDS: u64 = 50;
/// The public games whose levels are all inspected.
const PUBLIC: [&str; 6] = ["aliens", "boulderdash", "escape", "realsokoban", "sokoban", "zelda"];

#[test]
fn levels_of_our_own_games() {
    for folder in corpora::own() {
        if let Some(game) = game_in(&folder) {
            check(&name_of(&folder), &game);
        }
    }
}

#[test]
fn levels_of_six_public_games() {
    for folder in corpora::public() {
        if PUBLIC.contains(&name_of(&folder).as_str()) {
            let game = game_in(&folder).expect("a game that the engine plays");
            check(&name_of(&folder), &game);
        }
    }
}

/// Every game gets a few levels at the extremes of size and difficulty, or a reason, but no panic.
#[test]
fn every_public_game_gets_levels_or_a_reason() {
    let (mut games, mut unlucky) = (0, Vec::new());
    for folder in corpora::public() {
        let Some(game) = game_in(&folder) else { continue };
        games += 1;
        let configs = [((4, 6), (4, 5), 0.0), ((10, 18), (8, 11), 1.0), ((24, 30), (12, 16), 0.3)];
        for (columns, rows, difficulty) in configs {
            let config = LevelConfig { columns, rows, difficulty, ..LevelConfig::default() };
            let Ok(levels) = ConstructiveLevels::new(&game, config) else { continue };
            for index in 0..3 {
                let seed = Seed::from_text("any game").child(&name_of(&folder), index);
                match levels.generate(seed) {
                    Ok(level) => assert_eq!(level.columns().clamp(columns.0, columns.1), level.columns()),
                    Err(GenerateError::Unlucky(_)) => unlucky.push((name_of(&folder), columns.0)),
                    Err(error) => panic!("{}: {error}", name_of(&folder)),
                }
            }
        }
    }
    // The smallest boards do not always have room for everything that a game needs.
    let roomy = unlucky.iter().filter(|(_, columns)| *columns > 4).count();
    assert!(roomy * 50 <= games * 6, "{unlucky:?}");
}

#[test]
fn impossible_games_are_rejected() {
    let source = |mapping: &str, goal: &str| {
        format!(
            "BasicGame\n  SpriteSet\n    wall > Immovable\n    gem > Immovable\n    ghost > Immovable\n    \
             avatar > MovingAvatar\n  LevelMapping\n    {mapping}\n  InteractionSet\n    avatar wall > stepBack\n    \
             gem avatar > killSprite\n  TerminationSet\n    SpriteCounter stype={goal} win=True\n"
        )
    };
    let refuse = |text: String, config: LevelConfig, expect: &str| {
        let game = Game::from_source(&text).unwrap();
        match ConstructiveLevels::new(&game, config) {
            Err(GenerateError::Unsuitable(why)) => assert!(why.contains(expect), "{why}"),
            _ => panic!("{expect}"),
        }
    };
    refuse(source("A > avatar avatar", "gem"), LevelConfig::default(), "exactly one avatar");
    refuse(source("g > gem", "ghost"), LevelConfig::default(), "termination 1");
    refuse(source("g > gem", "gem limit=2147483647"), LevelConfig::default(), "termination 1");
    let waited = source("g > gem", "gem").replace("SpriteCounter stype=gem", "Timeout limit=50");
    refuse(waited, LevelConfig::default(), "won by waiting");
    let never = source("g > gem", "gem").replace("win=True", "win=False");
    refuse(never, LevelConfig::default(), "no winning termination");
    let narrow = LevelConfig { columns: (3, 9), ..LevelConfig::default() };
    refuse(source("g > gem", "gem"), narrow, "columns from 3 to 9");
    let hard = LevelConfig { difficulty: 1.5, ..LevelConfig::default() };
    refuse(source("g > gem", "gem"), hard, "difficulty 1.5");
}

/// Numbers that no level can meet take no time and cause no panic.
#[test]
fn extreme_configurations_do_not_panic() {
    let source = "BasicGame\n  SpriteSet\n    wall > Immovable\n    gem > Resource limit=2147483647 value=1\n    \
                  door > Door\n    gate > Door\n    foe > Chaser stype=hero speed=1e300 cooldown=2147483647\n    \
                  hero > MovingAvatar\n  LevelMapping\n    w > wall\n    g > gem\n    d > door\n    t > gate\n    \
                  f > foe\n    h > hero\n  InteractionSet\n    hero wall gate > stepBack\n    gem hero > collectResource\n    \
                  door hero > killIfOtherHasMore resource=gem limit=2147483647 subtract=True\n    \
                  gate hero > killIfOtherHasMore resource=gem limit=2147483647 subtract=True\n    \
                  hero foe > killIfHasLess resource=gem limit=2147483647\n  TerminationSet\n    \
                  SpriteCounter stype=door limit=0 win=True\n    SpriteCounter stype=gem limit=-2147483648 win=True\n    \
                  MultiSpriteCounter stype1=foe stype2=gem limit=2147483647 win=False\n";
    let game = Game::from_source(source).unwrap();
    assert!(!engine::describe(&game).is_empty());
    let levels = ConstructiveLevels::new(&game, LevelConfig::default()).unwrap();
    let made = levels.generate(Seed::from_text("absurd"));
    assert!(matches!(made, Err(GenerateError::Unlucky(_))), "{made:?}");
}

#[test]
fn harder_levels_hold_more_harmful_things() {
    let source = "BasicGame\n  SpriteSet\n    floor > Immovable\n    wall > Immovable\n    pit > Immovable\n    \
                  ghoul > RandomNPC\n    door > Door\n    hero > MovingAvatar\n  LevelMapping\n    . > floor\n    \
                  w > wall\n    p > floor pit\n    g > floor ghoul\n    d > floor door\n    h > floor hero\n  \
                  InteractionSet\n    hero wall > stepBack\n    ghoul wall > stepBack\n    hero pit ghoul > killSprite\n    \
                  door hero > killSprite\n  TerminationSet\n    SpriteCounter stype=hero win=False\n    \
                  SpriteCounter stype=door win=True\n";
    let game = Game::from_source(source).unwrap();
    let harmful = |difficulty: f64| -> usize {
        let levels =
            ConstructiveLevels::new(&game, LevelConfig { difficulty, ..LevelConfig::default() }).unwrap();
        let made =
            (0..30).map(|index| levels.generate(Seed::from_text("hard").child("level", index)).unwrap());
        made.map(|level| level.cells().iter().filter(|symbol| b"pg".contains(symbol)).count()).sum()
    };
    let (easy, middle, hard) = (harmful(0.0), harmful(0.5), harmful(1.0));
    assert!(easy < middle && middle < hard, "{easy} {middle} {hard}");
}

/// The generated levels of each corpus game resemble the game's own levels.
#[test]
fn levels_resemble_their_examples() {
    for folder in corpora::own() {
        let Some(game) = game_in(&folder) else { continue };
        let name = name_of(&folder);
        let own = levels_in(&folder, &game);
        let examples = Arc::new(Examples::of(&game, &own).expect("games of ours have levels"));
        let config = LevelConfig::like(examples.clone());
        let levels = ConstructiveLevels::new(&game, config).unwrap();
        let mut covered = 0;
        for index in 0..10 {
            let seed = Seed::from_text("like").child(&name, index);
            let level = levels.generate(seed).unwrap_or_else(|error| panic!("{name} {index}: {error}"));
            let (columns, rows) = (examples.columns(), examples.rows());
            assert!((columns.0..=columns.1).contains(&level.columns()), "{name} {index}\n{level}");
            assert!((rows.0..=rows.1).contains(&level.rows()), "{name} {index}\n{level}");
            let (low, high) = examples.cover();
            covered += u32::from((low..=high).contains(&cover(levels.analysis(), &level)));
            assert!(own.iter().all(|own| own.cells() != level.cells()), "{name} {index}: nothing new");
            goals_lie_open(&name, levels.analysis(), &level);
        }
        assert!(covered >= 9, "{name}: {covered} of 10");
    }
}

/// Learnt walls can leave a small board without a free cell.
#[test]
fn the_smallest_boards_are_levels_or_none() {
    for folder in corpora::own().into_iter().chain(corpora::public()) {
        let Some(game) = game_in(&folder) else { continue };
        let own = levels_in(&folder, &game);
        let examples = Examples::of(&game, &own).map(Arc::new);
        for side in [4, 5, 6] {
            let like = examples.clone().map_or_else(LevelConfig::default, LevelConfig::like);
            let config = LevelConfig { columns: (side, side + 1), rows: (side, side), cover: None, ..like };
            let Ok(generator) = ConstructiveLevels::new(&game, config) else { continue };
            for number in 0..if std::env::var_os("ARCADE_SWEEP").is_some() { 6 } else { 2 } {
                match generator.generate(Seed::from_text("small").child(&name_of(&folder), number)) {
                    Ok(level) => assert_eq!(level.rows(), side, "{}", folder.display()),
                    Err(error) => assert!(matches!(error, GenerateError::Unlucky(_)), "{error}"),
                }
            }
        }
    }
}

/// Exact numbers are met, or the level is rejected.
#[test]
fn exact_numbers_are_placed() {
    let source = "BasicGame\n  SpriteSet\n    wall > Immovable\n    drain > Immovable\n    coin > Immovable\n    \
                  crate > Passive\n    avatar > MovingAvatar\n  LevelMapping\n    o > drain\n    c > crate\n    \
                  $ > coin\n  InteractionSet\n    avatar wall > stepBack\n    coin avatar > killSprite\n    \
                  crate avatar > bounceForward\n    crate wall crate > undoAll\n    crate drain > killSprite\n  \
                  TerminationSet\n    SpriteCounter stype=crate win=True\n";
    let game = Game::from_source(source).unwrap();
    let named = |name: &str| game.sprite_types().find(|&stype| game.name(stype) == name).unwrap();
    for (crates, coins) in [(1, 0), (3, 5), (4, 1)] {
        let counts = vec![(named("crate"), crates), (named("coin"), coins)];
        let config = LevelConfig { counts, ..LevelConfig::default() };
        let levels = ConstructiveLevels::new(&game, config).unwrap();
        let level = levels.generate(Seed::from_text("asked").child("crates", crates as u64)).unwrap();
        let count = |symbol: u8| level.cells().iter().filter(|&&cell| cell == symbol).count();
        assert_eq!((count(b'c'), count(b'$')), (crates, coins), "\n{level}");
    }
    let coins = |count| LevelConfig { counts: vec![(named("coin"), count)], ..LevelConfig::default() };
    let refused = ConstructiveLevels::new(&game, coins(160)).unwrap().generate(Seed::from_text("asked"));
    assert!(matches!(refused, Err(GenerateError::Unlucky(why)) if why.contains("160 of coin")));
    // There are more sprites than the largest board has cells, so the configuration is rejected before any seed is
    // used.
    let refused = ConstructiveLevels::new(&game, coins(900)).map(|_| ());
    assert!(matches!(refused, Err(GenerateError::Unsuitable(why)) if why.contains("900 sprites")));
}

/// A sprite that is larger than a cell gets all the space that it covers.
#[test]
fn large_sprites_overlap_nothing() {
    for (class, by) in [("FlakAvatar stype=spark", "spark"), ("MovingAvatar", "boat")] {
        let source = format!(
            "BasicGame\n  SpriteSet\n    stone > Immovable\n    crate > Passive wMult=2\n    post > Passive hMult=1.5\n    \
             spark > Missile orientation=UP\n    boat > {class} wMult=3\n  LevelMapping\n    s > stone\n    c > crate\n    \
             p > post\n    b > boat\n  InteractionSet\n    boat stone EOS > stepBack\n    \
             crate {by} > killSprite\n  TerminationSet\n    SpriteCounter stype=crate limit=0 win=True\n"
        );
        let game = Game::from_source(&source).unwrap();
        let own = game
            .level("s          s\n c c   s  c \n       ss   \n  p    s p  \n            \ns   b      s\n");
        let examples = Arc::new(Examples::of(&game, &[own.unwrap()]).unwrap());
        let levels = ConstructiveLevels::new(&game, LevelConfig::like(examples)).unwrap();
        for index in 0..SEEDS {
            let level = levels.generate(Seed::from_text("large").child(class, index)).unwrap();
            let mut taken = BTreeSet::new();
            for (cell, &symbol) in level.cells().iter().enumerate() {
                let (columns, rows) = match symbol {
                    b'b' => (3, 1),
                    b'c' => (2, 1),
                    b'p' => (1, 2),
                    b's' => (1, 1),
                    _ => continue,
                };
                let (x, y) = (cell % level.columns(), cell / level.columns());
                assert!(x + columns <= level.columns() && y + rows <= level.rows(), "\n{level}");
                for y in y..y + rows {
                    assert!((x..x + columns).all(|x| taken.insert((x, y))), "{x} {y}\n{level}");
                }
            }
        }
    }
}

/// A large avatar is shifted so that it does not open the wall around the board.
#[test]
fn a_large_avatar_stands_inside_the_wall() {
    let source = "BasicGame\n  SpriteSet\n    wall > Immovable\n    coin > Resource\n    \
                  ogre > MovingAvatar wMult=2 hMult=3\n  LevelMapping\n    w > wall\n    c > coin\n    o > ogre\n  \
                  InteractionSet\n    ogre wall > stepBack\n    coin ogre > killSprite\n  TerminationSet\n    \
                  SpriteCounter stype=coin limit=0 win=True\n";
    let game = Game::from_source(source).unwrap();
    let levels = ConstructiveLevels::new(&game, LevelConfig::default()).unwrap();
    for index in 0..SEEDS {
        let level = levels.generate(Seed::from_text("ogre").child("level", index)).unwrap();
        let (columns, rows) = (level.columns(), level.rows());
        let on_border = |cell: usize| {
            let (x, y) = (cell % columns, cell / columns);
            x == 0 || y == 0 || x + 1 == columns || y + 1 == rows
        };
        let start = level.cells().iter().position(|&symbol| symbol == b'o').unwrap();
        let (x, y) = (start % columns, start / columns);
        assert!(x + 2 < columns && y + 3 < rows, "\n{level}");
        let closed =
            level.cells().iter().enumerate().all(|(cell, &symbol)| symbol == b'w' || !on_border(cell));
        assert!(closed, "\n{level}");
    }
}

/// This is a golden test. If this level changes, `GENERATION` must be incremented.
#[test]
fn levels_are_frozen() {
    let game = Game::from_source(
        "BasicGame\n  SpriteSet\n    wall > Immovable\n    gem > Resource limit=9\n    gate > Door\n    exit > Door\n    \
         bat > RandomNPC cooldown=2\n    hero > MovingAvatar\n  LevelMapping\n    w > wall\n    g > gem\n    d > gate\n    \
         x > exit\n    b > bat\n    h > hero\n  InteractionSet\n    hero wall gate > stepBack\n    \
         gem hero > collectResource\n    gate hero > killIfOtherHasMore resource=gem limit=2\n    bat wall gate > stepBack\n    \
         exit hero > killSprite\n    hero bat > killSprite\n  TerminationSet\n    SpriteCounter stype=hero win=False\n    \
         SpriteCounter stype=exit win=True\n",
    )
    .unwrap();
    let levels = ConstructiveLevels::new(&game, LevelConfig::default()).unwrap();
    let level = levels.generate(Seed::from_text("golden")).unwrap();
    assert_eq!(level.to_string(), GOLDEN, "\n{level}");
}

const GOLDEN: &str = "\
wwwwwwwwwwwwwwww
w     w     g  w
w    xw     w  w
w ww wwww www  w
w b   w     w  w
w     w  b  w hw
w     d    gw  w
wwwwwwwwwwwwwwww
";

#[test]
fn solutions_win() {
    let source = "BasicGame\n  SpriteSet\n    floor > Immovable\n    wall > Immovable\n    drain > Immovable\n    \
                  crate > Passive\n    hero > MovingAvatar\n  LevelMapping\n    . > floor\n    w > wall\n    o > floor drain\n    \
                  c > floor crate\n    h > floor hero\n  InteractionSet\n    hero wall > stepBack\n    \
                  crate hero > bounceForward\n    crate wall crate > undoAll\n    crate drain > killSprite\n  \
                  TerminationSet\n    SpriteCounter stype=crate win=True\n";
    let game = Game::from_source(source).unwrap();
    let levels = ConstructiveLevels::new(&game, LevelConfig::default()).unwrap();
    for index in 0..30 {
        let seed = Seed::from_text("crates").child("level", index);
        let solved = levels.generate_solved(seed).unwrap();
        let mut state = game.start(&solved.level, seed);
        let outcomes =
            solved.solution.expect("a puzzle").into_iter().map(|action| game.step(&mut state, action));
        assert_eq!(outcomes.last(), Some(Outcome::Won), "{}", solved.level);
    }
}

/// Checks the guarantees of [`ConstructiveLevels`] for one game.
fn check(name: &str, game: &Game) {
    let levels = ConstructiveLevels::new(game, LevelConfig::default())
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let analysis = levels.analysis();
    let mut different = BTreeSet::new();
    let mut survivors = 0;
    for index in 0..SEEDS {
        let seed = Seed::from_text("check").child(name, index);
        let level = levels.generate(seed).unwrap_or_else(|error| panic!("{name} {index}: {error}"));
        let again = levels.generate(seed).map(|level| level.to_string());
        assert_eq!(again, Ok(level.to_string()), "{name} {index}");
        assert_eq!(game.level(&level.to_string()).as_ref(), Ok(&level), "{name} {index}");
        different.insert(level.to_string());
        let state = game.start(&level, seed);
        assert_eq!(analysis.goal_met(&state), None, "{name} {index}\n{level}");
        assert!(state.avatar_id().is_some(), "{name} {index}\n{level}");
        goals_lie_open(name, analysis, &level);
        survivors += u64::from(survives(game, &level, seed));
    }
    assert!(different.len() as u64 * 10 >= SEEDS * 9, "{name}: {} levels", different.len());
    // The wolves of the bellwether come out in the first tick and chase the sheep.
    let lost = if name == "bellwether-down" { SEEDS / 10 } else { SEEDS / 20 };
    assert!(survivors + lost >= SEEDS, "{name}: {survivors} of {SEEDS} survive doing nothing");
}

/// Checks that everything that counts for a win can be reached through open cells.
fn goals_lie_open(name: &str, analysis: &Analysis, level: &Level) {
    let game = analysis.game();
    let steering = analysis.start_avatar().map(|avatar| avatar.steering);
    if matches!(steering, Some(Steering::Horizontal | Steering::Vertical)) {
        return;
    }
    let holds = |cell: usize, wanted: &dyn Fn(engine::SpriteType) -> bool| {
        game.places(level.cells()[cell]).iter().any(|&stype| wanted(stype))
    };
    let size = level.cells().len();
    let is_wall = |cell: usize| holds(cell, &|stype| analysis.role(stype) == Role::Wall);
    let avatar = (0..size).find(|&cell| holds(cell, &|stype| analysis.role(stype) == Role::Avatar));
    let mut reached = vec![false; size];
    let mut todo = vec![avatar.expect("a level has an avatar")];
    while let Some(cell) = todo.pop() {
        if std::mem::replace(&mut reached[cell], true) {
            continue;
        }
        let (x, y, columns) = (cell % level.columns(), cell / level.columns(), level.columns());
        let beside = [
            (x > 0).then(|| cell - 1),
            (x + 1 < columns).then_some(cell + 1),
            (y > 0).then(|| cell - columns),
            (y + 1 < level.rows()).then_some(cell + columns),
        ];
        todo.extend(beside.into_iter().flatten().filter(|&next| !reached[next] && !is_wall(next)));
    }
    for (cell, reached) in reached.into_iter().enumerate() {
        let goal = holds(cell, &|stype| {
            analysis.role(stype) == Role::Exit || analysis.aims().remove.contains(&stype)
        });
        assert!(!goal || reached, "{name}: cell {cell} cannot be reached\n{level}");
    }
}

/// Returns `true` if a player who does nothing survives ten ticks.
fn survives(game: &Game, level: &Level, seed: Seed) -> bool {
    let mut state = game.start(level, seed.child("survival", 0));
    (0..10).all(|_| !matches!(game.step(&mut state, Action::Nil), Outcome::Lost | Outcome::Stopped(_)))
}
