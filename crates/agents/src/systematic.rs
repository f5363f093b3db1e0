//! A player that uses systematic search.

use crate::planner::{Budget, Planner, Streams};
use crate::search::{Answer, Pushes, SearchLimits, best_first};
use base::Seed;
use engine::analysis::Analysis;
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

/// The length in ticks of a plan in a stochastic game, and of the first plan without a win in a deterministic game.
const AHEAD: usize = 10;

/// A player that uses [`best_first`] to search for a complete winning plan, and plays this plan without searching
/// again. If the player finds no win within the budget, it plays towards the state in which the fewest sprites must
/// still disappear or appear, and then presses random keys.
///
/// In a deterministic game, a winning plan stays correct, however long it is. After a plan that does not win, the
/// player searches again after ten ticks, and doubles this interval with each further search. In a stochastic game,
/// the search treats one imagined future as the only possible one. Such a search gets a tenth of the budget, and is
/// repeated after ten ticks.
///
/// Cost: each new plan costs the budget or a tenth of it. No calls are made between new plans. A search uses up to a
/// gibibyte of memory.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Systematic {
    streams: Streams,
    /// The rest of the plan, last action first.
    plan: Vec<Action>,
    /// The minimum number of ticks between an unsuccessful search and the next search.
    pause: usize,
    #[serde(skip)]
    analysis: Option<Analysis>,
}

impl Systematic {
    /// Creates a player with its own random-number streams for choices and imagined outcomes.
    pub fn new(seed: Seed) -> Systematic {
        Systematic { streams: Streams::new(seed), plan: Vec::new(), pause: AHEAD, analysis: None }
    }
}

impl Planner for Systematic {
    fn plan(&mut self, game: &Game, state: &State, Budget(calls): Budget) -> (Action, u64) {
        let mut decision = self.streams.next();
        if let Some(action) = self.plan.pop() {
            return (action, 0);
        }
        let analysis = self.analysis.take().unwrap_or_else(|| Analysis::of(game));
        let is_certain = analysis.is_deterministic_from(state);
        let calls = if is_certain { calls } else { calls / AHEAD as u64 };
        let mut start = state.clone();
        decision.fork_with_random_future(&mut start, state);
        // Push bounds are computed from the level, which a player does not see.
        let searched = best_first(&analysis, &Pushes::default(), &start, SearchLimits::calls(calls));
        let (mut plan, least) = match searched.answer {
            Answer::Won { actions, .. } => (actions, 0),
            Answer::Impossible | Answer::OutOfCalls | Answer::OutOfMemory => (searched.nearest, self.pause),
        };
        if !is_certain {
            plan.truncate(AHEAD);
        } else if least > 0 {
            self.pause *= 2;
        }
        let (keys, rest) = (game.actions(state), least.saturating_sub(plan.len()));
        plan.extend((0..rest).map(|_| *decision.choices.choose(keys)));
        plan.reverse();
        self.plan = plan;
        self.analysis = Some(analysis);
        (self.plan.pop().unwrap_or(Action::Nil), searched.calls)
    }
}
