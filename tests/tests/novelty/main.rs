//! Novelty of games: what does not count leaves the form of a game alone, what counts changes it, and the duplicate distance
//! lies between copies with other numbers and other games (docs/novelty.md).

mod dress;

use engine::{Game, Seed};
use std::io::Write;
use std::path::Path;
use tests::{games, public_games, workspace_root};
use validators::novelty::{GameForm, NEAR, distance};

/// The corpus, and the public games that load strictly.
fn all() -> Vec<(String, Game)> {
    let of = |folder: &Path| games(folder).into_iter().map(|(name, game, _)| (name, game));
    let mut all: Vec<(String, Game)> = of(&workspace_root().join("corpora")).collect();
    all.extend(public_games().iter().flat_map(|folder| of(folder)));
    all.retain(|(_, game)| Game::compile(game.description()).is_ok());
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
        let form = GameForm::of(&Game::compile(game.description()).unwrap());
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
    let all = all();
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
fn calibration() {
    let all = all();
    let mut lists: Vec<(&str, Vec<f64>)> = Vec::new();
    let mut renumbered = Vec::new();
    let mut altered = [Vec::new(), Vec::new(), Vec::new()];
    for (name, game) in &all {
        let form = GameForm::of(game);
        if let Some(other) = dress::renumbered(game.description()).and_then(|tree| Game::compile(&tree).ok())
        {
            let d = distance(&form, &GameForm::of(&other));
            renumbered.push(d);
        } else {
            told(&format!("not renumbered: {name}"));
        }
        for number in 0..10 {
            let mut tree = game.description().clone();
            for edit in 0..5 {
                for n in 0..30 {
                    let mut sampler =
                        Seed::from_text(name).child("edits", number).child("edit", edit * 100 + n).sampler();
                    if let Some(other) =
                        dress::altered(&tree, &mut sampler).filter(|o| o != &tree && Game::compile(o).is_ok())
                    {
                        tree = other;
                        break;
                    }
                }
                if [0, 2, 4].contains(&edit) {
                    altered[edit as usize / 2]
                        .push(distance(&form, &GameForm::of(&Game::compile(&tree).unwrap())));
                }
            }
        }
    }
    lists.push(("renumbered", renumbered));
    for (name, list) in ["1 edit", "3 edits", "5 edits"].into_iter().zip(altered) {
        lists.push((name, list));
    }
    for (name, mut list) in lists {
        list.sort_by(f64::total_cmp);
        let q = |share: f64| list[((list.len() - 1) as f64 * share) as usize];
        told(&format!(
            "{name} n={} min {:.3} q5 {:.3} q25 {:.3} q50 {:.3} q75 {:.3} q95 {:.3} max {:.3}",
            list.len(),
            q(0.0),
            q(0.05),
            q(0.25),
            q(0.5),
            q(0.75),
            q(0.95),
            q(1.0)
        ));
    }
    told(&format!("{} games {NEAR}", all.len()));
}
