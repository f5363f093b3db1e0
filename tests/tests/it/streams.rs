//! Streams of verified levels.

use base::{Seed, SeedPath};
use engine::{Analysis, Game, Outcome};
use generators::levels::LevelSimilarity;
use infinite_arcade_forge::stream::{NAMESPACE, Stream, StreamConfig, StreamError, StreamGame};
use infinite_arcade_statistics::Summary;
use proptest::prelude::*;
use std::collections::BTreeSet;
use tests::sweep::cases;
use tests::{rust_files, workspace_root};
use validators::{Case, Criteria};

/// A game that nobody wins: the goal of a level is far away, and the time limit is three ticks.
const HOPELESS: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n  InteractionSet\n    avatar wall > stepBack\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    Timeout limit=3 win=False\n";

fn corpus(names: &[&str]) -> Vec<StreamGame> {
    let games = tests::games(&workspace_root().join("corpora")).into_iter();
    let games = games.map(|(name, game, levels)| StreamGame { name, game, levels });
    games.filter(|game| names.contains(&game.name.as_str())).collect()
}

fn hopeless() -> StreamGame {
    let game = Game::from_source(HOPELESS).expect("the game compiles");
    StreamGame { name: "hopeless".to_owned(), game, levels: Vec::new() }
}

fn stream(games: Vec<StreamGame>, config: StreamConfig) -> Stream {
    Stream::new(games, config, Seed::from_text("streams")).expect("the games are suitable")
}

const GAMES: [&str; 3] = ["foxglove-round", "hailglass", "quiet-jars"];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(40) as u32))]

    #[test]
    fn an_item_depends_only_on_its_index(positions in prop::collection::vec(any::<u64>(), 3)) {
        let games = corpus(&GAMES);
        let reversed = games.iter().rev().cloned().collect();
        let [one, other] = [games.clone(), reversed].map(|games| stream(games, StreamConfig::default()));
        let made: Vec<_> = positions.iter().map(|&index| one.item(index, &()).unwrap()).collect();
        for (&index, item) in positions.iter().zip(&made).rev() {
            prop_assert_eq!(&other.item(index, &()).unwrap(), item);
            let StreamGame { game, levels, .. } = games.iter().find(|game| game.name == item.game).unwrap();
            let state = item.witness.replay(game, &item.level).unwrap();
            prop_assert_eq!(state.outcome(), Outcome::Won);
            prop_assert_eq!(item.letters().len(), item.witness.actions.len());
            let similarity = LevelSimilarity::of(&Analysis::of(game));
            let known: BTreeSet<_> = levels.iter().map(|level| similarity.digest(level)).collect();
            prop_assert!(!known.contains(&similarity.digest(&item.level)));
            let path = SeedPath::new(Seed::from_text("streams"), item.path.steps().to_vec());
            prop_assert_eq!(path.seed(), item.path.seed());
            prop_assert_eq!(&path.steps()[..2], [(NAMESPACE.to_owned(), 0), ("item".to_owned(), index)]);
        }
    }
}

#[test]
fn no_release_derives_a_seed_in_the_namespace() {
    let step = format!("child({NAMESPACE:?}");
    let users: Vec<_> = rust_files().into_iter().filter(|(_, text)| text.contains(&step)).collect();
    assert!(users.is_empty(), "{:?}", users.iter().map(|(file, _)| file).collect::<Vec<_>>());
}

#[test]
fn avoided_levels_are_not_drawn() {
    let games = corpus(&["hailglass"]);
    let (game, config) = (games[0].game.clone(), StreamConfig::default());
    let first = stream(games.clone(), config.clone()).item(0, &()).unwrap();
    let mut other = stream(games, config);
    other.avoid(&game, std::slice::from_ref(&first.level));
    let second = other.item(0, &()).unwrap();
    assert_ne!((&first.level, first.path.steps()), (&second.level, second.path.steps()));
}

/// Compares the win rates of players that do not rank the levels.
#[test]
fn difficult_items_are_won_less_often() {
    let count = cases(80) as u64;
    let ladder = ["random", "mcts:100"].map(str::to_owned).to_vec();
    let players = Criteria { ladder, ladder_plays: 4, held_out: Vec::new(), ..Criteria::default() };
    let players = players.check().unwrap().players();
    for name in ["foxglove-round", "hailglass"] {
        let games = corpus(&[name]);
        let game = games[0].game.clone();
        let analysis = Analysis::of(&game);
        let win_rate = |difficulty: f64| {
            let config = StreamConfig { difficulty: Some(difficulty), ..StreamConfig::default() };
            let stream = stream(games.clone(), config);
            let rates = (0..count).map(|index| {
                let item = stream.item(index, &()).unwrap();
                let (seed, witness) = (item.path.child("test", 0), Some(&item.witness));
                let case =
                    Case { game: &game, level: &item.level, seed: &seed, analysis: &analysis, witness };
                players.ladder(case).rungs[1].rate.wins as f64 / 4.0
            });
            Summary::of(&rates.collect::<Vec<_>>()).unwrap().mean
        };
        let measured = [0.0, 0.5, 1.0].map(win_rate);
        assert!(measured[0] > measured[1] && measured[1] > measured[2], "{name}: {measured:?}");
    }
}

#[test]
fn a_game_that_is_never_won_is_replaced_or_reported() {
    let config = StreamConfig { attempts: 2, calls: 10_000, ..StreamConfig::default() };
    let error = stream(vec![hopeless()], config.clone()).item(3, &()).unwrap_err();
    assert!(matches!(error, StreamError::NoneAccepted { index: 3, drawn: 2, .. }), "{error}");
    assert!(error.to_string().contains("item 3 has no level"), "{error}");
    let games = [corpus(&["hailglass"]), vec![hopeless()]].concat();
    let both = stream(games, StreamConfig { attempts: 4, ..StreamConfig::default() });
    let first_or_second = |index| {
        let item = both.item(index, &()).unwrap();
        assert_eq!(item.game, "hailglass");
        item.path.steps()[2].clone()
    };
    let paths: BTreeSet<_> = (0..8).map(first_or_second).collect();
    assert_eq!(paths.len(), 2, "both games were drawn first: {paths:?}");
}

#[test]
fn unsuitable_games_are_named() {
    let refused = |games, config| match Stream::new(games, config, Seed::from_text("streams")) {
        Ok(_) => panic!("the stream was made"),
        Err(error) => error.to_string(),
    };
    assert_eq!(refused(Vec::new(), StreamConfig::default()), "a stream needs at least one game");
    let twice = [hopeless(), StreamGame { name: "again".to_owned(), ..hopeless() }].to_vec();
    assert!(refused(twice, StreamConfig::default()).contains("have the same rules: omit one"));
    let small = StreamConfig { size: Some((2, 2)), ..StreamConfig::default() };
    assert!(
        refused(vec![hopeless()], small).starts_with("hopeless: no level can be made for this game: columns")
    );
}
