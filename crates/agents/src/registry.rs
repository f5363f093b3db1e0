//! A registry of planners by name, for recipes and the command line.

use crate::{
    Budget, DoNothing, GuidedMcts, GuidedMctsConfig, Heuristic, Mcts, MctsConfig, NearestGoal, Olets,
    OletsConfig, OneStep, OneStepConfig, Planner, Random, RandomSearch, RandomSearchConfig, Rhea, RheaConfig,
    Systematic, Width, WidthConfig,
};
use base::Seed;
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Declares all planners in one place, from weakest to strongest. Each planner has a name, a variant and a
/// constructor that accepts a seed.
macro_rules! planners {
    ($($name:literal $variant:ident($type:ty) $make:expr;)*) => {
        /// The names of all planners, ordered from weakest to strongest.
        pub const PLANNERS: &[&str] = &[$($name),*];

        /// A registered planner with default parameters. A player can be saved between two decisions. Once loaded, it
        /// continues as if it had never been saved.
        #[derive(Clone, Debug, Serialize, Deserialize)]
        #[serde(tag = "planner")]
        #[allow(missing_docs, clippy::large_enum_variant, reason = "each variant is documented by its type; only a few players exist")]
        pub enum Player {
            $(#[serde(rename = $name)] $variant($type),)*
        }

        impl Player {
            fn of(name: &str, seed: Seed) -> Option<Player> {
                match name {
                    $($name => Some(Player::$variant($make(seed))),)*
                    _ => None,
                }
            }
        }

        impl Planner for Player {
            fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64) {
                match self {
                    $(Player::$variant(planner) => planner.plan(game, state, budget),)*
                }
            }
        }
    };
}

planners! {
    "do-nothing" DoNothing(DoNothing) |_| DoNothing;
    "random-with-nil" RandomWithNil(Random) Random::with_nil;
    "random" Random(Random) Random::new;
    "one-step-score" OneStepScore(OneStep) |seed| {
        OneStep::new(OneStepConfig { heuristic: Heuristic::WinScore, ..OneStepConfig::default() }, seed)
    };
    "one-step" OneStep(OneStep) |seed| OneStep::new(OneStepConfig::default(), seed);
    "nearest-goal" NearestGoal(NearestGoal) |seed| NearestGoal::new(0.0, seed);
    "random-search" RandomSearch(RandomSearch) |seed| RandomSearch::new(RandomSearchConfig::default(), seed);
    "rhea" Rhea(Rhea) |seed| Rhea::new(RheaConfig::default(), seed);
    "mcts" Mcts(Mcts) |seed| Mcts::new(MctsConfig::default(), seed);
    "width" Width(Width) |seed| Width::new(WidthConfig::default(), seed);
    "guided-mcts" GuidedMcts(GuidedMcts) |seed| GuidedMcts::new(GuidedMctsConfig::default(), seed);
    "olets" Olets(Olets) |seed| Olets::new(OletsConfig::default(), seed);
    "systematic" Systematic(Systematic) Systematic::new;
}

/// Planners that do not look ahead.
const BASELINES: [&str; 3] = ["do-nothing", "random", "random-with-nil"];
/// Planners that look ahead but make only a few calls, regardless of their budget.
const SHALLOW: [&str; 3] = ["one-step", "one-step-score", "nearest-goal"];

/// A planner as specified by a user, such as `mcts` or `olets:500`. The number after the colon is the number of
/// forward-model calls per decision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlannerSpec {
    name: String,
    budget: Option<Budget>,
}

impl PlannerSpec {
    /// Returns the planner's name, without the budget.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of calls per decision, if given.
    pub fn budget(&self) -> Option<Budget> {
        self.budget
    }

    /// Returns `true` if the planner looks ahead. The baselines, which do nothing or act at random, do not
    /// look ahead.
    pub fn looks_ahead(&self) -> bool {
        !BASELINES.contains(&self.name())
    }

    /// Returns `true` if the planner spends its whole budget on each decision, instead of making only a few calls or
    /// none.
    pub fn spends_its_budget(&self) -> bool {
        self.looks_ahead() && !SHALLOW.contains(&self.name())
    }

    /// Returns a new player for the planner, with its own random-number streams.
    pub fn player(&self, seed: Seed) -> Player {
        Player::of(&self.name, seed).expect("a parsed planner has a known name")
    }
}

impl FromStr for PlannerSpec {
    type Err = UnknownPlanner;

    fn from_str(text: &str) -> Result<PlannerSpec, UnknownPlanner> {
        let unknown = || UnknownPlanner(text.to_owned());
        let (name, budget) = match text.split_once(':') {
            Some((name, calls)) => {
                let budget = Budget(calls.parse().map_err(|_| unknown())?);
                (name, Some((budget <= Budget::MOST).then_some(budget).ok_or_else(unknown)?))
            }
            None => (text, None),
        };
        if !PLANNERS.contains(&name) {
            return Err(unknown());
        }
        Ok(PlannerSpec { name: name.to_owned(), budget })
    }
}

base::serde_as_text!(PlannerSpec);

impl fmt::Display for PlannerSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.budget {
            Some(Budget(calls)) => write!(f, "{}:{calls}", self.name),
            None => f.write_str(&self.name),
        }
    }
}

/// The error for a text that does not specify a planner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownPlanner(pub String);

impl std::error::Error for UnknownPlanner {}

impl fmt::Display for UnknownPlanner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.0.split(':').next().unwrap_or_default();
        if PLANNERS.contains(&name) {
            let Budget(most) = Budget::MOST;
            return write!(
                f,
                "`{}` is not a planner; after the colon, write a number of calls up to {most}: `{name}:500`",
                self.0
            );
        }
        write!(f, "no planner named `{name}`")?;
        match engine::nearest(name, PLANNERS.iter().copied()) {
            Some(near) => write!(f, "; did you mean `{near}`?")?,
            None => f.write_str(".")?,
        }
        write!(
            f,
            " The planners are {}; `mcts:500` is `mcts` with 500 calls per decision",
            PLANNERS.join(", ")
        )
    }
}

/// Returns the planner with the given name, with default parameters. A budget in the name is ignored.
///
/// # Errors
///
/// Returns an error if no such planner exists.
pub fn planner(name: &str, seed: Seed) -> Result<Box<dyn Planner + Send>, UnknownPlanner> {
    Ok(Box::new(name.parse::<PlannerSpec>()?.player(seed)))
}
