//! Makes puzzles of the rules of pushing to a target, and writes each game with its levels to a folder of its own.
//!
//! ```sh
//! cargo run --release -p infinite-arcade-generators --example puzzles -- OUT LEVELS PUSHES ACTIONS SIDE [RULES]...
//! ```
#![allow(clippy::print_stdout, reason = "a program")]

use engine::{Seed, syntax};
use infinite_arcade_generators::games::PushRules;
use infinite_arcade_generators::levels::{LevelConfig, PuzzleConfig, PuzzleTarget, PuzzleVariation};
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [out, levels, pushes, decisions, side, names @ ..] = &arguments[..] else {
        return Err("OUT LEVELS PUSHES ACTIONS SIDE [RULES]...".into());
    };
    let target = PuzzleTarget { pushes: pushes.parse()?, decisions: decisions.parse()? };
    let (levels, side): (u64, usize) = (levels.parse()?, side.parse()?);
    for rules in PushRules::ALL {
        let name = rules.name();
        if !names.is_empty() && !names.contains(&name) {
            continue;
        }
        let game = rules.game();
        let folder = Path::new(out).join(&name);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("game.vgdl"), syntax::print(game.description()))?;
        let config = LevelConfig { columns: (side, side), rows: (side, side), ..LevelConfig::default() };
        let puzzle = PuzzleConfig { floor_plans: 20_000, target: Some(target), ..PuzzleConfig::default() };
        let variation = PuzzleVariation::new(&game, config, puzzle)?;
        let mut made = 0;
        for number in 0..levels {
            let solved = variation.create_solved(Seed::from_text("puzzles").child(&name, number));
            let Some(solved) = solved else { continue };
            fs::write(folder.join(format!("lvl{made}.txt")), solved.level.to_string())?;
            made += 1;
        }
        println!("{name}: {made} of {levels} levels");
    }
    Ok(())
}
