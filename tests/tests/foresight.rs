//! Sprites that a step passes over, because it is foreseen what they do, are where they would be had it not.

use engine::{Action, Game, Level, Limit, Outcome, Seed, State};
use proptest::prelude::*;
use std::path::Path;
use tests::any_game::any_game;
use tests::choices::Choices;
use tests::{games, public_games, workspace_root};

/// Plays random actions twice, with foresight and without; the two must not differ in anything.
fn play(name: &str, game: &Game, level: &Level, ticks: usize) {
    let mut sampler = Seed::from_text(name).child("actions", 0).sampler();
    play_actions(name, game, level, (0..ticks).map(|_| *sampler.choose(&Action::ALL)));
}

/// Plays actions twice. Returns the last state.
fn play_actions(name: &str, game: &Game, level: &Level, actions: impl Iterator<Item = Action>) -> State {
    let mut state = game.start(level, Seed::from_text(name).child("chance", 0));
    let mut plain = state.clone();
    for action in actions {
        if state.is_over() {
            break;
        }
        let outcomes = (game.step(&mut state, action), game.step_plainly(&mut plain, action, &mut ()));
        if [outcomes.0, outcomes.1].contains(&Outcome::Stopped(Limit::Work)) {
            // What rests is no work, and waking it is.
            return state;
        }
        assert_eq!(outcomes.0, outcomes.1, "{name}");
        if state.state_hash() != plain.state_hash() {
            panic!("{name}, tick {}: {}", state.tick(), difference(game, &state, &plain));
        }
    }
    let written = |state: &State| format!("{:?} {:?}", game.records(state), state.search_key(game));
    assert_eq!(written(&state), written(&plain), "{name}");
    state.recount(game).unwrap_or_else(|found| panic!("{name}: {found}"));
    state
}

/// The first sprites that differ.
fn difference(game: &Game, one: &State, two: &State) -> String {
    let (ones, twos) = (game.records(one), game.records(two));
    let pairs = ones.iter().zip(&twos).find(|(one, two)| format!("{one:?}") != format!("{two:?}"));
    format!("{} and {} sprites, {pairs:#?}", ones.len(), twos.len())
}

fn play_all(folder: &Path, ticks: usize) {
    for (name, game, levels) in games(folder) {
        for (number, level) in levels.iter().enumerate() {
            play(&format!("{name} {number}"), &game, level, ticks);
        }
    }
}

#[test]
fn foresight_changes_nothing_in_the_corpus() {
    play_all(&workspace_root().join("corpora"), 500);
}

#[test]
fn foresight_changes_nothing_in_public_games() {
    let Some(folder) = public_games() else { return };
    play_all(&folder, 400);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn foresight_changes_nothing_in_any_game(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let any = any_game(&mut Choices::new(&bytes));
        if let Ok(game) = Game::from_source_as_reference(&any.source)
            && let Ok(level) = game.level(&any.level)
        {
            play(&format!("{}\n{}\n", any.source, any.level), &game, &level, 60);
        }
    }
}

/// What spreads into its own kind stops the tick in the middle of the updates: what flies and is yet to be updated is where
/// it was.
#[test]
fn a_stop_in_the_middle_of_the_updates_finds_all_where_they_are() {
    let source = "\
BasicGame
    SpriteSet
        dart > Missile orientation=RIGHT speed=0.1
        oven > SpawnPoint stype=fire cooldown=9
        fire > Spreader spreadprob=1
        kite > Missile orientation=LEFT speed=0.1
        avatar > MovingAvatar
    LevelMapping
        d > dart
        o > oven
        k > kite
        A > avatar
    InteractionSet
        avatar kite > killSprite
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("d  o  k\nA      \n").expect("it loads");
    let state = play_actions("stop", &game, &level, [Action::Nil; 5].into_iter());
    assert_eq!((state.outcome(), state.tick()), (Outcome::Stopped(Limit::SpawnIntoUpdatedType), 2));
}

/// The avatar's own update stops the tick: then nobody else is updated, whoever of them flies.
#[test]
fn a_stop_by_the_avatar_ends_the_updates() {
    let source = "\
BasicGame
    SpriteSet
        stray > RandomNPC
        dart > Missile orientation=LEFT speed=0.1
        avatar > BirdAvatar orientedImg=bird
    LevelMapping
        s > stray
        d > dart
        A > avatar
    InteractionSet
        avatar dart > killSprite
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";
    let game = Game::from_source_as_reference(source).expect("it loads");
    let level = game.level("s    d\nA     \n      \n").expect("it loads");
    let actions = [Action::Nil, Action::Nil, Action::Left, Action::Use, Action::Use, Action::Use];
    let state = play_actions("stop", &game, &level, actions.into_iter());
    assert_eq!((state.outcome(), state.tick()), (Outcome::Stopped(Limit::UnfitSprite), 4));
}
