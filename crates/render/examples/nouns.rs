//! Draws the images for nouns as a numbered sheet. Run it with `cargo run -p infinite-arcade-render --example
//! nouns -- NOUNS SHEET.png [names]`. NOUNS is a file with one noun per line. The captions are numbers, or
//! the nouns themselves if `names` is given.

use base::Seed;
use engine::{Analysis, Game};
use infinite_arcade_render::{Looks, Picture, Style, picture, png, sheet};
use std::error::Error;
use std::fs;

const COLOURS: [&str; 6] = ["ORANGE", "LIGHTBLUE", "GREEN", "YELLOW", "BROWN", "WHITE"];

fn drawn(noun: &str, colour: &str) -> Result<Picture, Box<dyn Error>> {
    let img = if noun.contains('/') { noun.to_owned() } else { format!("prize/{noun}") };
    let source = format!(
        "BasicGame\n  SpriteSet\n    thing > Immovable color={colour} img={img}\n    avatar > MovingAvatar hidden=True\n  LevelMapping\n    t > thing avatar\n  \
         InteractionSet\n    thing avatar > stepBack\n  TerminationSet\n    SpriteCounter stype=avatar limit=0 win=False\n"
    );
    let game = Game::from_source(&source)?;
    let state = game.start(&game.level("t")?, Seed::from_text("nouns"));
    Ok(picture(&Looks::of(&Analysis::of(&game)), &state, &Style::bare(72))?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [nouns, to, rest @ ..] = &args[..] else { return Err("give NOUNS and SHEET.png".into()) };
    let mut entries = Vec::new();
    for (at, noun) in fs::read_to_string(nouns)?.lines().enumerate() {
        let caption = if rest.is_empty() { format!("{}", at + 1) } else { noun.to_owned() };
        entries.push((drawn(noun, COLOURS[at % COLOURS.len()])?, caption));
    }
    fs::write(to, png(&sheet(&entries, 10, 80)?)?)?;
    Ok(())
}
