//! Planners by name, for recipes and the command line.

use crate::{DoNothing, Mcts, MctsConfig, Planner, Random};
use engine::Seed;

/// The names of all planners, weakest first.
pub const PLANNERS: &[&str] = &["do-nothing", "random", "mcts"];

/// A name that no planner has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no planner named `{0}`; there are do-nothing, random and mcts")]
pub struct UnknownPlanner(pub String);

/// The planner of that name with default parameters.
///
/// # Errors
/// If there is none.
pub fn planner(name: &str, seed: Seed) -> Result<Box<dyn Planner + Send>, UnknownPlanner> {
    Ok(match name {
        "do-nothing" => Box::new(DoNothing),
        "random" => Box::new(Random::new(seed)),
        "mcts" => Box::new(Mcts::new(MctsConfig::default(), seed)),
        _ => return Err(UnknownPlanner(name.to_owned())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_makes_a_planner_and_no_other() {
        let seed = Seed::from_text("names");
        assert!(PLANNERS.iter().all(|name| planner(name, seed).is_ok()));
        let unknown = planner("Mcts", seed).err().unwrap();
        assert!(PLANNERS.iter().all(|name| unknown.to_string().contains(name)));
    }
}
