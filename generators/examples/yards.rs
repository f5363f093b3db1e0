//! Generates yards (puzzles about carrying parcels) that meet a target, and writes each game with its levels to its own
//! folder. Prints the length of each win.
//!
//! ```sh
//! cargo run --release -p infinite-arcade-generators --example yards -- OUT LEVELS LEAST MOST SIDE [RULES]...
//! ```
//! The number of keys in a fastest win is at least `LEAST` and less than `MOST`.
#![allow(clippy::print_stdout, reason = "a program")]

use base::Seed;
use engine::syntax;
use infinite_arcade_generators::games::YardRules;
use infinite_arcade_generators::levels::YardConfig;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [out, levels, least, most, side, names @ ..] = &arguments[..] else {
        return Err("OUT LEVELS LEAST MOST SIDE [RULES]...".into());
    };
    let (levels, decisions): (u64, (usize, usize)) = (levels.parse()?, (least.parse()?, most.parse()?));
    let side: usize = side.parse()?;
    let known = YardRules::ALL.map(YardRules::name);
    if let Some(unknown) = names.iter().find(|name| !known.contains(name)) {
        return Err(format!("unknown rules `{unknown}`; known: {}", known.join(", ")).into());
    }
    for rules in YardRules::ALL {
        let name = rules.name();
        if !names.is_empty() && !names.contains(&name) {
            continue;
        }
        let folder = Path::new(out).join(&name);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("game.vgdl"), syntax::print(rules.game().description()))?;
        let sizes = YardConfig { columns: (side, side), rows: (side, side), ..YardConfig::default() };
        let config = YardConfig { decisions, ..sizes };
        let mut made = 0;
        for number in 0..levels {
            let Some(level) = config.level(rules, Seed::from_text("yards").child(&name, number)) else {
                continue;
            };
            println!("{name} {made}: {} ticks", level.solution.len());
            fs::write(folder.join(format!("lvl{made}.txt")), level.text)?;
            made += 1;
        }
        println!("{name}: {made} of {levels} levels");
    }
    Ok(())
}
