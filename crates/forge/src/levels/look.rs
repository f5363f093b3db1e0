//! A quick evaluation of a candidate for a search.

use super::aim::{Aim, Told};
use super::order::LevelOrder;
use crate::tally::Tally;
use agents::{PortfolioConfig, Solution, Solved, solve};
use base::{Seed, SeedPath};
use engine::{Analysis, Episode, Game, Level, Outcome};
use generators::Evaluation;
use validators::{
    Case, Criteria, Criterion, Finding, NoEarlyDeath, NotIdle, NotRandom, Validator, Verdict, WellFormed,
};

/// The number of idle episodes in stochastic games.
const IDLE_PLAYS: u32 = 2;
/// The number of episodes of random play.
const RANDOM_PLAYS: u32 = 24;
/// The number of additional random episodes after a win in the first [`RANDOM_PLAYS`]. They correct for the selection
/// of lucky levels.
const MORE_RANDOM_PLAYS: u32 = 48;
/// The maximum fraction of random episodes that may win: one of the first [`RANDOM_PLAYS`]. The panel plays with
/// different seeds and is stricter.
const RANDOM_WINS: f64 = 0.05;
/// The number of random futures that are tried to test whether the player can survive the first ticks of a stochastic
/// game.
const CHANCES: u32 = 4;
/// The number by which a quick evaluation's call budget is divided to get the budget for each random future.
const EARLY: u64 = 50;

/// Evaluates candidates for one request for levels cheaply, with few episodes and a small budget. The panel must still
/// accept the candidates that pass.
pub(super) struct Looker<'a> {
    game: &'a Game,
    analysis: &'a Analysis,
    order: &'a LevelOrder,
    aim: Aim<'a>,
    seed: Seed,
}

/// The result of a quick evaluation.
#[derive(Clone, Debug)]
pub(super) struct Look {
    /// The candidate's evaluation, as the search receives it.
    pub(super) evaluation: Evaluation,
    /// The name of the first unmet constraint; `None` if all are met.
    pub(super) obstacle: Option<&'static str>,
    /// `true` if a win is known, along with its measures.
    pub(super) is_won: bool,
    /// The number of forward-model calls.
    pub(super) calls: u64,
    /// The effort, as a number of quick evaluations of typical cost. Without a win search, the effort is
    /// [`LEAST_EFFORT`]. Otherwise, each [`super::Effort::calls`] calls of the win search count as one evaluation, with
    /// a minimum of one.
    pub(super) effort: f64,
}

impl Look {
    /// Adds the result of the quick evaluation to the counts.
    pub(super) fn count(&self, tally: &mut Tally) {
        tally.look(self.obstacle.is_none(), self.calls);
        self.obstacle.into_iter().for_each(|obstacle| tally.reject(obstacle));
    }
}

/// The effort of a quick evaluation that ends with the first, cheap judges.
pub(super) const LEAST_EFFORT: f64 = 1.0 / 8.0;

/// The cost of a quick evaluation so far.
#[derive(Default)]
struct Spent {
    /// The number of forward-model calls.
    calls: u64,
    /// The number of calls in the win search; `None` if no win search was run.
    searched: Option<u64>,
}

impl Spent {
    fn effort(&self, usual: u64) -> f64 {
        self.searched.map_or(LEAST_EFFORT, |calls| (calls as f64 / usual.max(1) as f64).max(1.0))
    }
}

/// The factor by which the win rate of random play lowers the objective. One win in 24 episodes lowers it by a third.
const LUCK: f64 = 8.0;
/// The number of calls per episode tick. It suffices for a few decisions by several players.
const TICK: u64 = 500;
/// The maximum number of calls in a win search, as a multiple of the order's calls per search.
const MOST: u64 = 4;

/// Constraints, each with the degree to which it is met, from 0.0 to 1.0.
struct Constraints {
    values: [f64; CONSTRAINTS],
    met: usize,
}

const CONSTRAINTS: usize = NAMES.len();
/// The names of the constraints. The last constraint is the order's requirement for the win.
const NAMES: [&str; 6] = [
    Criterion::WellFormed.name(),
    Criterion::NotIdle.name(),
    Criterion::NotRandom.name(),
    Criterion::EarlyDeath.name(),
    Criterion::Winnable.name(),
    "the win asked for",
];

impl Constraints {
    /// Records the next constraint. Returns `true` if it is met.
    fn note(&mut self, value: f64) -> bool {
        self.values[self.met] = value;
        self.met += 1;
        value >= 1.0
    }

    /// Returns the name of the first unmet constraint; `None` if all constraints are met.
    fn obstacle(&self) -> Option<&'static str> {
        self.values.iter().position(|&value| value < 1.0).map(|at| NAMES[at])
    }

    /// Returns the mean of the constraints: 1.0 only if all of them are met.
    fn feasibility(&self) -> f64 {
        if self.values.iter().all(|&value| value >= 1.0) {
            return 1.0;
        }
        (self.values.iter().sum::<f64>() / CONSTRAINTS as f64).min(0.999)
    }
}

impl<'a> Looker<'a> {
    pub(super) fn new(analysis: &'a Analysis, order: &'a LevelOrder, aim: Aim<'a>, seed: Seed) -> Looker<'a> {
        Looker { game: analysis.game(), analysis, order, aim, seed }
    }

    /// Evaluates a level quickly. The same level always gets the same result. Cost: a few hundred random episodes,
    /// [`super::Effort::calls`] forward-model calls, and the calls of the ladder's reference players if a difficulty is
    /// requested.
    pub(super) fn look(&self, level: &Level) -> Look {
        let seed = self.seed.child(&level.digest().to_string(), 0);
        let mut constraints = Constraints { values: [0.0; CONSTRAINTS], met: 0 };
        let mut spent = Spent::default();
        let won = self.constrain(level, seed, &mut constraints, &mut spent);
        // Even a single win by random play counts against a level.
        let told = won.map(|(witness, luck)| {
            let told = self.aim.tell(self.case(level, &seed.into(), Some(&witness)));
            Told { objective: told.objective * (1.0 - LUCK * luck), ..told }
        });
        let measures = self.aim.measures(level, told.as_ref().map(|told| &told.measures));
        let is_won = told.is_some();
        let objective = told.map_or(0.0, |told| {
            spent.calls += told.calls;
            constraints.note(told.constraint);
            told.objective
        });
        let evaluation = Evaluation { feasibility: constraints.feasibility(), objective, measures };
        let effort = spent.effort(self.order.effort.calls);
        Look { evaluation, obstacle: constraints.obstacle(), is_won, calls: spent.calls, effort }
    }

    /// Runs the cheap judges, one after the other. If all of them pass, returns a win and the fraction of random
    /// episodes that won.
    fn constrain(
        &self,
        level: &Level,
        seed: Seed,
        constraints: &mut Constraints,
        spent: &mut Spent,
    ) -> Option<(Episode, f64)> {
        let criteria = &self.order.criteria;
        let ask = |criterion: Criterion, validator: &dyn Validator, time: u64, spent: &mut Spent| {
            let seed = seed.child(criterion.name(), time).into();
            let finding = validator.validate(self.case(level, &seed, None));
            spent.calls += finding.calls();
            finding
        };
        let sound = passes(&ask(Criterion::WellFormed, &WellFormed, 0, spent));
        let can_win = self.analysis.reach(level).can_win();
        if !constraints.note(if can_win { sound } else { sound / 2.0 }) {
            return None;
        }
        // If a level can be won without skill, a win with skill does not make the level better.
        let idle = ask(Criterion::NotIdle, &NotIdle { plays: IDLE_PLAYS, ticks: usize::MAX }, 0, spent);
        let random_play = |plays, most| NotRandom { plays, most, ticks: usize::MAX };
        let random = ask(Criterion::NotRandom, &random_play(RANDOM_PLAYS, RANDOM_WINS), 0, spent);
        let mut luck = win_share(&random);
        if random.verdict.is_pass() && luck > 0.0 {
            let more = ask(Criterion::NotRandom, &random_play(MORE_RANDOM_PLAYS, 1.0), 1, spent);
            let [first, more_plays] = [RANDOM_PLAYS, MORE_RANDOM_PLAYS].map(f64::from);
            luck = (luck * first + win_share(&more) * more_plays) / (first + more_plays);
        }
        let met = constraints.note(1.0 - win_share(&idle));
        let met = constraints.note(if luck <= RANDOM_WINS { 1.0 } else { 1.0 - luck }) && met;
        if !met {
            return None;
        }
        let early = NoEarlyDeath {
            ticks: criteria.early_ticks,
            calls: self.order.effort.calls / EARLY,
            seeds: CHANCES,
            share: criteria.early_deaths,
        };
        if !constraints.note(passes(&ask(Criterion::EarlyDeath, &early, 0, spent))) {
            return None;
        }
        let budget = self.budget(&random);
        let solved = self.solve(level, budget, seed.child(Criterion::Winnable.name(), 0), criteria);
        spent.calls += solved.calls;
        spent.searched = Some(solved.calls);
        match solved.solution {
            Solution::Won { episode, .. } => {
                constraints.note(1.0);
                Some((*episode, luck))
            }
            Solution::Impossible { .. } => None,
            Solution::Unknown => {
                constraints.note(0.5 * self.nearness(level, &solved));
                None
            }
        }
    }

    fn case<'b>(&'b self, level: &'b Level, seed: &'b SeedPath, witness: Option<&'b Episode>) -> Case<'b> {
        Case { game: self.game, level, seed, analysis: self.analysis, witness }
    }

    /// Returns the number of forward-model calls for a win search. Long episodes get more calls, because each tick
    /// requires a decision.
    fn budget(&self, random: &Finding) -> u64 {
        let calls = self.order.effort.calls;
        let longest = random.episodes.iter().map(|episode| episode.actions.len()).max().unwrap_or_default();
        (longest as u64 * TICK).clamp(calls, MOST * calls)
    }

    fn solve(&self, level: &Level, budget: u64, seed: Seed, criteria: &Criteria) -> Solved {
        let config = PortfolioConfig {
            budget,
            shortest: 0.3,
            decision: criteria.decision,
            depths: criteria.depths.clone(),
            ..PortfolioConfig::default()
        };
        solve(self.analysis, level, &config, seed)
    }

    /// Returns the best episode's progress towards a win, from 0.0 (none) to 1.0.
    fn nearness(&self, level: &Level, solved: &Solved) -> f64 {
        let wins: Vec<_> = self.analysis.goals().iter().filter(|goal| goal.win).collect();
        let missing =
            |state: &engine::State| wins.iter().map(|goal| self.analysis.missing(goal, state)).min();
        let plays = solved.plays.iter().filter(|play| play.episode.outcome != Outcome::Lost);
        let near = plays.filter_map(|play| {
            let start = missing(&self.game.start(level, play.episode.seed))?;
            let end = missing(&play.episode.replay(self.game, level).ok()?)?;
            Some(1.0 - f64::from(end) / f64::from(start.max(1)))
        });
        near.fold(0.0, f64::max).clamp(0.0, 1.0)
    }
}

fn passes(finding: &Finding) -> f64 {
    match finding.verdict {
        Verdict::Pass { .. } => 1.0,
        // An unknown verdict counts as a pass in a quick evaluation, because the panel makes the decision.
        Verdict::Unknown { .. } => 1.0,
        Verdict::Fail { .. } => 0.0,
    }
}

fn win_share(finding: &Finding) -> f64 {
    finding.measured.as_ref().map_or(0.0, |rate| rate.wins as f64 / rate.plays.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::Method;
    use generators::levels::LevelConfig;

    /// The goal is next to the avatar, or at the end of a path between pits.
    const NEAR: &str = "wwwww\nwAg w\nwwwww\n";
    const FAR: &str = "wwwwwwwwwwww\nwppppppppppw\nwA        gw\nwppppppppppw\nwwwwwwwwwwww\n";

    fn look(level: &str) -> Look {
        let game = Game::from_source(
            "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    pit > Immovable\n    avatar > \
             MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    \
             avatar pit > killSprite\n    goal avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=goal \
             win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=60 win=False\n",
        )
        .unwrap();
        let analysis = Analysis::of(&game);
        let order = LevelOrder::new(Method::Evolutionary, 1, LevelConfig::default());
        let looker = Looker::new(
            &analysis,
            &order,
            Aim::new(&analysis, &order, &order.checked_criteria().unwrap()),
            Seed::from_text("look"),
        );
        looker.look(&game.level(level).unwrap())
    }

    #[test]
    fn what_random_keys_win_costs_little_and_counts_little() {
        let near = look(NEAR);
        assert_eq!(
            (near.obstacle, near.is_won, near.effort),
            (Some(Criterion::NotRandom.name()), false, LEAST_EFFORT)
        );
        let far = look(FAR);
        assert_eq!((far.obstacle, far.is_won, far.effort), (None, true, 1.0));
        assert!(far.evaluation.is_feasible() && far.calls > near.calls);
    }

    #[test]
    fn a_long_search_for_a_win_counts_for_several_looks() {
        let effort = |searched| Spent { calls: 500_000, searched }.effort(100_000);
        assert_eq!([None, Some(20_000), Some(250_000)].map(effort), [LEAST_EFFORT, 1.0, 2.5]);
    }
}
