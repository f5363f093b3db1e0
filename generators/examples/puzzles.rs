//! Makes one puzzle for each of the given rules of pushing, and prints the actions of the win that the search knows,
//! and of the shortest.
//!
//! ```sh
//! cargo run --release -p infinite-arcade-generators --example puzzles -- SEED PUSHES DECISIONS SIDE [RULES]...
//! ```
#![allow(clippy::print_stdout, reason = "a program")]

use agents::search::{Answer, Pushes, SearchLimits, a_star};
use engine::{Analysis, Seed};
use infinite_arcade_generators::games::PushRules;
use infinite_arcade_generators::levels::{LevelConfig, PuzzleConfig, PuzzleTarget, PuzzleVariation};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [seed, pushes, decisions, side, names @ ..] = &arguments[..] else {
        return Err("SEED PUSHES DECISIONS SIDE [RULES]...".into());
    };
    let target = PuzzleTarget { pushes: pushes.parse()?, decisions: decisions.parse()? };
    let side: usize = side.parse()?;
    println!("| rules | actions | proved shortest |\n|---|---|---|");
    for rules in PushRules::ALL {
        let name = rules.name();
        if !names.is_empty() && !names.contains(&name) {
            continue;
        }
        let game = rules.game();
        let config = LevelConfig { columns: (side, side), rows: (side, side), ..LevelConfig::default() };
        let puzzle = PuzzleConfig { floor_plans: 20_000, target: Some(target), ..PuzzleConfig::default() };
        let variation = match PuzzleVariation::new(&game, config, puzzle) {
            Ok(variation) => variation,
            Err(error) => {
                println!("| {name} | {error} | |");
                continue;
            }
        };
        let Some(solved) = variation.create_solved(Seed::from_text(seed).child(&name, 0)) else {
            println!("| {name} | none | |");
            continue;
        };
        let actions = solved.solution.map_or(0, |solution| solution.len());
        let analysis = Analysis::of(&game);
        let start = game.start(&solved.level, Seed::from_text("proof"));
        let limits = SearchLimits::calls(10_000_000);
        let answer = a_star(&analysis, &Pushes::of(&analysis, &solved.level), &start, limits).answer;
        let proved = match answer {
            Answer::Won { actions, .. } => actions.len().to_string(),
            _ => "no".to_owned(),
        };
        println!("| {name} | {actions} | {proved} |\n{}", solved.level);
    }
    Ok(())
}
