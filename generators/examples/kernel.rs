//! Writes the game and the levels of a kernel file (a hand-written design), with a scene's nouns or with the kernel's
//! type names: `cargo run -p infinite-arcade-generators --example kernel -- FILE.toml FOLDER [SEED] [--variants]
//! [--form=NAME] [--scene=NAME]`.

use base::Seed;
use engine::Game;
use infinite_arcade_generators::kernels::{Slot, preview};
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
    let (source, course) = preview(name, &text, form, scene, variants, seed)?;
    let game = Game::from_source(&source).map_err(|problems| problems.to_string())?;
    let folder = Path::new(folder.as_str());
    fs::create_dir_all(folder)?;
    fs::write(folder.join("game.vgdl"), &source)?;
    for (number, slot) in Slot::ALL.into_iter().enumerate() {
        let made = course.level(slot, seed.child("level", number as u64));
        let path = folder.join(format!("lvl{number}.txt"));
        match made {
            Ok(level) => {
                if let Err(problems) = game.level(&level.text) {
                    println!("{slot:?}: {problems}");
                }
                println!("{slot:?}: {}\n{}", level.asks, level.text);
                fs::write(path, level.text)?;
            }
            Err(error) => println!("{slot:?}: {error}"),
        }
    }
    Ok(())
}
