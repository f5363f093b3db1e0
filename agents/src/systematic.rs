//! Systematic search as a player.

use crate::planner::{Budget, Planner, Streams};
use crate::search::{Answer, Pushes, SearchLimits, best_first};
use engine::analysis::Analysis;
use engine::{Action, Game, Seed, State};
use serde::{Deserialize, Serialize};

/// The length of a plan in a stochastic game, and of the first one without a win elsewhere, in ticks.
const AHEAD: usize = 10;

/// A player that searches for a win to its end with [`best_first`], and plays what it finds without another look. Without a win
/// within the budget it plays towards the states from which the fewest sprites must still go or come, and then random keys.
///
/// Without chance a plan that wins is right, whatever its length; after one that does not it looks again, the first time in ten
/// ticks, then each time in twice as many. A stochastic game it searches as if one imagined future were the only one, with a tenth of
/// the budget, and it looks again after ten ticks.
///
/// Cost: the budget for each new plan, or a tenth of it, and a gibibyte at most; no calls in between.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Systematic {
    streams: Streams,
    /// The rest of the plan, the last action first.
    plan: Vec<Action>,
    /// The ticks until another look, after the next search in vain.
    pause: usize,
    #[serde(skip)]
    analysis: Option<Analysis>,
}

impl Systematic {
    /// Creates a player with its own random streams for choices and imagined outcomes.
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
        // The pushes that a level needs follow from the level, which a player does not see.
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

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Outcome;

    const GAME: &str = "BasicGame
    SpriteSet
        floor > Immovable
        wall > Immovable
        hole > Immovable
        box > Passive
        avatar > MovingAvatar
    LevelMapping
        . > floor
        w > wall
        o > hole
        b > box
        A > avatar
    InteractionSet
        avatar wall > stepBack
        box avatar > bounceForward
        box wall > undoAll
        box box > undoAll
        box hole > killSprite
    TerminationSet
        SpriteCounter stype=box limit=0 win=True
";
    /// The far box goes first, from between the two: the way there is round the corner.
    const LEVEL: &str = "wwwwwwww\nw.....ow\nw.w.wwww\nwAb..bow\nwwwwwwww\n";

    fn played(calls: u64) -> (Outcome, Vec<u64>) {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(LEVEL).unwrap();
        let mut player = Systematic::new(Seed::from_text("systematic"));
        let mut state = game.start(&level, Seed::from_text("boxes"));
        let mut spent = Vec::new();
        while !state.is_over() && spent.len() < 100 {
            let (action, calls) = player.plan(&game, &state, Budget(calls));
            game.step(&mut state, action);
            spent.push(calls);
        }
        (state.outcome(), spent)
    }

    /// One search wins, and its plan is played without another.
    #[test]
    fn a_win_that_is_found_is_played() {
        let (outcome, spent) = played(5000);
        assert_eq!(outcome, Outcome::Won);
        assert!(spent[0] > 0 && spent[1..].iter().all(|calls| *calls == 0), "{spent:?}");
    }

    /// Without a win in sight, plans are short and the search goes on.
    #[test]
    fn small_budgets_are_kept() {
        let (_, spent) = played(20);
        assert!(spent.iter().filter(|calls| **calls > 0).count() > 1, "{spent:?}");
        assert!(spent.iter().all(|calls| *calls <= 30), "{spent:?}");
    }

    #[test]
    fn no_budget_is_played_at_random() {
        let (_, spent) = played(0);
        assert!(!spent.is_empty() && spent.iter().all(|calls| *calls == 0), "{spent:?}");
    }
}
