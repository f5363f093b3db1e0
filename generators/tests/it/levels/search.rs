//! Tests of the choice of a variation for a game's levels.

use crate::corpora::own_game;
use base::Seed;
use generators::Variation;
use generators::levels::{LevelConfig, LevelSearch, PuzzleConfig};

#[test]
fn the_kind_of_search_suits_the_game() {
    for (folder, puzzles) in [("quiet-jars", true), ("hailglass", false), ("tinkers-attic", false)] {
        let game = own_game(folder);
        let puzzle = PuzzleConfig { floor_plans: 8, ..PuzzleConfig::default() };
        let search = LevelSearch::new(&game, LevelConfig::default(), puzzle).unwrap();
        assert_eq!(matches!(search, LevelSearch::Puzzles(_)), puzzles, "{folder}");
        let level = search.create(Seed::from_text(folder)).unwrap();
        let next = search.mutate(&level, &mut Seed::from_text(folder).sampler());
        assert_eq!((next.columns(), next.rows()), (level.columns(), level.rows()));
        assert_ne!(next, level, "{folder}");
    }
}
