//! Tests of novelty. Irrelevant changes leave a game's form unchanged, and relevant changes alter it. The
//! duplicate threshold lies between the distances of renumbered copies and those of different games
//! (docs/explanation/novelty.md).

use base::Seed;
use engine::Game;
use generators::games::{Kind, Masked, Rethemed};
use generators::kernels::KernelGenome;
use std::path::Path;
use tests::any_game::any_game;
use tests::choices::{Choices, random_bytes};
use tests::isomorphic;
use tests::{games, public_games, workspace_root};
use validators::novelty::{GameForm, NEAR, distance};

/// Returns the corpus games and the public games that load strictly.
fn all() -> Vec<(String, Game)> {
    let strictly = |(name, game): (String, Game)| Some((name, Game::compile(game.description()).ok()?));
    as_reference().into_iter().filter_map(strictly).collect()
}

/// Returns the games from [`all`], plus the public games that load only as in the reference.
fn as_reference() -> Vec<(String, Game)> {
    let of = |folder: &Path| games(folder).into_iter().map(|(name, game, _)| (name, game));
    let mut all: Vec<(String, Game)> = of(&workspace_root().join("corpora")).collect();
    all.extend(public_games().iter().flat_map(|folder| of(folder)));
    all
}

fn forms(all: &[(String, Game)]) -> Vec<(&str, GameForm)> {
    all.iter().map(|(name, game)| (name.as_str(), GameForm::of(game))).collect()
}

#[test]
fn isomorphic_games_have_equal_forms() {
    for (name, game) in all() {
        let form = GameForm::of(&game);
        for number in 0..8 {
            let mut sampler = Seed::from_text(&name).child("dress", number).sampler();
            let rethemed = isomorphic::rethemed(game.description(), &mut sampler);
            let other = Game::compile(&rethemed).unwrap_or_else(|problems| panic!("{name}: {problems}"));
            let other = GameForm::of(&other);
            assert_eq!(distance(&form, &other), 0.0, "{name} {number}");
            let text = engine::syntax::print(&rethemed);
            assert_eq!(form.digest(), other.digest(), "{name} {number}\n{text}");
        }
    }
}

/// Tests generated games with every class, effect and parameter.
#[test]
fn generated_isomorphic_games_have_equal_forms() {
    let mut sampler = Seed::from_text("invented").sampler();
    let mut tried = 0;
    for number in 0..300 {
        let generated = any_game(&mut Choices::new(&random_bytes(&mut sampler, 400)));
        let Ok(game) = Game::from_source(&generated.source) else { continue };
        let form = GameForm::of(&game);
        let rethemed = isomorphic::rethemed(game.description(), &mut sampler);
        let Ok(other) = Game::compile(&rethemed) else { continue };
        let other = GameForm::of(&other);
        let text = engine::syntax::print(&rethemed);
        assert_eq!(form.digest(), other.digest(), "{number}\n{}\n{text}", generated.source);
        assert_eq!(distance(&form, &other), 0.0, "{number}");
        tried += 1;
    }
    assert!(tried > 100, "{tried}");
}

/// Twins keep the names that the engine knows, and choose different characters. The default characters must
/// not place a type that the original game never places.
#[test]
fn twins_are_the_same_game() {
    let generated = (0..20).map(|number| {
        let seed = Seed::from_text("twins").child("game", number);
        let made = KernelGenome::draw(Kind::ALL, seed).unwrap().build().unwrap().game;
        (made.title, made.rules)
    });
    for (name, game) in all().into_iter().chain(generated) {
        let form = GameForm::of(&game);
        for number in 0..8 {
            let seed = Seed::from_text(&name).child("twin", number);
            let masked = Masked::of(game.description(), seed).description().clone();
            let rethemed = Rethemed::of(&game, seed).ok().map(|rethemed| rethemed.description);
            for twin in [masked].into_iter().chain(rethemed) {
                let text = engine::syntax::print(&twin);
                let twin =
                    Game::compile(&twin).unwrap_or_else(|problems| panic!("{name}: {problems}\n{text}"));
                assert_eq!(form.digest(), GameForm::of(&twin).digest(), "{name} {number}\n{text}");
            }
        }
    }
}

#[test]
fn another_rule_is_another_game() {
    let mut tried = 0;
    for (name, game) in all() {
        let form = GameForm::of(&game);
        for number in 0..20 {
            let mut sampler = Seed::from_text(&name).child("alter", number).sampler();
            let Some(altered) = isomorphic::altered(game.description(), &mut sampler) else { continue };
            let Ok(other) = Game::compile(&altered) else { continue };
            // A random change may restore the original.
            if other.clauses() == game.clauses() {
                continue;
            }
            let other = GameForm::of(&other);
            let text = engine::syntax::print(&altered);
            assert_ne!(form.digest(), other.digest(), "{name} {number}\n{text}");
            let apart = distance(&form, &other);
            assert!(apart > 0.0 && apart <= 1.0, "{name} {number} {apart}");
            tried += 1;
        }
    }
    assert!(tried > 100, "{tried}");
}

#[test]
fn distance_is_symmetric_and_zero_for_equal_forms_only() {
    let all = as_reference();
    let forms = forms(&all);
    for (at, (name, form)) in forms.iter().enumerate() {
        assert_eq!(distance(form, form), 0.0, "{name}");
        for (other_name, other) in &forms[..at] {
            let apart = distance(form, other);
            assert_eq!(apart.to_bits(), distance(other, form).to_bits(), "{name} {other_name}");
            assert_eq!(apart == 0.0, form.digest() == other.digest(), "{name} {other_name} {apart}");
        }
    }
}

#[test]
fn other_numbers_are_duplicates() {
    let mut tried = 0;
    for (name, game) in all() {
        let copy = isomorphic::renumbered(game.description()).and_then(|tree| Game::compile(&tree).ok());
        let Some(copy) = copy else { continue };
        let (form, copy) = (GameForm::of(&game), GameForm::of(&copy));
        assert!(form.digest() != copy.digest() && form.is_near(&copy), "{name} {}", distance(&form, &copy));
        tried += 1;
    }
    assert!(tried > 15, "{tried}");
}

#[test]
fn hand_written_games_are_not_duplicates() {
    let all = all();
    let forms = forms(&all);
    let near = |one: usize| (0..one).filter(|&two| forms[one].1.is_near(&forms[two].1)).count();
    let pairs: usize = (0..forms.len()).map(near).sum();
    // Some public games are copies of others by any measure.
    assert!(pairs <= forms.len() / 10, "{pairs}");
    let corpus = games(&workspace_root().join("corpora")).len();
    assert!((0..corpus).all(|at| near(at) == 0));
}

#[test]
fn common_frames_do_not_make_games_similar() {
    let game = |sprites: &str, rules: &str, wins: &str| {
        let frame = "avatar wall > stepBack\n    avatar EOS > stepBack\n    thing wall > stepBack\n    thing EOS > stepBack";
        let source = format!(
            "BasicGame\n  SpriteSet\n    wall > Immovable\n    {sprites}\n    avatar > MovingAvatar\n  LevelMapping\n    t > thing\n  InteractionSet\n    {frame}\n    {rules}\n  TerminationSet\n    {wins}\n    SpriteCounter stype=avatar win=False\n"
        );
        GameForm::of(&Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}")))
    };
    let hunt = game(
        "thing > Fleeing stype=avatar",
        "thing avatar > killSprite scoreChange=1",
        "SpriteCounter stype=thing win=True",
    );
    let flight =
        game("thing > Chaser stype=avatar", "avatar thing > killSprite", "Timeout limit=300 win=True");
    assert!(distance(&hunt, &flight) > 2.0 * NEAR, "{}", distance(&hunt, &flight));
}
