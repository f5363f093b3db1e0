//! Tests that masked games play like the original games.

use super::{corpus, generated, play_alike};
use base::Seed;
use engine::{Description, Game, syntax};
use generators::games::Masked;

fn seed() -> Seed {
    Seed::from_text("masks")
}

/// Checks that the masked copy has the same hashes and outcomes for the same actions.
fn plays_alike(name: &str, source: &Description, levels: &[String]) {
    let masked = Masked::of(source, seed().child(name, 0));
    assert_eq!(masked, Masked::of(source, seed().child(name, 0)));
    let game = Game::compile(source).unwrap();
    let text = syntax::print(masked.description());
    let twin = Game::from_source(&text).unwrap_or_else(|problems| panic!("{name}: {problems}\n{text}"));
    play_alike(name, &game, &twin, levels, |level| masked.level(level));
    for (_, line) in source.sprite_lines() {
        let word = line.name.text.as_str();
        let kept = Description::RESERVED_NAMES.contains(&word)
            || text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').all(|w| w != word);
        assert!(kept || word.len() < 3, "{name}: {word} is told\n{text}");
    }
    assert!(!text.contains('#') && !text.contains("img="), "{name}\n{text}");
}

#[test]
fn masked_games_play_alike() {
    for (name, source, levels) in corpus() {
        plays_alike(&name, &syntax::parse(&source).0, &levels);
    }
}

#[test]
fn masked_generated_games_play_alike() {
    for (name, source, levels) in generated() {
        plays_alike(&name, &source, &levels);
    }
}
