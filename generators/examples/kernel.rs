//! Writes the game of a kernel file, in a scene or with the kernel's type names, and a composed board for each demand.
//! Nobody has won these boards yet:
//! `cargo run -p infinite-arcade-generators --example kernel -- FILE.toml FOLDER [SEED] [--variants] [--form=NAME]
//! [--scene=NAME]`.

use base::Seed;
use engine::{Analysis, Game};
use infinite_arcade_generators::Variation;
use infinite_arcade_generators::boards::{BoardBrief, BoardVariation};
use infinite_arcade_generators::kernels::preview;
use std::error::Error;
use std::fs;
use std::path::Path;

#[allow(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (flags, words): (Vec<&String>, Vec<&String>) = args.iter().partition(|word| word.starts_with("--"));
    let [file, folder, rest @ ..] = &words[..] else {
        return Err("usage: kernel FILE.toml FOLDER [SEED] [--variants] [--form=NAME] [--scene=NAME]".into());
    };
    let form = flags.iter().find_map(|flag| flag.strip_prefix("--form="));
    let scene = flags.iter().find_map(|flag| flag.strip_prefix("--scene="));
    let variants = flags.iter().any(|flag| *flag == "--variants");
    let text = fs::read_to_string(file)?;
    let name = Path::new(file).file_stem().and_then(|name| name.to_str()).unwrap_or("kernel");
    let seed = Seed::from_text(rest.first().map_or("preview", |seed| seed.as_str()));
    let source = preview(name, &text, form, scene, variants, seed)?;
    let game = Game::from_source(&source).map_err(|problems| problems.to_string())?;
    let folder = Path::new(folder.as_str());
    fs::create_dir_all(folder)?;
    fs::write(folder.join("game.vgdl"), &source)?;
    let analysis = Analysis::of(&game);
    for demand in 0..=4 {
        let variation = BoardVariation::new(&analysis, &BoardBrief::of_demand(demand))?;
        match variation.create(seed.child("board", demand.into())) {
            Some(board) => {
                let text = board.to_string();
                println!("{text}");
                fs::write(folder.join(format!("lvl{demand}.txt")), text)?;
            }
            None => println!("no board for demand {demand}"),
        }
    }
    Ok(())
}
