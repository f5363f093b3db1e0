//! Tests of puzzles with every kind of destination. The puzzles are compared with the game itself and with the
//! agents' searches.

mod crates;
mod strays;

use self::crates::{hole, place, sink};
use crate::corpora::{self, game_in, name_of, own_game};
use agents::search::{Answer, Pushes, SearchLimits, a_star};
use base::Seed;
use engine::{Action, Analysis, Game, Level, Outcome, State};
use generators::games::PushRules;
use generators::levels::{
    ConstructiveLevels, LevelConfig, PuzzleConfig, PuzzleTarget, PuzzleVariation, Solved,
};
use generators::{Generator, Variation};
use itertools::Itertools;

/// Returns a variation of puzzles of 8 by 8 cells with three things.
fn puzzles(game: &Game) -> PuzzleVariation<'_> {
    let config = LevelConfig { columns: (8, 8), rows: (8, 8), ..LevelConfig::default() };
    let puzzle = PuzzleConfig { things: Some(3), ..PuzzleConfig::default() };
    PuzzleVariation::new(game, config, puzzle).unwrap()
}

#[test]
fn other_games_are_rejected_with_a_reason() {
    let refuse = |folder: &str, expect: &str| {
        let game = own_game(folder);
        let made = PuzzleVariation::new(&game, LevelConfig::default(), PuzzleConfig::default());
        let why = made.err().expect("a game without such puzzles").to_string();
        assert!(why.contains(expect), "{folder}: {why}");
    };
    refuse("bog-lantern", "at random");
    refuse("tinkers-attic", "at random");
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

/// The closer the start is to the solution, the less there is to push. The sum is tested because a floor plan without
/// room for the other sprites is replaced by a different one.
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

/// Returns the proved minimum number of ticks, and the number of pushes in that win.
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

/// Returns the number of actions that push something.
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

/// The model allows no more than the game, so no win has fewer pushes than the backward search found.
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

/// Checks with proofs that levels of 8 by 8 cells with three crates are long.
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
    let sokoban = corpora::public().into_iter().filter(|folder| name_of(folder) == "sokoban");
    for folder in sokoban {
        check_length(&game_in(&folder).expect("a game that the engine plays"));
    }
}
