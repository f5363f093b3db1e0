//! Properties of the editor functions on every corpus game, and on texts with random damage.

use base::{Sampler, Seed};
use engine::Game;
use engine::syntax::{parse, print_bare};
use infinite_arcade_editor::{
    applied, complete, definition, format, hover, level_hover, level_problems, outline, problems, references,
    renamable, rename,
};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Returns the corpus games, each with its name, text and first level.
fn corpus() -> Vec<(String, String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora");
    let mut folders: Vec<_> = fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let read = |folder: &Path, name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let game = |folder: &std::path::PathBuf| {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        (name, read(folder, "game.vgdl"), read(folder, "lvl0.txt"))
    };
    let games: Vec<_> = folders.iter().map(game).collect();
    assert!(games.len() > 20);
    games
}

/// Returns the words in a text's code, with the offsets of their first bytes.
fn words(source: &str) -> Vec<(usize, &str)> {
    let code = source
        .split_inclusive('\n')
        .flat_map(|line| line.split('#').next().unwrap_or_default().split_whitespace());
    code.map(|word| (word.as_ptr() as usize - source.as_ptr() as usize, word)).collect()
}

#[test]
fn corpus_games_have_no_problems_and_are_canonical() {
    for (name, source, level) in corpus() {
        assert_eq!(problems(&source), [], "{name}");
        assert_eq!(level_problems(&source, &level), [], "{name}");
        let printed = format(&source).unwrap();
        assert_eq!(format(&printed).as_ref(), Ok(&printed), "{name}");
    }
}

/// Renaming a type changes it where the engine recognises it, and nowhere else.
#[test]
fn renaming_agrees_with_the_engine() {
    for (name, source, _) in corpus() {
        let game = Game::from_source(&source).unwrap();
        for (_, line) in game.description().sprite_lines() {
            let old = line.name.text.as_str();
            let Ok(edits) = rename(&source, line.name.span.start, "quagga") else {
                assert!(["wall", "avatar"].contains(&old), "{name}: {old}");
                continue;
            };
            let text = applied(&source, &edits);
            let names = BTreeMap::from([(old.to_owned(), "quagga".to_owned())]);
            let expect = print_bare(&game.description().renamed(&names));
            assert_eq!(print_bare(&parse(&text).0), expect, "{name}: {old}");
            assert_eq!(references(&source, line.name.span.start).len(), edits.len());
            let back = rename(&text, text.find("quagga").unwrap(), old).unwrap();
            assert_eq!(applied(&text, &back), source, "{name}: {old}");
        }
    }
}

/// The words of a valid game are among the completions at their positions, and every word except an arrow has
/// an explanation. Tests a third of the games, or all games in a sweep (`cargo xtask sweep`).
#[test]
fn every_word_of_the_corpus_is_offered_and_explained() {
    let step = if std::env::var_os("ARCADE_SWEEP").is_some() { 1 } else { 3 };
    for (name, source, level) in corpus().into_iter().step_by(step) {
        let mut in_mapping = false;
        let mut seen = BTreeSet::new();
        for (at, word) in words(&source) {
            if word.ends_with("Set") || word == "LevelMapping" {
                in_mapping = word == "LevelMapping";
            }
            if !seen.insert((in_mapping, word)) {
                continue;
            }
            assert_eq!(hover(&source, at).is_some(), word != ">", "{name}: {word}");
            let before = source[..at].trim_end_matches(' ');
            let first = before.ends_with('\n') || at == 0;
            let key = word.split_once('=').map(|(key, _)| key);
            let open =
                word == ">" || first && (in_mapping || word.chars().next().is_some_and(char::is_lowercase));
            let declares = first && source[at..].lines().next().unwrap().contains(" > ");
            if open || declares {
                continue;
            }
            let items = complete(&source, at).items;
            let label = key.unwrap_or(word);
            assert!(items.iter().any(|item| item.label == label), "{name}: {word} at {at}");
        }
        let mut symbols = BTreeSet::new();
        for (at, symbol) in level.char_indices().filter(|&(_, symbol)| symbols.insert(symbol)) {
            let is_mapped = !symbol.is_whitespace() && source.contains(&format!(" {symbol} > "));
            assert_eq!(level_hover(&source, &level, at).is_some(), is_mapped, "{name}: {symbol}");
        }
    }
}

/// Damaged texts get answers too, and every span in an answer is a valid slice of the text.
#[test]
fn damaged_texts_have_answers() {
    let games = corpus();
    let pieces = [
        "\n",
        " ",
        "=",
        ">",
        ",",
        "#",
        "//",
        "é",
        "😀",
        "\u{feff}",
        "\r",
        "\t",
        "SpriteSet",
        "stype=",
        "EOS",
        "\0",
    ];
    for draw in 0..100 {
        let mut sampler: Sampler = Seed::from_text("damaged texts").child("text", draw).sampler();
        let (_, source, level) = sampler.choose(&games).clone();
        let mut text: Vec<char> = source.chars().collect();
        for _ in 0..=sampler.below(8) {
            let at = sampler.below(text.len());
            let length = sampler.below(12).min(text.len() - at);
            let piece = *sampler.choose(&pieces);
            text.splice(at..at + length, piece.chars());
        }
        let text: String = text.into_iter().collect();
        let cuts = |span: infinite_arcade_editor::Span| text.get(span.start..span.end).is_some();
        for problem in problems(&text) {
            assert!(cuts(problem.span), "{problem:?}\n{text}");
            for fix in problem.fixes {
                assert!(fix.edits.iter().all(|edit| cuts(edit.span)), "{fix:?}\n{text}");
                applied(&text, &fix.edits);
            }
        }
        level_problems(&text, &level);
        outline(&text);
        if let Ok(printed) = format(&text) {
            assert_eq!(format(&printed).as_ref(), Ok(&printed), "{text}");
        }
        for _ in 0..6 {
            let at = sampler.below(text.len() + 2);
            assert!(hover(&text, at).is_none_or(|hover| cuts(hover.span)));
            assert!(cuts(complete(&text, at).span));
            assert!(definition(&text, at).is_none_or(cuts));
            assert!(references(&text, at).into_iter().all(cuts));
            let renamed = renamable(&text, at).is_ok().then(|| rename(&text, at, "quagga"));
            if let Some(Ok(edits)) = renamed {
                assert!(edits.iter().all(|edit| cuts(edit.span)));
            }
            level_hover(&text, &level, at);
        }
    }
}

/// Texts with as much inheritance, as many placements and as many names as their length allows still get
/// answers.
#[test]
fn texts_at_the_limit_have_answers() {
    let params: String = (0..250).map(|number| format!(" k{number}=1")).collect();
    let children: String = (0..11_000).map(|number| format!("   c{number}>\n")).collect();
    let family = format!("BasicGame\n SpriteSet\n  a > Missile{params}\n{children}");
    let types: String = (0..500).map(|number| format!("  t{number} > Missile\n")).collect();
    let names: String = (0..300).map(|number| format!(" t{number}")).collect();
    let crowd = format!(
        "BasicGame\n SpriteSet\n{types}  A > MovingAvatar\n LevelMapping\n  x >{names}\n  A > A\n InteractionSet\n TerminationSet\n  Timeout limit=9\n"
    );
    for (text, place) in [(&family, "a > M"), (&family, "c10999"), (&crowd, "x > t0"), (&crowd, "t299")] {
        let at = text.find(place).unwrap();
        assert!(hover(text, at).is_some(), "{place}");
        assert!(!references(text, at).is_empty(), "{place}");
        assert!(rename(text, at, "Q").is_ok(), "{place}");
        assert_eq!(outline(text).len(), text.matches("Set\n").count() + text.matches("Mapping\n").count());
        assert!(complete(text, text.find("> M").unwrap() + 2).items.len() > 40);
        problems(text);
    }
}
