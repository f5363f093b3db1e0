//! The longest commitment (number of actions per decision) with which a planner still wins.

use super::patience;
use agents::{Budget, OpenLoop, PlannerSpec};
use base::Seed;
use engine::{Analysis, Episode, Game, Level, Outcome};

base::named_enum! {
    /// The length of the longest plans with which a planner still wins a level. The length is the number of
    /// actions played without observing the game again. The shorter it is, the more demanding the level.
    pub enum Commitment {
        /// No planner wins, even when observing the game before every action.
        None = "none",
        /// One action per decision: the player observes the game before every action.
        One = "1",
        /// Two actions per decision.
        Two = "2",
        /// Five actions per decision.
        Five = "5",
        /// Ten actions per decision.
        Ten = "10",
        /// Twenty actions per decision.
        Twenty = "20",
        /// Fifty actions per decision.
        Fifty = "50",
        /// A single decision, with a plan for the whole episode.
        All = "all",
    }
}

/// The portfolio's planners that play the episodes. Each plays in open loop, that is, without observing the game during
/// a plan.
const PLANNERS: [&str; 3] = ["width", "guided-mcts", "olets"];
/// The number of forward-model calls per decision.
const DECISION: Budget = Budget(200);
/// The maximum number of forward-model calls per episode.
const CALLS: u64 = 100_000;

impl Commitment {
    /// Runs every planner once for each commitment (number of actions per decision), from shortest to longest, until
    /// none of them wins. On a deterministic level, another observation does not change a plan, so a single round of
    /// episodes is enough. Cost: at most 2.1 million forward-model calls.
    pub(super) fn of(analysis: &Analysis, level: &Level, win: &Episode, seed: Seed) -> Commitment {
        let game = analysis.game();
        let is_certain = analysis.is_deterministic_from(&game.start(level, seed));
        let mut longest = Commitment::None;
        for commitment in Commitment::ALL {
            let Some(actions) = commitment.actions() else { continue };
            let wins = |planner: &&str| {
                let seed = seed.child(planner, actions);
                let spec: PlannerSpec = planner.parse().expect("a planner of the registry");
                let open = OpenLoop::new(spec.player(seed), DECISION, seed);
                is_won(game, level, open, actions, patience(win), seed.child("chance", 0))
            };
            if !PLANNERS.iter().any(wins) {
                break;
            }
            longest = if is_certain { Commitment::All } else { commitment };
            if is_certain {
                break;
            }
        }
        longest
    }

    /// Returns the number of actions in a plan, or `None` for [`Commitment::None`].
    pub fn actions(self) -> Option<u64> {
        Some(match self {
            Commitment::None => return None,
            Commitment::One => 1,
            Commitment::Two => 2,
            Commitment::Five => 5,
            Commitment::Ten => 10,
            Commitment::Twenty => 20,
            Commitment::Fifty => 50,
            Commitment::All => u64::MAX,
        })
    }
}

/// Plays one episode in plans of `actions` actions. Returns `true` if the episode is won.
fn is_won(
    game: &Game,
    level: &Level,
    mut player: OpenLoop<agents::Player>,
    actions: u64,
    ticks: usize,
    seed: Seed,
) -> bool {
    let mut state = game.start(level, seed);
    let (mut played, mut calls) = (0, 0);
    while !state.is_over() && played < ticks && calls < CALLS {
        let least = DECISION.0.max(1);
        let most = actions.min((ticks - played) as u64).min((CALLS - calls).div_ceil(least));
        let (plan, spent) = player.plan(game, &state, most);
        calls += spent;
        for action in plan {
            if state.is_over() {
                break;
            }
            game.step(&mut state, action);
            played += 1;
        }
    }
    state.outcome() == Outcome::Won
}
