//! Draws inventions and prints them: `cargo run --example invention -- SEED [COUNT]`. With `--census`, prints the
//! number of draws that each condition rejects instead.

#![allow(clippy::print_stdout, reason = "an example prints")]

use base::Seed;
use infinite_arcade_generators::invention::{Census, Invention, InventionConfig};
use std::collections::BTreeMap;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let seed = Seed::from_text(arguments.first().map_or("one", String::as_str));
    let count: u64 = arguments.get(1).and_then(|count| count.parse().ok()).unwrap_or(3);
    let config = InventionConfig::default();
    if arguments.iter().any(|argument| argument == "--census") {
        let mut reasons: BTreeMap<String, u64> = BTreeMap::new();
        for at in 0..count {
            let reason = match Invention::sample(&config, seed.child("sample", at)) {
                Ok(invention) => match invention.build() {
                    Ok(_) => "sound".to_owned(),
                    Err(error) => format!("does not build: {error}"),
                },
                Err(why) => why.name().to_owned(),
            };
            *reasons.entry(reason).or_default() += 1;
        }
        for (reason, count) in reasons {
            println!("{count:8} {reason}");
        }
        return;
    }
    let mut census = Census::default();
    for at in 0..count {
        let Some(invention) = Invention::draw(&config, &census, seed.child("game", at)) else {
            println!("no sound draw");
            continue;
        };
        match invention.build() {
            Ok(invented) => {
                let game = invented.game;
                census.count(game.patterns.iter().map(String::as_str));
                println!(
                    "# {}\n# {}\n# {}\n# {}",
                    game.title,
                    game.summary,
                    game.goal,
                    game.patterns.join(" ")
                );
                println!("{}", engine::syntax::print(game.rules.description()));
            }
            Err(error) => println!("{error}"),
        }
    }
}
