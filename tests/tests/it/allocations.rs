//! A warm step allocates no memory, because planners take millions of steps.

use base::Seed;
use engine::{Action, Game, Level, State};
use std::path::Path;
use tests::{games, public_games, workspace_root};

/// Plays an episode twice into the same state, and returns the number of allocations during the second run.
fn allocations(game: &Game, level: &Level, ticks: usize) -> u64 {
    let seed = Seed::from_text("warm");
    let start = game.start(level, seed);
    let actions: Vec<Action> = {
        let mut sampler = seed.child("actions", 0).sampler();
        (0..ticks).map(|_| *sampler.choose(&Action::ALL)).collect()
    };
    let mut state = start.clone();
    let play = |state: &mut State| {
        state.clone_from(&start);
        for &action in &actions {
            game.step(state, action);
            state.settle_hash();
        }
    };
    play(&mut state);
    allocation_counter::measure(|| play(&mut state)).count_total
}

fn check(folder: &Path, only: &[&str]) {
    for (name, game, levels) in games(folder) {
        if only.is_empty() || only.contains(&name.as_str()) {
            assert_eq!(allocations(&game, &levels[0], 500), 0, "{name}");
        }
    }
}

#[test]
fn warm_steps_of_corpus_games_allocate_nothing() {
    check(&workspace_root().join("corpora"), &[]);
}

#[test]
fn warm_steps_of_public_games_allocate_nothing() {
    let Some(folder) = public_games() else { return };
    check(&folder, &["aliens", "boulderdash", "escape", "realsokoban", "sokoban", "zelda"]);
}
