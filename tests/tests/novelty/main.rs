//! Novelty of games: what does not count leaves the form of a game alone, what counts changes it, and the duplicate distance
//! lies between copies with other numbers and other games (docs/novelty.md).

mod dress;

use engine::{Game, Seed};
use std::io::Write;
use std::path::Path;
use tests::any_game::any_game;
use tests::choices::{Choices, random_bytes};
use tests::{games, public_games, workspace_root};
use validators::novelty::{GameForm, NEAR, distance};

/// The corpus, and the public games that load strictly.
fn all() -> Vec<(String, Game)> {
    let strictly = |(name, game): (String, Game)| Some((name, Game::compile(game.description()).ok()?));
    as_reference().into_iter().filter_map(strictly).collect()
}

/// The same, and those that only the reference loads.
fn as_reference() -> Vec<(String, Game)> {
    let of = |folder: &Path| games(folder).into_iter().map(|(name, game, _)| (name, game));
    let mut all: Vec<(String, Game)> = of(&workspace_root().join("corpora")).collect();
    all.extend(public_games().iter().flat_map(|folder| of(folder)));
    all
}

fn forms(all: &[(String, Game)]) -> Vec<(&str, GameForm)> {
    all.iter().map(|(name, game)| (name.as_str(), GameForm::of(game))).collect()
}

fn told(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

#[test]
fn another_dress_is_the_same_game() {
    for (name, game) in all() {
        let form = GameForm::of(&game);
        for number in 0..8 {
            let mut sampler = Seed::from_text(&name).child("dress", number).sampler();
            let dressed = dress::dressed(game.description(), &mut sampler);
            let other = Game::compile(&dressed).unwrap_or_else(|problems| panic!("{name}: {problems}"));
            let other = GameForm::of(&other);
            assert_eq!(distance(&form, &other), 0.0, "{name} {number}");
            let text = engine::syntax::print(&dressed);
            assert_eq!(form.digest(), other.digest(), "{name} {number}\n{text}");
        }
    }
}

/// Games that nobody wrote, of every class, effect and parameter.
#[test]
fn another_dress_of_an_invented_game_is_the_same_game() {
    let mut sampler = Seed::from_text("invented").sampler();
    let mut tried = 0;
    for number in 0..300 {
        let invented = any_game(&mut Choices::new(&random_bytes(&mut sampler, 400)));
        let Ok(game) = Game::from_source(&invented.source) else { continue };
        let form = GameForm::of(&game);
        let dressed = dress::dressed(game.description(), &mut sampler);
        let Ok(other) = Game::compile(&dressed) else { continue };
        let other = GameForm::of(&other);
        let text = engine::syntax::print(&dressed);
        assert_eq!(form.digest(), other.digest(), "{number}\n{}\n{text}", invented.source);
        assert_eq!(distance(&form, &other), 0.0, "{number}");
        tried += 1;
    }
    assert!(tried > 100, "{tried}");
}

#[test]
fn another_rule_is_another_game() {
    let mut tried = 0;
    for (name, game) in all() {
        let form = GameForm::of(&game);
        for number in 0..20 {
            let mut sampler = Seed::from_text(&name).child("alter", number).sampler();
            let Some(altered) = dress::altered(game.description(), &mut sampler) else { continue };
            let Ok(other) = Game::compile(&altered) else { continue };
            // Lots may fall on what is there already.
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
fn other_numbers_make_a_duplicate() {
    let mut tried = 0;
    for (name, game) in all() {
        let copy = dress::renumbered(game.description()).and_then(|tree| Game::compile(&tree).ok());
        let Some(copy) = copy else { continue };
        let (form, copy) = (GameForm::of(&game), GameForm::of(&copy));
        assert!(form.digest() != copy.digest() && form.is_near(&copy), "{name} {}", distance(&form, &copy));
        tried += 1;
    }
    assert!(tried > 15, "{tried}");
}

#[test]
fn games_that_people_wrote_are_no_duplicates() {
    let all = all();
    let forms = forms(&all);
    let near = |one: usize| (0..one).filter(|&two| forms[one].1.is_near(&forms[two].1)).count();
    let pairs: usize = (0..forms.len()).map(near).sum();
    // Among the public games there are copies, by whatever measure.
    assert!(pairs <= forms.len() / 10, "{pairs}");
    let corpus = games(&workspace_root().join("corpora")).len();
    assert!((0..corpus).all(|at| near(at) == 0));
}

#[test]
fn a_common_frame_makes_no_neighbours() {
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

/// What docs/novelty.md shows: `cargo test -p infinite-arcade-tests --test novelty -- --ignored --nocapture`.
#[test]
#[ignore = "prints the tables of docs/novelty.md"]
fn tables() {
    let all = all();
    let forms = forms(&all);
    let corpus = games(&workspace_root().join("corpora")).len();
    let mut pairs = Vec::new();
    for one in 0..forms.len() {
        pairs.extend((0..one).map(|two| (distance(&forms[one].1, &forms[two].1), two, one)));
    }
    told(
        "| game | nearest in the corpus | distance | nearest public game | distance |\n|---|---|---|---|---|",
    );
    for (at, (name, form)) in forms[..corpus].iter().enumerate() {
        let nearest = |from: usize, to: usize| {
            let others: Vec<usize> = (from..to).filter(|&other| other != at).collect();
            let found = form.nearest(others.iter().map(|&other| &forms[other].1));
            found.map_or("- | -".to_owned(), |(place, apart)| {
                format!("{} | {apart:.2}", forms[others[place]].0)
            })
        };
        told(&format!("| {name} | {} | {} |", nearest(0, corpus), nearest(corpus, forms.len())));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    told("\nnearest pairs:");
    for (apart, one, two) in &pairs[..24] {
        told(&format!("{} {} {apart:.3}", forms[*one].0, forms[*two].0));
    }
    told("\nrelatives:");
    let relatives = [
        ("racebet", "racebet2"),
        ("sokoban", "wrapsokoban"),
        ("sokoban", "realsokoban"),
        ("realsokoban", "wrapsokoban"),
        ("lasers", "lasers2"),
        ("portals", "realportals"),
        ("pacman", "pacoban"),
        ("boulderdash", "boulderchase"),
        ("labyrinth", "labyrinthdual"),
        ("sokoban", "modality"),
    ];
    for (one, two) in relatives {
        let find = |name: &str| forms.iter().find(|form| form.0 == name).map(|form| &form.1);
        if let (Some(a), Some(b)) = (find(one), find(two)) {
            told(&format!("{one} {two} {:.3}", distance(a, b)));
        }
    }
    let apart = |within: &dyn Fn(usize) -> bool| {
        pairs
            .iter()
            .filter(|(_, one, two)| within(*one) && within(*two))
            .map(|pair| pair.0)
            .collect::<Vec<f64>>()
    };
    let mut lists = vec![
        ("pairs of the corpus", apart(&|at| at < corpus)),
        ("pairs of public games", apart(&|at| at >= corpus)),
    ];
    let mut copies = Vec::new();
    let mut edited = [Vec::new(), Vec::new(), Vec::new()];
    for ((name, game), (_, form)) in all.iter().zip(&forms) {
        let copy = dress::renumbered(game.description()).and_then(|tree| Game::compile(&tree).ok());
        copies.extend(copy.map(|copy| distance(form, &GameForm::of(&copy))));
        for number in 0..10 {
            let mut tree = game.description().clone();
            for edit in 1..=5 {
                let edits = Seed::from_text(name).child("edits", number).child("edit", edit);
                let changed = (0..30).find_map(|lot| {
                    let mut sampler = edits.child("lot", lot).sampler();
                    dress::altered(&tree, &mut sampler)
                        .filter(|other| *other != tree && Game::compile(other).is_ok())
                });
                tree = changed.unwrap_or(tree);
                if edit % 2 == 1 {
                    let other = Game::compile(&tree).expect("only what compiles is kept");
                    edited[edit as usize / 2].push(distance(form, &GameForm::of(&other)));
                }
            }
        }
    }
    lists.push(("a game and its copy with other numbers", copies));
    let [one, three, five] = edited;
    lists.extend([("1 rule altered", one), ("3 rules altered", three), ("5 rules altered", five)]);
    told(
        "\n| | n | least | 5 % | 25 % | median | 75 % | 95 % | most |\n|---|---|---|---|---|---|---|---|---|",
    );
    for (name, mut list) in lists {
        list.sort_by(f64::total_cmp);
        let at = |percent: usize| format!("{:.2}", list[(list.len() - 1) * percent / 100]);
        let shown = [0, 5, 25, 50, 75, 95, 100].map(at).join(" | ");
        told(&format!("| {name} | {} | {shown} |", list.len()));
    }
}
