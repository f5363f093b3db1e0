//! Puzzles of every kind of destination: compares the backward search with plain forward search, and with the game
//! itself.

use super::floor::{FloorPlans, MAX_POSITIONS};
use super::floor_plan::{FloorPlan, Position, Pushing, bit, each};
use super::rules::{Destination, Rules};
use super::{PuzzleConfig, PuzzleTarget, PuzzleVariation};
use crate::games::PushRules;
use crate::levels::config::LevelConfig;
use crate::levels::constructive::{ConstructiveLevels, Solved};
use crate::levels::grid::Grid;
use crate::levels::tests::{game_in, public_folder, workspace};
use crate::{Generator, Variation};
use agents::search::{Answer, Pushes, SearchLimits, a_star};
use engine::{Action, Analysis, Game, Level, Outcome, Seed, State};
use itertools::Itertools;
use std::collections::{BTreeMap, VecDeque};

/// A game of pushing crates; `sprites`, `mapping` and `rules` define their destination.
fn crates(sprites: &str, mapping: &str, rules: &str) -> Game {
    let source = format!(
        "BasicGame\n  SpriteSet\n    floor > Immovable\n    wall > Immovable\n{sprites}    porter > MovingAvatar\n  \
         LevelMapping\n    . > floor\n    w > wall\n{mapping}    p > floor porter\n  InteractionSet\n    \
         porter wall > stepBack\n{rules}  TerminationSet\n    SpriteCounter stype=crate win=True\n"
    );
    Game::from_source(&source).unwrap()
}

fn sink() -> Game {
    let sprites = "    drain > Immovable\n    crate > Passive\n";
    let mapping = "    o > floor drain\n    c > floor crate\n";
    let rules =
        "    crate porter > bounceForward\n    crate wall crate > undoAll\n    crate drain > killSprite\n";
    crates(sprites, mapping, rules)
}

fn hole() -> Game {
    let sprites = "    pit > Immovable\n    crate > Passive\n";
    let mapping = "    o > floor pit\n    c > floor crate\n";
    let rules = "    crate porter > bounceForward\n    crate wall crate > undoAll\n    crate pit > killBoth\n    \
                 porter pit > stepBack\n";
    crates(sprites, mapping, rules)
}

fn place() -> Game {
    let sprites =
        "    mat > Immovable\n    load > Passive\n      crate > color=BROWN\n      stored > color=GREEN\n";
    let mapping = "    o > mat\n    c > floor crate\n";
    let rules = "    load porter > bounceForward\n    load wall load > undoAll\n    crate mat > transformTo stype=stored\n    \
                 stored floor > transformTo stype=crate\n";
    crates(sprites, mapping, rules)
}

fn levels_of(game: &Game) -> ConstructiveLevels<'_> {
    ConstructiveLevels::new(game, LevelConfig::default()).unwrap()
}

fn rules_of(game: &Game) -> Rules {
    let levels = levels_of(game);
    Rules::of(&levels.analysis, &levels.palette).unwrap()
}

/// Puzzles of 8 by 8 cells with three things.
fn puzzles(game: &Game) -> PuzzleVariation<'_> {
    let config = LevelConfig { columns: (8, 8), rows: (8, 8), ..LevelConfig::default() };
    let puzzle = PuzzleConfig { things: Some(3), ..PuzzleConfig::default() };
    PuzzleVariation::new(game, config, puzzle).unwrap()
}

#[test]
fn rules_are_recognised() {
    assert_eq!(rules_of(&sink()).destinations, [Destination::Sink]);
    assert_eq!(rules_of(&hole()).destinations, [Destination::Hole]);
    assert!(!rules_of(&hole()).walkable[0]);
    assert_eq!(rules_of(&place()).destinations, [Destination::Place]);
    let jars = game_in(&workspace().join("corpora/quiet-jars")).unwrap();
    assert_eq!(rules_of(&jars).destinations, [Destination::Partner; 2]);
}

#[test]
fn other_games_are_rejected_with_a_reason() {
    let refuse = |folder: &str, expect: &str| {
        let game = game_in(&workspace().join("corpora").join(folder)).unwrap();
        let made = PuzzleVariation::new(&game, LevelConfig::default(), PuzzleConfig::default());
        let why = made.err().expect("a game without such puzzles").to_string();
        assert!(why.contains(expect), "{folder}: {why}");
    };
    refuse("bog-lantern", "by chance");
    refuse("tinkers-attic", "by chance");
}

/// The number of pushes from a position to the nearest solved one, by forward search.
fn forward(pushing: &Pushing<'_>, start: Position) -> Option<usize> {
    let key = |position: &Position| (position.things, position.targets, position.avatar);
    let solved = pushing.solved();
    let done = |position: &Position| {
        solved.iter().any(|solved| (solved.things, solved.targets) == (position.things, position.targets))
    };
    let mut known = BTreeMap::from([(key(&start), 0)]);
    let mut queue = VecDeque::from([(start, 0)]);
    while let Some((position, pushes)) = queue.pop_front() {
        if known[&key(&position)] < pushes {
            continue;
        }
        if done(&position) {
            return Some(pushes);
        }
        for stride in pushing.strides() {
            let Some(next) = pushing.step(&position, stride) else { continue };
            let walked = next.things == position.things;
            let cost = pushes + usize::from(!walked);
            if known.get(&key(&next)).is_none_or(|&known| cost < known) {
                known.insert(key(&next), cost);
                if walked { queue.push_front((next, cost)) } else { queue.push_back((next, cost)) }
            }
        }
    }
    None
}

fn floors_of(rules: &Rules, grid: Grid, things: usize) -> FloorPlans<'_> {
    let counts = FloorPlans::counts_of(rules, things);
    FloorPlans { rules, grid, counts, most_positions: MAX_POSITIONS, sills: true }
}

#[test]
fn backward_and_forward_search_agree() {
    let jars = game_in(&workspace().join("corpora/quiet-jars")).unwrap();
    for (game, things) in [(sink(), 2), (hole(), 2), (place(), 2), (jars, 2)] {
        let rules = rules_of(&game);
        let grid = Grid { columns: 7, rows: 6 };
        let floors = floors_of(&rules, grid, things);
        for index in 0..3 {
            let floor_plan: FloorPlan = floors.create(Seed::from_text("agree").child("yard", index)).unwrap();
            let pushing = Pushing { floor_plan: &floor_plan, rules: &rules };
            let searched = pushing.by_pushes(usize::MAX);
            assert!(searched.complete);
            let starts = searched.iter().filter(|(position, _)| pushing.is_start(position));
            for (position, pushes) in starts.step_by(7) {
                assert_eq!(
                    forward(&pushing, *position),
                    Some(pushes),
                    "{:?} {position:?}",
                    rules.destinations
                );
            }
            // Positions that were not found cannot be solved.
            let floor = pushing.lies(0, &Position { targets: floor_plan.targets, ..Position::default() });
            let cells: Vec<usize> = each(floor).collect();
            for pair in cells.windows(2).step_by(3).filter(|_| rules.kinds.len() == 1) {
                let things = [bit(pair[0]) | bit(pair[1]), 0];
                let position = Position { things, targets: floor_plan.targets, avatar: 0 };
                let stands = pushing.stands(&position);
                let region = pushing.flood(stands & stands.wrapping_neg(), stands);
                let position = Position { avatar: region.trailing_zeros() as u8, ..position };
                if pushing.is_start(&position) {
                    assert_eq!(
                        searched.distance(&position),
                        forward(&pushing, position),
                        "{:?}",
                        rules.destinations
                    );
                }
            }
        }
    }
}

#[test]
fn solutions_win_and_levels_vary() {
    for game in [sink(), hole(), place()] {
        let variation = puzzles(&game);
        let seed = Seed::from_text("puzzles");
        let mut sampler = seed.sampler();
        let Solved { mut level, solution } = variation.create_solved(seed).unwrap();
        let mut state = game.start(&level, seed);
        let outcome = solution.unwrap().into_iter().map(|action| game.step(&mut state, action)).last();
        assert_eq!(outcome, Some(Outcome::Won), "{level}");
        let other = variation.create(seed.child("other", 0)).unwrap();
        for _ in 0..4 {
            let next = variation.mutate(&level, &mut sampler);
            assert_ne!(next, level);
            level = variation.cross(&next, &other, &mut sampler);
            let count = |symbol: u8| level.cells().iter().filter(|&&other| other == symbol).count();
            assert_eq!((count(b'c'), count(b'o'), count(b'p')), (3, 3, 1), "{level}");
        }
        assert_eq!(variation.create(seed.child("other", 0)), Some(other));
    }
}

/// Closer to the solution there is less to push. Tested in sum: a floor plan that cannot be furnished is replaced by
/// another.
#[test]
fn a_level_starts_at_the_requested_part_of_the_solution() {
    let game = sink();
    let config = LevelConfig { columns: (8, 8), rows: (8, 8), ..LevelConfig::default() };
    let analysis = Analysis::of(&game);
    let pushes = |way: (f64, f64), index: u64| -> usize {
        let puzzle =
            PuzzleConfig { things: Some(3), floor_plans: 40, way: Some(way), ..PuzzleConfig::default() };
        let variation = PuzzleVariation::new(&game, config.clone(), puzzle).unwrap();
        let solved = variation.create_solved(Seed::from_text("way").child("level", index)).unwrap();
        pushes_among(&analysis, &solved.level, &solved.solution.unwrap())
    };
    let all = |way| (0..4).map(|index| pushes(way, index)).sum::<usize>();
    let [short, half, whole] = [(0.0, 0.2), (0.5, 0.5), (1.0, 1.0)].map(all);
    assert!(short < half && half < whole, "{short}, {half}, {whole}");
    let backwards = PuzzleConfig { way: Some((0.5, 0.2)), ..PuzzleConfig::default() };
    assert!(PuzzleVariation::new(&game, config, backwards).is_err());
}

/// The proved minimum of ticks, with the number of pushes among them.
fn proved(analysis: &Analysis, level: &Level) -> (usize, usize) {
    let state = analysis.game().start(level, Seed::from_text("proof"));
    let pushes = Pushes::of(analysis, level);
    let Answer::Won { actions, shortest: true } =
        a_star(analysis, &pushes, &state, SearchLimits::calls(10_000_000)).answer
    else {
        panic!("not proved\n{level}")
    };
    (actions.len(), pushes_among(analysis, level, &actions))
}

/// The number of these actions that push something.
fn pushes_among(analysis: &Analysis, level: &Level, actions: &[Action]) -> usize {
    let game = analysis.game();
    let mut state = game.start(level, Seed::from_text("proof"));
    let things = |state: &State| {
        let pushed = analysis.pushables().iter().flat_map(|pushable| state.rects(pushable.stype));
        pushed.map(|rect| (rect.x, rect.y)).sorted_unstable().collect_vec()
    };
    let mut count = 0;
    for &action in actions {
        let before = things(&state);
        game.step(&mut state, action);
        count += usize::from(things(&state) != before);
    }
    count
}

/// The model has no more freedom than the game: no win pushes less often than the backward search says.
#[test]
fn puzzles_of_all_rules_meet_their_target_and_agree_with_the_game() {
    let target = PuzzleTarget { pushes: 9, decisions: 16 };
    for rules in PushRules::ALL {
        let game = rules.game();
        let analysis = Analysis::of(&game);
        let config = LevelConfig { columns: (8, 8), rows: (8, 8), ..LevelConfig::default() };
        let puzzle = PuzzleConfig {
            things: Some(2),
            floor_plans: 400,
            target: Some(target),
            ..PuzzleConfig::default()
        };
        let variation = PuzzleVariation::new(&game, config, puzzle).unwrap();
        let Solved { level, solution } = variation.create_solved(Seed::from_text(&rules.name())).unwrap();
        let solution = solution.unwrap();
        let known = pushes_among(&analysis, &level, &solution);
        assert!(known >= target.pushes && solution.len() >= target.decisions, "{}\n{level}", rules.name());
        let (ticks, pushes) = proved(&analysis, &level);
        assert!(ticks <= solution.len() && pushes >= known, "{}: {pushes} {known}\n{level}", rules.name());
    }
}

fn median(mut numbers: Vec<usize>) -> usize {
    numbers.sort_unstable();
    numbers[numbers.len() / 2]
}

/// Tests that levels of 8 by 8 cells with three crates are long, with proof.
fn check_length(game: &Game) {
    let analysis = Analysis::of(game);
    let variation = puzzles(game);
    let seed = |index: u64| Seed::from_text("length").child("level", index);
    let searched: Vec<(usize, usize)> =
        (0..9).map(|index| proved(&analysis, &variation.create(seed(index)).unwrap())).collect();
    let ticks = median(searched.iter().map(|(ticks, _)| *ticks).collect());
    let pushes = median(searched.iter().map(|(_, pushes)| *pushes).collect());
    let config = LevelConfig { columns: (8, 8), rows: (8, 8), ..LevelConfig::default() };
    let constructive = ConstructiveLevels::new(game, config).unwrap();
    let plain: Vec<usize> =
        (0..9).map(|index| proved(&analysis, &constructive.generate(seed(index)).unwrap()).0).collect();
    assert!(pushes >= 20 && ticks >= 45, "{pushes} pushes, {ticks} ticks: {searched:?}");
    assert!(ticks >= 2 * median(plain.clone()), "{ticks} ticks against {plain:?}");
}

#[test]
fn puzzles_are_long() {
    check_length(&sink());
    check_length(&place());
}

#[test]
fn puzzles_of_a_public_game_are_long() {
    let folder = public_folder().join("sokoban");
    if crate::levels::tests::folders(&folder).is_empty() {
        return;
    }
    check_length(&game_in(&folder).expect("a game that the engine plays"));
}
