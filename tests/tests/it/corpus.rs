//! Properties of every game, tested on the corpus: clones, hashes, replays, terminal states and prints. The
//! tests correspond to OpenSpiel's basic tests. Generated games are tested in `robustness.rs`.

use base::{Sampler, Seed};
use engine::{Action, Episode, Game, Level, Outcome, State, syntax};
use std::fs;
use tests::workspace_root;

/// Returns every corpus game with its levels.
fn corpus() -> Vec<(String, Game, Vec<Level>)> {
    let mut folders: Vec<_> =
        fs::read_dir(workspace_root().join("corpora")).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let load = |folder: &std::path::PathBuf| {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let source = fs::read_to_string(folder.join("game.vgdl")).unwrap();
        let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        assert_eq!(game.warnings(), [], "{name}");
        let levels =
            (0..).map_while(|number| fs::read_to_string(folder.join(format!("lvl{number}.txt"))).ok());
        let levels: Vec<Level> = levels.map(|text| game.level(&text).unwrap()).collect();
        assert!(levels.len() >= 3, "{name} has {} levels", levels.len());
        (name, game, levels)
    };
    folders.iter().map(load).collect()
}

/// Plays every corpus level at random, and calls `visit` for every step.
fn wander(ticks: usize, mut visit: impl FnMut(&str, &Game, &mut State, Action, &mut Sampler)) {
    for (name, game, levels) in corpus() {
        for (number, level) in levels.iter().enumerate() {
            let seed = Seed::from_text(&name).child("level", number as u64);
            let mut sampler = seed.child("actions", 0).sampler();
            let mut state = game.start(level, seed.child("chance", 0));
            for _ in 0..ticks {
                let action = *sampler.choose(game.actions(&state));
                visit(&name, &game, &mut state, action, &mut sampler);
            }
        }
    }
}

#[test]
fn stepping_a_copy_leaves_the_original_alone() {
    wander(60, |name, game, state, action, sampler| {
        let before = (state.state_hash(), game.records(state));
        let mut copy = state.clone();
        game.step(&mut copy, action);
        for _ in 0..3 {
            game.step(&mut copy, *sampler.choose(&Action::ALL));
        }
        assert_eq!((state.state_hash(), game.records(state)), before, "{name}");
        // A copy into an existing state equals a new copy.
        copy.clone_from(state);
        assert_eq!(copy.state_hash(), state.state_hash(), "{name}");
        assert_eq!(game.step(&mut copy, action), game.step(state, action), "{name}");
        assert_eq!(copy.state_hash(), state.state_hash(), "{name}");
    });
}

#[test]
fn the_running_hash_is_the_hash_from_scratch() {
    wander(120, |name, game, state, action, _| {
        game.step(state, action);
        assert_eq!(state.state_hash(), state.state_hash_from_scratch(), "{name} tick {}", state.tick());
    });
}

#[test]
fn different_states_have_different_hashes() {
    let mut previous = None;
    wander(40, |name, game, state, action, _| {
        if !state.is_over() {
            game.step(state, action);
            let hash = Some(state.state_hash());
            assert_ne!(hash, previous, "{name}: the tick alone makes a state another one");
            previous = hash;
        }
    });
}

#[test]
fn terminal_states_absorb() {
    wander(1100, |name, game, state, action, _| {
        if state.is_over() {
            let before = state.state_hash();
            assert_eq!(game.step(state, action), state.outcome(), "{name}");
            assert_eq!(state.state_hash(), before, "{name}");
        } else {
            let outcome = game.step(state, action);
            assert!(!matches!(outcome, Outcome::Stopped(_)), "{name}: {outcome:?}");
        }
    });
}

#[test]
fn episodes_replay_bit_for_bit() {
    for (name, game, levels) in corpus() {
        let seed = Seed::from_text(&name);
        let mut sampler = seed.child("actions", 0).sampler();
        let (mut episode, mut state) = Episode::begin(&game, &levels[0], seed);
        while !state.is_over() && episode.actions.len() < 200 {
            episode.play(&game, &mut state, *sampler.choose(&Action::ALL));
        }
        let end = episode.replay(&game, &levels[0]).unwrap();
        assert_eq!(end.state_hash(), state.state_hash(), "{name}");
        // An altered hash is detected at its position.
        let middle = episode.actions.len() / 2;
        let mut other = episode.clone();
        other.hashes[middle].0 ^= 1;
        assert!(
            matches!(other.replay(&game, &levels[0]), Err(engine::Divergence::Hash { tick, .. }) if tick == middle)
        );
        assert!(episode.replay(&game, &levels[1]).is_err(), "{name}: another level");
        other = episode.clone();
        other.score += 1.0;
        assert!(matches!(other.replay(&game, &levels[0]), Err(engine::Divergence::End { .. })));
        // The episode survives a round trip through JSON.
        let text = serde_json::to_string(&episode).unwrap();
        assert_eq!(serde_json::from_str::<Episode>(&text).unwrap(), episode);
    }
}

/// If two sequences of actions lead to the same key, the same subsequent actions keep the keys and the
/// outcomes equal.
#[test]
fn equal_search_keys_have_equal_futures() {
    let mut merged = 0;
    for (name, game, levels) in corpus().into_iter().filter(|(_, game, _)| game.is_deterministic()) {
        for (number, level) in levels.iter().enumerate() {
            let mut sampler = Seed::from_text(&name).child("keys", number as u64).sampler();
            let start = game.start(level, Seed::from_text("any"));
            let mut seen: Vec<(engine::SearchKey, State)> = Vec::new();
            for _ in 0..60 {
                let mut state = start.clone();
                for _ in 0..sampler.between(1, 12) {
                    game.step(&mut state, *sampler.choose(&Action::ALL));
                }
                let key = state.search_key(&game);
                if let Some((_, twin)) = seen.iter().find(|(known, _)| *known == key) {
                    if twin.state_hash() != state.state_hash() {
                        merged += 1;
                    }
                    let mut twin = twin.clone();
                    for _ in 0..40 {
                        let action = *sampler.choose(&Action::ALL);
                        assert_eq!(game.step(&mut state, action), game.step(&mut twin, action), "{name}");
                        assert_eq!(state.search_key(&game), twin.search_key(&game), "{name}");
                    }
                } else {
                    seen.push((key, state));
                }
            }
        }
    }
    assert!(merged > 10, "the keys merge different states: {merged}");
}

#[test]
fn the_canonical_print_is_the_same_game() {
    for (name, game, _) in corpus() {
        let text = syntax::print(game.description());
        let again = Game::from_source(&text).unwrap();
        assert_eq!(again.digest(), game.digest(), "{name}");
        assert_eq!(syntax::print(again.description()), text, "{name}");
    }
}
