//! Generates pushing puzzles that meet a target, and writes each game with its levels to its own folder. For puzzles
//! among wandering deadly sprites, prints the win rates of a simulated player, by the number of actions between two
//! looks at the board.
//!
//! ```sh
//! cargo run --release -p infinite-arcade-generators --example puzzles -- OUT LEVELS PUSHES ACTIONS SIDE [RULES]...
//! ```
#![allow(clippy::print_stdout, reason = "a program")]

use base::Seed;
use engine::syntax;
use infinite_arcade_generators::games::PushRules;
use infinite_arcade_generators::levels::{
    LevelConfig, PuzzleConfig, PuzzleTarget, PuzzleVariation, StrayConfig, StrayLevels,
};
use std::fs;
use std::path::Path;

/// The numbers of actions between two looks. The last number exceeds the length of any level.
const COMMITMENTS: [usize; 6] = [1, 2, 5, 10, 20, 1000];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [out, levels, pushes, decisions, side, names @ ..] = &arguments[..] else {
        return Err("OUT LEVELS PUSHES ACTIONS SIDE [RULES]...".into());
    };
    let target = PuzzleTarget { pushes: pushes.parse()?, decisions: decisions.parse()? };
    let (levels, side): (u64, usize) = (levels.parse()?, side.parse()?);
    let all: Vec<PushRules> = PushRules::ALL.into_iter().chain(PushRules::AMONG_STRAYS).collect();
    if let Some(unknown) = names.iter().find(|name| all.iter().all(|rules| rules.name() != **name)) {
        let known: Vec<String> = all.iter().map(|rules| rules.name()).collect();
        return Err(format!("no rules are called `{unknown}`; there are {}", known.join(", ")).into());
    }
    for rules in all {
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
        let mut made = 0;
        let mut keep = |text: String| {
            made += 1;
            fs::write(folder.join(format!("lvl{}.txt", made - 1)), text)
        };
        let seeds = (0..levels).map(|number| Seed::from_text("puzzles").child(&name, number));
        if rules.has_strays() {
            let strays = StrayConfig {
                columns: (side, side),
                rows: (side, side),
                decisions: (target.decisions, 2 * target.decisions),
                commitments: COMMITMENTS.to_vec(),
                ..StrayConfig::default()
            };
            let puzzles = StrayLevels::new(rules, strays);
            for level in seeds.filter_map(|seed| puzzles.level(seed)) {
                let chances: Vec<String> =
                    level.chances.iter().map(|chance| format!("{:.0}", 100.0 * chance)).collect();
                let strays = level.text.matches('y').count();
                println!(
                    "{name}: {} ticks, {strays} strays; won in percent: {}",
                    level.solution.len(),
                    chances.join(" ")
                );
                keep(level.text)?;
            }
        } else {
            let puzzles = PuzzleVariation::new(&game, config, puzzle)?;
            for solved in seeds.filter_map(|seed| puzzles.create_solved(seed)) {
                keep(solved.level.to_string())?;
            }
        }
        println!("{name}: {made} of {levels} levels");
    }
    Ok(())
}
