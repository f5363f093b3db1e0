//! Planners by name, for recipes and the command line.

use crate::{
    Budget, DoNothing, GuidedMcts, GuidedMctsConfig, Heuristic, Mcts, MctsConfig, NearestGoal, Olets,
    OletsConfig, OneStep, OneStepConfig, Planner, Random, RandomSearch, RandomSearchConfig, Rhea, RheaConfig,
    Systematic, Width, WidthConfig,
};
use engine::{Action, Game, Seed, State};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Declares the planners in one place: name, variant, constructor from a seed. The weakest first.
macro_rules! planners {
    ($($name:literal $variant:ident($type:ty) $make:expr;)*) => {
        /// The names of all planners, the weakest first.
        pub const PLANNERS: &[&str] = &[$($name),*];

        /// A planner of the registry, with default parameters. It can be saved between two decisions; once loaded, it
        /// plans on as if it had never been saved.
        #[derive(Clone, Debug, Serialize, Deserialize)]
        #[serde(tag = "planner")]
        #[allow(missing_docs, clippy::large_enum_variant, reason = "the types say what each is; players are few")]
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

/// A planner as users name it: `mcts`, or `olets:500` with the forward-model calls of a decision.
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

    /// Returns the calls of a decision, if given.
    pub fn budget(&self) -> Option<Budget> {
        self.budget
    }

    /// Returns the planner, with its own random streams.
    pub fn player(&self, seed: Seed) -> Player {
        Player::of(&self.name, seed).expect("the name was known when it was read")
    }
}

impl FromStr for PlannerSpec {
    type Err = UnknownPlanner;

    fn from_str(text: &str) -> Result<PlannerSpec, UnknownPlanner> {
        let unknown = || UnknownPlanner(text.to_owned());
        let (name, budget) = match text.split_once(':') {
            Some((name, calls)) => (name, Some(Budget(calls.parse().map_err(|_| unknown())?))),
            None => (text, None),
        };
        if !PLANNERS.contains(&name) {
            return Err(unknown());
        }
        Ok(PlannerSpec { name: name.to_owned(), budget })
    }
}

engine::serde_as_text!(PlannerSpec);

impl fmt::Display for PlannerSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.budget {
            Some(Budget(calls)) => write!(f, "{}:{calls}", self.name),
            None => f.write_str(&self.name),
        }
    }
}

/// The error for a text that names no planner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownPlanner(pub String);

impl std::error::Error for UnknownPlanner {}

impl fmt::Display for UnknownPlanner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.0.split(':').next().unwrap_or_default();
        if PLANNERS.contains(&name) {
            return write!(
                f,
                "`{}` is not a planner; the colon is followed by a number of calls: `{name}:500`",
                self.0
            );
        }
        write!(f, "no planner named `{name}`")?;
        match engine::nearest(name, PLANNERS.iter().copied()) {
            Some(near) => write!(f, "; did you mean `{near}`?")?,
            None => f.write_str(".")?,
        }
        write!(f, " There are {}; `mcts:500` is `mcts` with 500 calls a decision", PLANNERS.join(", "))
    }
}

/// Returns the planner of that name with default parameters; a budget in the name is ignored.
///
/// # Errors
/// If there is no such planner.
pub fn planner(name: &str, seed: Seed) -> Result<Box<dyn Planner + Send>, UnknownPlanner> {
    Ok(Box::new(name.parse::<PlannerSpec>()?.player(seed)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::{Episode, Outcome};

    #[test]
    fn only_registered_names_make_planners() {
        let seed = Seed::from_text("names");
        assert!(PLANNERS.iter().all(|name| planner(name, seed).is_ok()));
        let unknown = planner("Mcts", seed).err().unwrap();
        assert!(PLANNERS.iter().all(|name| unknown.to_string().contains(name)));
    }

    #[test]
    fn names_have_budgets() {
        let spec: PlannerSpec = "olets:500".parse().unwrap();
        assert_eq!((spec.name(), spec.budget()), ("olets", Some(Budget(500))));
        assert_eq!(spec.to_string(), "olets:500");
        assert_eq!("olets".parse::<PlannerSpec>().unwrap().budget(), None);
        for (text, words) in [
            ("mtcs", "did you mean `mcts`?"),
            ("mtcs:500", "did you mean `mcts`?"),
            ("mcts:many", "`mcts:500`"),
            ("mcts:-1", "`mcts:500`"),
            ("", "There are do-nothing"),
        ] {
            let error = text.parse::<PlannerSpec>().unwrap_err().to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
    }

    /// Randomness, shooting, portals, threats and pushing: no planner can foresee it all.
    const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    exit > Door\n    box > Passive\n    arrow > OrientedFlicker limit=5 singleton=True\n    bug > RandomNPC\n    avatar > ShootAvatar stype=arrow\n  LevelMapping\n    . > floor\n    A > avatar floor\n    e > exit floor\n    b > bug floor\n    x > box floor\n  InteractionSet\n    avatar wall > stepBack\n    bug wall > stepBack\n    box wall > undoAll\n    box avatar > bounceForward\n    bug box > stepBack\n    bug arrow > killSprite scoreChange=1\n    avatar bug > killSprite scoreChange=-1\n    exit avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=exit win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=60 win=False\n";
    const LEVEL: &str = "wwwwwwwwwww\nwA..x....bw\nw.........w\nw..b.w..x.w\nw....w...ew\nwwwwwwwwwww\n";

    fn playing(name: &str, decisions: usize, saved_after: Option<usize>) -> (Vec<Action>, Vec<u64>, Outcome) {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(LEVEL).unwrap();
        let mut player = name.parse::<PlannerSpec>().unwrap().player(Seed::from_text(name));
        let (mut episode, mut state) = Episode::begin(&game, &level, Seed::from_text("saved"));
        let mut calls = Vec::new();
        for decision in 0..decisions {
            if saved_after == Some(decision) {
                let saved = serde_json::to_string(&player).unwrap();
                player = serde_json::from_str(&saved).unwrap();
                assert_eq!(serde_json::to_string(&player).unwrap(), saved);
            }
            if state.is_over() {
                break;
            }
            let (action, cost) = player.plan(&game, &state, Budget(150));
            calls.push(cost);
            episode.play(&game, &mut state, action);
        }
        (episode.actions, calls, state.outcome())
    }

    #[test]
    fn loaded_planners_continue_identically() {
        for name in PLANNERS {
            let whole = playing(name, 25, None);
            assert_eq!(playing(name, 25, None), whole, "{name} is not a function of its seed");
            for saved_after in [1, 7] {
                assert_eq!(playing(name, 25, Some(saved_after)), whole, "{name} after {saved_after}");
            }
        }
    }

    /// The game's own random stream is hidden: with another future, but the same present, the decision is the same.
    #[test]
    fn no_planner_foresees_the_future() {
        let game = Game::from_source(GAME).unwrap();
        let state = game.start(&game.level(LEVEL).unwrap(), Seed::from_text("present"));
        for name in PLANNERS {
            let plan = |state: &State| {
                name.parse::<PlannerSpec>().unwrap().player(Seed::from_text(name)).plan(
                    &game,
                    state,
                    Budget(300),
                )
            };
            let decisions: Vec<_> =
                (0..4).map(|i| plan(&state.fork(Seed::from_text("f").child("f", i)))).collect();
            assert!(decisions.iter().all(|decision| *decision == decisions[0]), "{name}: {decisions:?}");
        }
    }

    #[test]
    fn budgets_are_exceeded_by_at_most_one_iteration() {
        let game = Game::from_source(GAME).unwrap();
        let state = game.start(&game.level(LEVEL).unwrap(), Seed::from_text("budget"));
        for name in ["random-search", "rhea", "mcts", "guided-mcts", "olets"] {
            for budget in [0, 1, 5, 60, 1000] {
                let mut player = name.parse::<PlannerSpec>().unwrap().player(Seed::from_text(name));
                let (action, calls) = player.plan(&game, &state, Budget(budget));
                assert!((budget..budget + 40).contains(&calls), "{name}:{budget} took {calls} calls");
                assert!(action == Action::Nil || game.actions(&state).contains(&action));
            }
        }
    }
}
