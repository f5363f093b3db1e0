//! Tests that every loadable game can be drawn: the hostile games and the corpus, in every format.

use base::Seed;
use engine::{Action, Analysis, Game, Level, syntax};
use generators::games::Kind;
use generators::kernels::KernelGenome;
use render::{Looks, RenderError, Style, Symbols};
use std::collections::BTreeSet;
use std::fs;
use tests::hostile::Case;
use tests::sweep::VARIABLE;
use tests::workspace_root;

/// Draws the first tick and, in a sweep, also the initial state. Images with too many pixels may be rejected.
fn draw(name: &str, game: &Game, level: &Level) {
    let analysis = Analysis::of(game);
    let looks = Looks::of(&analysis);
    let symbols = Symbols::of(&analysis, &looks);
    let mut state = game.start(level, Seed::from_text("drawn"));
    for (tick, action) in [Action::Use, Action::Down].into_iter().enumerate() {
        if tick == 0 && std::env::var_os(VARIABLE).is_none() {
            game.step(&mut state, action);
            continue;
        }
        let text = render::rows(&looks, &symbols, &state);
        let (columns, rows) = state.size();
        assert_eq!(text.lines().count(), rows as usize, "{name}");
        // Symbols are ASCII as long as there are unused characters.
        let is_symbol = |symbol: char| symbol.is_ascii_graphic() || symbol.is_alphabetic();
        let is_row = |line: &str| line.chars().count() == columns as usize && line.chars().all(is_symbol);
        assert!(text.lines().all(is_row), "{name}");
        render::text(&looks, &symbols, &state);
        match render::picture(&looks, &state, &Style { cell: 6, caption: true, legend: true }) {
            Ok(picture) => {
                assert!(render::svg(&picture).ends_with("</svg>\n"), "{name}");
                render::png(&picture).unwrap_or_else(|error| panic!("{name}: {error}"));
            }
            Err(error) => assert!(matches!(error, RenderError::TooLarge { .. }), "{name}: {error}"),
        }
        game.step(&mut state, action);
    }
}

#[test]
fn hostile_games_can_be_drawn() {
    let mut drawn = 0;
    for case in Case::all() {
        // An image does not depend on the policy under which the game was loaded.
        let game = Game::from_source(&case.source).or_else(|_| Game::from_source_as_reference(&case.source));
        let Ok(game) = game else { continue };
        let Some(Ok(level)) = case.level.as_ref().map(|text| game.level(text)) else { continue };
        draw(&case.name, &game, &level);
        drawn += 1;
    }
    assert!(drawn > 40, "{drawn}");
}

/// Checks that any two visible types differ in shape, in mark, in the number of dots, or clearly in colour.
fn assert_distinct(name: &str, looks: &Looks) {
    let shown: Vec<_> = looks.shown().collect();
    for (at, &one) in shown.iter().enumerate() {
        for &other in &shown[at + 1..] {
            let names = [one, other].map(|stype| looks.game().name(stype).to_owned());
            assert!(!looks.look(one).is_like(looks.look(other)), "{name}: {names:?} look alike");
        }
    }
}

#[test]
fn in_games_of_kernels_no_two_types_look_alike() {
    let mut kernels = BTreeSet::new();
    for seed in (0..400).map(|number| Seed::from_text("kernel looks").child("game", number)) {
        let genome = KernelGenome::draw(Kind::ALL, seed).unwrap();
        let game = genome.build().unwrap().game;
        let name = game.patterns.join(" ");
        kernels.insert(game.patterns[0].clone());
        assert!(syntax::print(game.rules.description()).contains("img=hero/"), "{name}");
        assert_distinct(&name, &Looks::of(&Analysis::of(&game.rules)));
    }
    assert!(kernels.len() >= 30, "{kernels:?}");
}

#[test]
fn in_the_corpus_every_type_has_its_own_look_and_symbol() {
    let mut folders: Vec<_> =
        fs::read_dir(workspace_root().join("corpora")).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    for folder in folders {
        let name = folder.display().to_string();
        let game = Game::from_source(&fs::read_to_string(folder.join("game.vgdl")).unwrap()).unwrap();
        let level = game.level(&fs::read_to_string(folder.join("lvl0.txt")).unwrap()).unwrap();
        draw(&name, &game, &level);
        let analysis = Analysis::of(&game);
        let looks = Looks::of(&analysis);
        let symbols = Symbols::of(&analysis, &looks);
        let shown: Vec<_> = looks.shown().collect();
        assert_distinct(&name, &looks);
        assert_distinct(&name, &Looks::of_rules(&analysis));
        let solid = shown.iter().filter(|&&stype| looks.look(stype).glyph != render::Glyph::Floor);
        let mut characters: Vec<char> = solid.clone().map(|&stype| symbols.symbol(stype)).collect();
        characters.sort_unstable();
        characters.dedup();
        assert_eq!(characters.len(), solid.count(), "{name}");
    }
}
