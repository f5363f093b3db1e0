//! Tests of batches. On any number of threads, each lane plays the same episode as it would play alone.

use agents::{Batch, BatchError};
use base::{Sampler, Seed};
use engine::{Action, Game, Level, State, StateHash};
use proptest::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use tests::any_game::any_game;
use tests::choices::Choices;
use tests::{games, public_games, workspace_root};

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
}

fn any_actions(count: usize, sampler: &mut Sampler) -> Vec<Action> {
    (0..count).map(|_| *sampler.choose(&Action::ALL)).collect()
}

fn hashes(states: &[State]) -> Vec<StateHash> {
    states.iter().map(State::state_hash).collect()
}

/// Plays episodes in a batch and one by one, and returns the batch's states after each tick.
fn episodes(name: &str, game: &Game, levels: &[Level], lanes: usize, ticks: usize) -> Vec<StateHash> {
    let seed = Seed::from_text(name);
    let mut sampler = seed.child("actions", 0).sampler();
    let mut batch = Batch::start(game, levels, lanes, seed.child("batch", 0)).unwrap();
    let begin =
        |batch: &Batch, lane: usize| game.start(&levels[lane % levels.len()], batch.seed(lane).unwrap());
    let mut alone: Vec<State> = (0..lanes).map(|lane| begin(&batch, lane)).collect();
    let mut history = hashes(batch.states());
    for _ in 0..ticks {
        let actions = any_actions(lanes, &mut sampler);
        batch.step(&actions).unwrap();
        for (lane, state) in alone.iter_mut().enumerate() {
            assert_eq!(game.step(state, actions[lane]), batch.outcomes()[lane], "{name}");
            assert_eq!(state.score(), batch.scores()[lane], "{name}");
        }
        assert_eq!(hashes(&alone), hashes(batch.states()), "{name}");
        let over: Vec<usize> = (0..lanes).filter(|&lane| alone[lane].is_over()).collect();
        assert_eq!(batch.reset_over(), over.len());
        over.into_iter().for_each(|lane| alone[lane] = begin(&batch, lane));
        assert_eq!(hashes(&alone), hashes(batch.states()), "{name}");
        history.extend(hashes(batch.states()));
    }
    history
}

#[test]
fn lanes_are_episodes_on_any_number_of_threads() {
    for (name, game, levels) in games(&workspace_root().join("corpora")) {
        let on = |threads| pool(threads).install(|| episodes(&name, &game, &levels, 200, 50));
        let one = on(1);
        assert!(on(2) == one && on(3) == one, "{name}: threads make a difference");
    }
}

#[test]
fn lanes_of_public_games_are_episodes() {
    let Some(folder) = public_games() else { return };
    let pool = pool(2);
    for (name, game, levels) in games(&folder) {
        pool.install(|| episodes(&name, &game, &levels, 130, 8));
    }
}

/// A lane's episode does not depend on other lanes or on their number.
#[test]
fn lanes_are_independent() {
    let (name, game, levels) = games(&workspace_root().join("corpora")).swap_remove(0);
    let seed = Seed::from_text(&name);
    let mut few = Batch::start(&game, &levels, 3, seed).unwrap();
    let mut many = Batch::start(&game, &levels, 90, seed).unwrap();
    let mut sampler = seed.sampler();
    for tick in 0..40 {
        let actions = any_actions(90, &mut sampler);
        few.step(&actions[..3]).unwrap();
        many.step(&actions).unwrap();
        if tick % 10 == 9 {
            few.reset(1).unwrap();
            (0..90).filter(|lane| lane % 3 == 1).for_each(|lane| many.reset(lane).unwrap());
        }
        assert_eq!(hashes(few.states()), hashes(&many.states()[..3]));
    }
    assert_ne!(few.seed(0), few.seed(1));
}

#[test]
fn invalid_batches_are_reported() {
    let (_, game, levels) = games(&workspace_root().join("corpora")).swap_remove(0);
    let seed = Seed::from_text("errors");
    assert_eq!(Batch::start(&game, &[], 2, seed).err(), Some(BatchError::NoLevels));
    let mut batch = Batch::start(&game, &levels, 2, seed).unwrap();
    let before = hashes(batch.states());
    let three = [Action::Use; 3];
    assert_eq!(batch.step(&three), Err(BatchError::Actions { actions: 3, lanes: 2 }));
    assert_eq!(batch.play(&three), Err(BatchError::Plans { actions: 3, lanes: 2 }));
    assert_eq!(batch.reset(2), Err(BatchError::NoLane { lane: 2, lanes: 2 }));
    assert_eq!(batch.seed(2), Err(BatchError::NoLane { lane: 2, lanes: 2 }));
    batch.play(&[]).unwrap();
    assert_eq!(hashes(batch.states()), before);
    // An empty batch does nothing.
    let mut none = Batch::start(&game, &levels, 0, seed).unwrap();
    assert!(none.is_empty());
    assert_eq!(none.step(&[]), Ok(&[][..]));
    assert_eq!(none.play(&three), Err(BatchError::Plans { actions: 3, lanes: 0 }));
    assert_eq!(none.reset_over(), 0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    /// Playing a plan is equivalent to playing its actions tick by tick, from any state of any game. The
    /// original state stays unchanged.
    #[test]
    fn plans_are_steps(
        bytes in prop::collection::vec(any::<u8>(), 0..300),
        lanes in 1usize..20,
        ticks in 0usize..16,
        threads in 1usize..4,
    ) {
        let made = any_game(&mut Choices::new(&bytes));
        let Ok(game) = Game::from_source_as_reference(&made.source) else { return Ok(()) };
        let Ok(level) = game.level(&made.level) else { return Ok(()) };
        let seed = Seed::from_text("plans");
        let mut sampler = seed.sampler();
        let mut state = game.start(&level, seed);
        for action in any_actions(lanes, &mut sampler) {
            game.step(&mut state, action);
        }
        let before = state.state_hash();
        let plans = any_actions(lanes * ticks, &mut sampler);
        let mut stepped = Batch::fork(&game, &state, lanes, seed);
        for tick in 0..ticks {
            let actions: Vec<Action> = (0..lanes).map(|lane| plans[lane * ticks + tick]).collect();
            stepped.step(&actions).unwrap();
        }
        let mut played = Batch::start(&game, &[level], lanes, seed).unwrap();
        pool(threads).install(|| {
            played.fork_from(&state, seed);
            played.play(&plans).unwrap();
        });
        prop_assert_eq!(hashes(played.states()), hashes(stepped.states()));
        prop_assert_eq!(played.outcomes(), stepped.outcomes());
        prop_assert_eq!(played.scores(), stepped.scores());
        prop_assert_eq!(state.state_hash(), before);
    }
}
