//! A portfolio of methods for winning a level. By default, the portfolio decides whether a level can be won.

use crate::planner::{Budget, Planner};
use crate::play::{Limits, Play, Stopped, play_until};
use crate::search::{Answer, Pushes, SearchLimits, Searched, a_star_until, best_first_until};
use crate::tree_search::mcts::{Mcts, MctsConfig};
use crate::tree_search::mcts_guided::{GuidedMcts, GuidedMctsConfig};
use crate::tree_search::olets::{Olets, OletsConfig};
use crate::width::{Width, WidthConfig};
use base::SeedPath;
use engine::{Action, Analysis, Episode, Level, Outcome};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// The parameters of the portfolio. They divide a budget between its methods.
    ///
    /// In a deterministic game, systematic search comes first: [`a_star`] for small levels, then
    /// [`best_first`]. After that, and from the start in stochastic games, planners play episodes in rounds
    /// of growing length:
    ///
    /// - [`Width`] looks far ahead.
    /// - [`GuidedMcts`] heads for the targets that follow from the rules.
    /// - [`Olets`] stays alive.
    /// - [`MctsConfig::bold`] searches take risks.
    ///
    /// In a stochastic game, part of the budget can be reserved for foresight. In that case, a [`best_first`] search
    /// that foresees all randomness of one episode runs once the planners have spent half of their calls.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct PortfolioConfig {
        /// The number of forward-model calls across all searches and episodes.
        pub budget: u64 = 3_000_000,
        /// The fraction of the budget for the search for the shortest win.
        pub shortest: f64 = 0.1,
        /// The fraction of the budget for the systematic search for any win.
        pub systematic: f64 = 0.4,
        /// The fraction of the budget reserved for a search with foresight in a stochastic game.
        pub foresight: f64 = 0.0,
        /// The memory limit of a systematic search, in bytes.
        pub bytes: usize = 1 << 30,
        /// A planner's maximum number of calls per decision. Planners get fewer calls if an episode would otherwise
        /// exceed its part of the budget. The cost of an episode is estimated from its expected length:
        /// [`USUAL_TICKS`], or the tick at which survival wins.
        pub decision: u64 = 500,
        /// The look-ahead, in ticks, of each bold Monte-Carlo tree search. Each entry adds one such player.
        pub depths: Vec<u32> = vec![20],
    }
}

/// The result of the portfolio.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The finding on whether the level can be won.
    pub solution: Solution,
    /// The number of forward-model calls across all searches and episodes.
    pub calls: u64,
    /// The episodes that the planners played, in the order of play.
    pub plays: Vec<Play>,
}

/// A finding on whether a level can be won.
#[derive(Clone, Debug)]
pub enum Solution {
    /// The level was won in an episode.
    Won {
        /// The winning episode, which replays bit for bit.
        episode: Box<Episode>,
        /// `true` if this win is proven to be the shortest.
        shortest: bool,
    },
    /// A win is provably impossible: the search has covered all reachable states.
    Impossible {
        /// The number of distinct reachable states.
        states: u64,
        /// The actions that lead to the state closest to a win. See [`Searched::nearest`].
        nearest: Vec<Action>,
    },
    /// The budget ran out before the question was answered.
    Unknown,
}

/// The total budget divided by this number is the budget of the first round. Each later round may cost twice as much
/// as the one before.
const FIRST_ROUND: u64 = 16;

/// Searches for a win. The same configuration and seed produce the same result with any number of threads. Each
/// episode records the path of its seed, from the root of a [`SeedPath`] or from the given seed.
pub fn solve(
    analysis: &Analysis,
    level: &Level,
    config: &PortfolioConfig,
    seed: impl Into<SeedPath>,
) -> Solved {
    solve_until(analysis, level, config, seed, &|| false)
}

/// Searches like [`solve`], but can be stopped. Soon after `stopped` returns `true`, the search returns
/// [`Solution::Unknown`]. A search that is not stopped returns the same result as [`solve`].
pub fn solve_until(
    analysis: &Analysis,
    level: &Level,
    config: &PortfolioConfig,
    seed: impl Into<SeedPath>,
    stopped: &(dyn Fn() -> bool + Sync),
) -> Solved {
    let (game, seed) = (analysis.game(), seed.into());
    let mut solved = Solved { solution: Solution::Unknown, calls: 0, plays: Vec::new() };
    let chance = systematic_seed(&seed);
    let start = game.start(level, chance.seed());
    let pushes = Pushes::of(analysis, level);
    let share = |share: f64| SearchLimits {
        calls: (config.budget as f64 * share.clamp(0.0, 1.0)) as u64,
        bytes: config.bytes,
    };
    let take = |solved: &mut Solved, searched: Searched| {
        solved.calls += searched.calls;
        match searched.answer {
            Answer::Won { actions, shortest } => {
                let (mut episode, mut state) = Episode::begin(game, level, &chance);
                for action in actions {
                    episode.play(game, &mut state, action);
                }
                solved.solution = Solution::Won { episode: Box::new(episode), shortest };
            }
            Answer::Impossible => {
                let Searched { states, nearest, .. } = searched;
                solved.solution = Solution::Impossible { states, nearest };
            }
            Answer::OutOfCalls | Answer::OutOfMemory => return false,
        }
        true
    };
    let is_certain = analysis.is_deterministic_from(&start);
    if !start.is_over()
        && is_certain
        && (take(&mut solved, a_star_until(analysis, &pushes, &start, share(config.shortest), stopped))
            || take(
                &mut solved,
                best_first_until(analysis, &pushes, &start, share(config.systematic), stopped),
            ))
    {
        return solved;
    }
    // The search with foresight runs once the planners have made half of their calls. It has its own fraction of the
    // budget.
    let mut foresight = if is_certain || start.is_over() { 0 } else { share(config.foresight).calls };
    let budget = config.budget - foresight;
    let mut played = solved.calls;
    let mut round_calls = budget / FIRST_ROUND;
    for round in 0.. {
        if foresight > 0 && (played >= budget / 2 || round == MAX_ROUNDS) {
            foresight = 0;
            let searched = best_first_until(analysis, &pushes, &start, share(config.foresight), stopped);
            // The level may still be winnable with different randomness.
            if matches!(searched.answer, Answer::Impossible) {
                solved.calls += searched.calls;
            } else if take(&mut solved, searched) {
                break;
            }
        }
        let left = budget.saturating_sub(played);
        if left == 0 || round == MAX_ROUNDS || stopped() {
            break;
        }
        let seed = seed.child("round", round);
        let plays = play_round(analysis, level, config, round_calls.min(left), &seed, stopped);
        let calls: u64 = plays.iter().map(|play| play.calls).sum();
        (played, solved.calls) = (played + calls, solved.calls + calls);
        let won = plays.iter().filter(|play| play.episode.outcome == Outcome::Won);
        let shortest = won.min_by_key(|play| play.episode.actions.len());
        if let Some(play) = shortest {
            solved.solution = Solution::Won { episode: Box::new(play.episode.clone()), shortest: false };
        }
        solved.plays.extend(plays);
        if matches!(solved.solution, Solution::Won { .. }) {
            break;
        }
        round_calls = round_calls.saturating_mul(2);
    }
    solved
}

/// Returns the seed for the randomness of the systematic searches in [`solve`].
pub fn systematic_seed(solve: &SeedPath) -> SeedPath {
    solve.child("systematic", 0)
}

/// The maximum number of rounds. The limit is for games that end immediately. Their episodes cost almost nothing, so
/// they could otherwise be played for many rounds.
const MAX_ROUNDS: u64 = 20;

/// The number of ticks that the budget for an episode should cover.
const USUAL_TICKS: u64 = 700;
/// The minimum number of calls per decision.
const LEAST_DECISION: u64 = 30;

/// Plays one episode with each planner. The budget is divided equally between the planners. An episode stops once it
/// has spent its part of the budget.
fn play_round(
    analysis: &Analysis,
    level: &Level,
    config: &PortfolioConfig,
    budget: u64,
    seed: &SeedPath,
    stopped: Stopped<'_>,
) -> Vec<Play> {
    let game = analysis.game();
    let players = config.depths.len() + 3;
    let limits = Limits { calls: budget / players as u64, ..Limits::default() };
    let survive = analysis.aims().survive.and_then(|tick| u64::try_from(tick).ok());
    // The budget per decision leaves a margin, because searches slightly exceed their budgets.
    let least = LEAST_DECISION.min(config.decision);
    let affordable = |ticks: u64| (limits.calls / ticks.max(1) * 4 / 5).clamp(least, config.decision);
    (0..players)
        .into_par_iter()
        .map(|number| {
            let seed = seed.child("play", number as u64);
            let own = seed.seed().child("planner", 0);
            let mut planner: Box<dyn Planner> = match number {
                0 => Box::new(Width::new(WidthConfig::default(), own)),
                1 => Box::new(GuidedMcts::new(GuidedMctsConfig::default(), own)),
                2 => Box::new(Olets::new(OletsConfig::default(), own)),
                _ => Box::new(Mcts::new(MctsConfig::bold(config.depths[number - 3]), own)),
            };
            let decision = match (survive, number) {
                (Some(ticks), _) => affordable(ticks + 1),
                // A long look-ahead is expensive, but helps to find short wins.
                (None, 0) => config.decision,
                (None, _) => affordable(USUAL_TICKS),
            };
            let chance = seed.child("chance", 0);
            play_until(game, level, planner.as_mut(), Budget(decision), chance, limits, stopped)
        })
        .collect()
}
