//! Generates lock puzzles that meet a target, and writes each game with its levels to its own folder.
//!
//! ```sh
//! cargo run --release -p infinite-arcade-generators --example locks -- OUT LEVELS ACTIONS SIDE [RULES]...
//! ```
#![allow(clippy::print_stdout, reason = "a program")]

use base::Seed;
use engine::syntax;
use infinite_arcade_generators::games::LockRules;
use infinite_arcade_generators::levels::LockConfig;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [out, levels, decisions, side, names @ ..] = &arguments[..] else {
        return Err("OUT LEVELS ACTIONS SIDE [RULES]...".into());
    };
    let (levels, decisions, side): (u64, usize, usize) = (levels.parse()?, decisions.parse()?, side.parse()?);
    for rules in LockRules::ALL {
        let name = rules.name();
        if !names.is_empty() && !names.contains(&name) {
            continue;
        }
        let folder = Path::new(out).join(&name);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("game.vgdl"), syntax::print(rules.game().description()))?;
        let config =
            LockConfig { columns: (side, side), rows: (side, side), decisions, ..LockConfig::default() };
        let mut made = Vec::new();
        for number in 0..levels {
            let Some(level) = config.level(rules, Seed::from_text("locks").child(&name, number)) else {
                continue;
            };
            fs::write(folder.join(format!("lvl{}.txt", made.len())), level.text)?;
            made.push(level.solution.len());
        }
        println!("{name}: {} of {levels} levels, of {made:?} actions", made.len());
    }
    Ok(())
}
