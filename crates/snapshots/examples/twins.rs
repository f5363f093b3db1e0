//! Writes a twin of each game in a folder, which is the same game with a different surface (names, characters or
//! orientation): `cargo run --release -p infinite-arcade-snapshots --example twins -- renamed GAMES OUT`.

use infinite_arcade_snapshots::twin::{Twin, of_game};
use std::error::Error;
use std::fs;
use std::path::Path;

#[allow(clippy::print_stderr, reason = "an example prints")]
fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [kind, games, out] = &args[..] else { return Err("usage: twins KIND GAMES OUT".into()) };
    let kind: Twin = kind.parse()?;
    let mut folders: Vec<_> = fs::read_dir(games)?.collect::<Result<_, _>>()?;
    folders.sort_by_key(fs::DirEntry::file_name);
    for folder in folders {
        let text = ["game.vgdl", "game.txt"].map(|name| fs::read_to_string(folder.path().join(name)));
        let Some(text) = text.into_iter().find_map(Result::ok) else { continue };
        let level = |number: usize| fs::read_to_string(folder.path().join(format!("lvl{number}.txt"))).ok();
        let levels: Vec<String> = (0..).map_while(level).collect();
        match of_game(kind, &text, &levels, &[]) {
            Ok(twin) => {
                let to = Path::new(out).join(folder.file_name());
                fs::create_dir_all(&to)?;
                fs::write(to.join("game.vgdl"), twin.text)?;
                for (number, level) in twin.levels.iter().enumerate() {
                    fs::write(to.join(format!("lvl{number}.txt")), level)?;
                }
            }
            Err(why) => eprintln!("{}: {why}", folder.path().display()),
        }
    }
    Ok(())
}
