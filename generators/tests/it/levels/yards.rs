//! Tests of the generator of yards, which are puzzles about carrying parcels.

use base::Seed;
use engine::{Episode, Outcome};
use generators::games::YardRules;
use generators::levels::YardConfig;

#[test]
fn boards_without_room_have_no_level() {
    let small = YardConfig { columns: (0, 5), rows: (0, 5), ..YardConfig::default() };
    assert_eq!(small.level(YardRules::ALL[0], Seed::from_text("small")), None);
    let tight = YardConfig { columns: (6, 6), rows: (6, 6), yards: 20, ..YardConfig::default() };
    assert_eq!(tight.level(YardRules::ALL[0], Seed::from_text("tight")), None);
}

/// Carts run in the game as in the timetable, so the solution wins in its last tick.
#[test]
fn levels_are_won_as_their_solutions_say() {
    for rules in YardRules::ALL {
        let game = rules.game();
        let config = YardConfig { decisions: (20, 50), carts: 8, exposure: 0.3, ..YardConfig::default() };
        let mut made = 0;
        for number in 0..4 {
            let seed = Seed::from_text("yards").child(&rules.name(), number);
            let Some(level) = config.level(rules, seed) else { continue };
            let ticks = level.solution.len();
            let board = game.level(&level.text).unwrap_or_else(|problems| panic!("{problems}"));
            let (mut episode, mut state) = Episode::begin(&game, &board, seed);
            for action in level.solution {
                episode.play(&game, &mut state, action);
            }
            assert_eq!(
                (episode.outcome, episode.actions.len()),
                (Outcome::Won, ticks),
                "{}\n{}",
                rules.name(),
                level.text
            );
            made += 1;
        }
        assert!(made > 0, "{}", rules.name());
    }
}
