//! Prints the tables of `docs/explanation/novelty.md`: `cargo run -p infinite-arcade-tests --example novelty`.

extern crate infinite_arcade_base as base;
extern crate infinite_arcade_engine as engine;
extern crate infinite_arcade_validators as validators;

use base::Seed;
use engine::Game;
use std::io::Write;
use std::path::Path;
use tests::{games, isomorphic, public_games, workspace_root};
use validators::novelty::{GameForm, distance};

/// A game with its form.
struct Formed {
    name: String,
    game: Game,
    form: GameForm,
}

/// Returns the games in a folder's subfolders that load strictly.
fn formed(folder: &Path) -> Vec<Formed> {
    let strictly = games(folder).into_iter().filter_map(|(name, game, _)| {
        let game = Game::compile(game.description()).ok()?;
        let form = GameForm::of(&game);
        Some(Formed { name, game, form })
    });
    strictly.collect()
}

fn told(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}

fn main() {
    let own = formed(&workspace_root().join("corpora"));
    let public = public_games().map_or(Vec::new(), |folder| formed(&folder));
    neighbours(&own, &public);
    nearest_pairs(&public);
    let all: Vec<&Formed> = own.iter().chain(&public).collect();
    let mut lists = copies(&all);
    lists.push(("pairs of our own games", pairs(&own).into_iter().map(|pair| pair.0).collect()));
    lists.push(("pairs of public games", pairs(&public).into_iter().map(|pair| pair.0).collect()));
    distributions(lists);
}

/// Prints each corpus game with its nearest neighbours.
fn neighbours(own: &[Formed], public: &[Formed]) {
    told("| game | nearest in the corpus | distance | nearest public game | distance |");
    told("|---|---|---|---|---|");
    for game in own {
        let nearest = |others: Vec<&Formed>| {
            let found = game.form.nearest(others.iter().map(|other| &other.form));
            found.map_or("- | -".to_owned(), |(at, apart)| format!("{} | {apart:.2}", others[at].name))
        };
        let others = own.iter().filter(|other| other.name != game.name).collect();
        told(&format!("| {} | {} | {} |", game.name, nearest(others), nearest(public.iter().collect())));
    }
}

/// Returns all pairs of games with their distances, in order of increasing distance.
fn pairs(games: &[Formed]) -> Vec<(f64, &str, &str)> {
    let mut pairs = Vec::new();
    for (at, one) in games.iter().enumerate() {
        let with = |two: &Formed| distance(&one.form, &two.form);
        pairs.extend(games[..at].iter().map(|two| (with(two), two.name.as_str(), one.name.as_str())));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs
}

/// Prints the pairs of related public games, and the other pairs that are as close.
fn nearest_pairs(public: &[Formed]) {
    let relatives = [
        ("sokoban", "wrapsokoban"),
        ("realsokoban", "sokoban"),
        ("portals", "realportals"),
        ("labyrinth", "labyrinthdual"),
        ("modality", "sokoban"),
    ];
    told("\n| pair | distance |\n|---|---|");
    for (number, (apart, one, two)) in pairs(public).into_iter().enumerate() {
        if number < 20 || relatives.contains(&(one, two)) {
            told(&format!("| {one}, {two} | {apart:.2} |"));
        }
    }
}

/// Returns the distances from games to copies with different numbers, and to copies with changed rules.
fn copies(all: &[&Formed]) -> Vec<(&'static str, Vec<f64>)> {
    let mut renumbered = Vec::new();
    let mut altered = [Vec::new(), Vec::new(), Vec::new()];
    for Formed { name, game, form } in all {
        let copy = isomorphic::renumbered(game.description()).and_then(|tree| Game::compile(&tree).ok());
        renumbered.extend(copy.map(|copy| distance(form, &GameForm::of(&copy))));
        for number in 0..10 {
            let mut tree = game.description().clone();
            for edit in 1..=5 {
                let edits = Seed::from_text(name).child("edits", number).child("edit", edit);
                let changed = (0..30).find_map(|lot| {
                    let mut sampler = edits.child("lot", lot).sampler();
                    isomorphic::altered(&tree, &mut sampler)
                        .filter(|other| *other != tree && Game::compile(other).is_ok())
                });
                tree = changed.unwrap_or(tree);
                if edit % 2 == 1 {
                    let other = Game::compile(&tree).expect("only what compiles is kept");
                    altered[edit as usize / 2].push(distance(form, &GameForm::of(&other)));
                }
            }
        }
    }
    let [one, three, five] = altered;
    vec![
        ("a game and its copy with all numbers changed", renumbered),
        ("1 rule altered", one),
        ("3 rules altered", three),
        ("5 rules altered", five),
    ]
}

fn distributions(lists: Vec<(&str, Vec<f64>)>) {
    told(
        "\n| | n | least | 5 % | 25 % | median | 75 % | 95 % | most |\n|---|---|---|---|---|---|---|---|---|",
    );
    for (name, mut list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        list.sort_by(f64::total_cmp);
        let at = |percent: usize| format!("{:.2}", list[(list.len() - 1) * percent / 100]);
        let shown = [0, 5, 25, 50, 75, 95, 100].map(at).join(" | ");
        told(&format!("| {name} | {} | {shown} |", list.len()));
    }
}
