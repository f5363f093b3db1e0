//! Tests of games with other names, and of the rules of games for which levels are generated.

mod masked;
mod push;
mod rethemed;

use crate::corpora;
use base::Seed;
use engine::{Description, Game};
use generators::games::Kind;
use generators::kernels::{KernelGame, KernelGenome, Slot};

/// Returns the name, text and levels of every corpus game.
fn corpus() -> Vec<(String, String, Vec<String>)> {
    let games = corpora::own().into_iter().filter_map(|folder| {
        let source = corpora::source_in(&folder)?;
        Some((corpora::name_of(&folder), source, corpora::level_texts_in(&folder)))
    });
    let games: Vec<_> = games.collect();
    assert!(games.len() >= 20, "{} games", games.len());
    games
}

/// Returns kernel games with their titles, rules and one level each.
fn generated() -> impl Iterator<Item = (String, Description, Vec<String>)> {
    (0..40).map(|number| {
        let seed = Seed::from_text("checks").child("game", number);
        let KernelGame { game, course } = KernelGenome::draw(Kind::ALL, seed).unwrap().build().unwrap();
        let level = course.level(Slot::Exam, seed).map(|level| level.text).ok();
        (game.title, game.rules.description().clone(), level.into_iter().collect())
    })
}

/// Checks that the renamed copy has the same hashes, scores and outcomes for the same actions.
fn play_alike(name: &str, game: &Game, twin: &Game, levels: &[String], translate: impl Fn(&str) -> String) {
    for (number, level) in levels.iter().enumerate() {
        let seed = Seed::from_text(name).child("level", number as u64);
        let own = game.level(level).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        let other = twin.level(&translate(level)).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        let (mut one, mut two) = (game.start(&own, seed), twin.start(&other, seed));
        let mut sampler = seed.sampler();
        for _ in 0..150 {
            assert_eq!(one.state_hash(), two.state_hash(), "{name}");
            assert_eq!(game.actions(&one), twin.actions(&two), "{name}");
            let action = *sampler.choose(game.actions(&one));
            assert_eq!(game.step(&mut one, action), twin.step(&mut two, action), "{name}");
            assert_eq!(one.score(), two.score(), "{name}");
        }
    }
}
