//! Regret: the price of sensible choices that differ from the winner's.

use agents::{Budget, Olets, OletsConfig, OneStep, OneStepConfig, Planner};
use base::Seed;
use engine::{Action, Chance, Episode, Game, Level, Outcome, State};
use serde::{Deserialize, Serialize};

/// The maximum number of moments of an episode at which policies choose, evenly spread.
const MOMENTS: usize = 8;
/// The number of ticks that a policy plays before the same player continues for all policies.
const TURN: usize = 6;
/// The number of random futures by which the safe policy judges an action, and their length in ticks.
const SAFETY: (u64, usize) = (4, 10);
/// The number of forward-model calls per decision of the player that continues, and the maximum number of ticks that it
/// plays.
const COMPETENT: (Budget, usize) = (Budget(50), 160);

/// The regret on the way to a win: how often sensible policies choose differently from the winner, and the cost of
/// doing so.
///
/// The *fast* policy plays the winner's actions, the *greedy* one the action with the best next tick, and the *safe*
/// one the action after which most careless futures survive. Each policy plays six ticks from the moment, then the same
/// competent player continues. A game without a dilemma is won even without the winner's foresight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Regret {
    /// The fraction of moments at which the policies do not all choose the same action, from 0 to 1.
    pub split: f64,
    /// The fraction of moments at which the winner's choice still leads to a win and that of another policy does not,
    /// from 0 to 1.
    pub cost: f64,
}

impl Regret {
    /// Measures a won episode. The same arguments give the same numbers on every machine. Cost: 24 episodes from
    /// moments of the given episode, at most 200,000 forward-model calls.
    pub fn of(game: &Game, level: &Level, won: &Episode, seed: Seed) -> Regret {
        let step = won.actions.len().div_ceil(MOMENTS).max(1);
        let (mut at_moments, mut split, mut cost) = (0, 0, 0);
        let (_, mut state) = Episode::begin(game, level, won.seed);
        for (tick, &action) in won.actions.iter().enumerate() {
            if state.is_over() {
                break;
            }
            if tick % step == step / 2 {
                at_moments += 1;
                let moment = Moment { game, state: &state, seed: seed.child("moment", tick as u64) };
                let (greedy, safe) = (moment.greedy(), moment.safe());
                if greedy != action || safe != action {
                    split += 1;
                    let wins = |policy: &dyn Fn(&Moment<'_>, usize) -> Action| moment.wins(policy);
                    let winner = |_: &Moment<'_>, ahead: usize| {
                        won.actions.get(tick + ahead).copied().unwrap_or(Action::Nil)
                    };
                    let loses = || !wins(&|at, _| at.greedy()) || !wins(&|at, _| at.safe());
                    cost += usize::from(wins(&winner) && loses());
                }
            }
            game.step(&mut state, action);
        }
        let share = |count: usize| count as f64 / at_moments.max(1) as f64;
        Regret { split: share(split), cost: share(cost) }
    }

    /// Returns the strength, from 0 to 1: a cost at a third of the moments gives 1.
    pub fn strength(self) -> f64 {
        (3.0 * self.cost).min(1.0)
    }
}

/// A state in which policies choose.
struct Moment<'a> {
    game: &'a Game,
    state: &'a State,
    seed: Seed,
}

impl Moment<'_> {
    fn greedy(&self) -> Action {
        let mut player = OneStep::new(OneStepConfig::default(), self.seed.child("greedy", 0));
        player.plan(self.game, self.state, Budget(0)).0
    }

    /// Returns the action that survives in most random futures; among equals, the first one.
    fn safe(&self) -> Action {
        let survives = |action: Action| {
            let survives = |future: &u64| {
                let seed = self.seed.child("safe", *future);
                let (mut state, mut sampler) = (self.state.clone(), seed.sampler());
                state.fork_from(self.state, Chance::from_java(sampler.bits() as i64));
                self.game.step(&mut state, action);
                for _ in 1..SAFETY.1 {
                    let actions = self.game.actions(&state);
                    if state.is_over() || actions.is_empty() {
                        break;
                    }
                    self.game.step(&mut state, actions[sampler.below(actions.len())]);
                }
                state.outcome() != Outcome::Lost
            };
            (0..SAFETY.0).filter(survives).count()
        };
        let actions = self.game.actions(self.state);
        let best = actions.iter().copied().rev().max_by_key(|&action| survives(action));
        best.unwrap_or(Action::Nil)
    }

    /// Returns `true` if the competent player wins after a turn of the policy.
    fn wins(&self, policy: &dyn Fn(&Moment<'_>, usize) -> Action) -> bool {
        let mut state = self.state.clone();
        for ahead in 0..TURN {
            if state.is_over() {
                break;
            }
            let seed = self.seed.child("turn", ahead as u64);
            let action = policy(&Moment { game: self.game, state: &state, seed }, ahead);
            self.game.step(&mut state, action);
        }
        let mut player = Olets::new(OletsConfig::default(), self.seed.child("competent", 0));
        for _ in 0..COMPETENT.1 {
            if state.is_over() {
                break;
            }
            let (action, _) = player.plan(self.game, &state, COMPETENT.0);
            self.game.step(&mut state, action);
        }
        state.outcome() == Outcome::Won
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Measures the regret in a game with a gem that is worth points and, with the trap, closes the way out for good.
    fn regret(trap: &str) -> Regret {
        let source = format!(
            "BasicGame\n    SpriteSet\n        floor > Immovable\n        gem > Immovable\n        out > Immovable\n        shut > Immovable\n        \
             open > Immovable\n        hero > MovingAvatar\n    LevelMapping\n        . > floor\n        g > floor gem\n        o > floor out\n        A > floor hero\n    \
             InteractionSet\n        hero wall > stepBack\n        gem hero > killSprite scoreChange=5\n{trap}        \
             out hero > transformTo stype=open\n    TerminationSet\n        SpriteCounterMore stype=open limit=1 \
             win=True\n        Timeout limit=60 win=False\n"
        );
        let game = Game::from_source(&source).unwrap();
        let level =
            game.level("wwwwwwwwww\nw........w\nw.A......w\nw.g......w\nw.......ow\nwwwwwwwwww\n").unwrap();
        let seed = Seed::from_text("regret");
        let (mut episode, mut state) = Episode::begin(&game, &level, seed);
        let way = [[Action::Right; 6].as_slice(), &[Action::Down; 2]].concat();
        for action in way {
            episode.play(&game, &mut state, action);
        }
        assert_eq!(episode.outcome, Outcome::Won);
        Regret::of(&game, &level, &episode, seed)
    }

    #[test]
    fn greed_that_loses_is_regretted() {
        let plain = regret("");
        let trapped = regret("        hero gem > transformToAll stype=out stypeTo=shut\n");
        assert_eq!(plain.cost, 0.0, "{plain:?}");
        assert!(trapped.cost > 0.0, "{trapped:?}");
    }
}
