//! Planes that are updated incrementally show the same sprites as observations.

use base::Seed;
use engine::{Action, Drawn, Game, Level, Planes, SpriteType, State};
use tests::{games, public_games, workspace_root};

/// Returns the planes that correspond to an observation.
fn observed(game: &Game, state: &State, types: &[SpriteType], columns: usize, rows: usize) -> Vec<u8> {
    let seen = game.observe(state);
    let mut planes = vec![0; types.len() * columns * rows];
    for (cell, names) in seen.cells.iter().enumerate() {
        let at = cell / seen.columns * columns + cell % seen.columns;
        for name in names {
            let plane = types.iter().position(|&stype| game.name(stype) == name).expect("it is shown");
            planes[plane * columns * rows + at] = 1;
        }
    }
    planes
}

fn check(name: &str, game: &Game, levels: &[Level]) {
    let size = |size: fn(&Level) -> usize| levels.iter().map(size).max().unwrap_or_default();
    let (columns, rows) = (size(Level::columns), size(Level::rows));
    let planes = Planes::new(game, game.sprite_types(), columns, rows);
    let seed = Seed::from_text(name);
    let mut sampler = seed.sampler();
    let (mut drawn, mut board) = (Drawn::default(), vec![0; planes.size()]);
    for (number, level) in levels.iter().enumerate() {
        let mut state = game.start(level, seed.child("level", number as u64));
        planes.draw(&mut state, &mut drawn, &mut board);
        for tick in 0..250 {
            assert!(
                board == observed(game, &state, planes.types(), columns, rows),
                "{name}, level {number}, tick {tick}: the planes differ from the observation"
            );
            assert_eq!(state.state_hash(), state.state_hash_from_scratch(), "{name}");
            if state.is_over() {
                break;
            }
            game.step(&mut state, *sampler.choose(&Action::ALL));
            planes.update(&mut state, &mut drawn, &mut board);
        }
    }
}

#[test]
fn planes_follow_the_games_of_the_corpus() {
    for (name, game, levels) in games(&workspace_root().join("corpora")) {
        check(&name, &game, &levels);
    }
}

#[test]
fn planes_follow_public_games() {
    let Some(folder) = public_games() else { return };
    for (name, game, levels) in games(&folder) {
        check(&name, &game, &levels);
    }
}
