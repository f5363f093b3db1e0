//! Tests of the variation of levels for searches.

use crate::corpora::{game_in, own};
use base::Seed;
use generators::Variation;
use generators::levels::{LevelConfig, LevelVariation};

#[test]
fn equal_draws_give_equal_levels() {
    for folder in own() {
        let Some(game) = game_in(&folder) else { continue };
        let walk = || {
            let variation = LevelVariation::new(&game, LevelConfig::default()).unwrap();
            let mut sampler = Seed::from_text("walk").sampler();
            let mut level = variation.create(Seed::from_text("walk")).unwrap();
            for _ in 0..30 {
                level = variation.mutate(&level, &mut sampler);
            }
            level.to_string()
        };
        assert_eq!(walk(), walk());
    }
}
