//! The judge in a board search. It checks the constraints, cheapest first, and then measures the quality of the board.

use super::deviations::{Deviation, costs};
use super::likeness::are_one_board;
use super::necessity::Ablations;
use super::order::{BoardBudget, BoardMeasures, BoardOrder};
use super::replay::{Events, events, is_guard};
use super::shortest::{Limits, shortest_win};
use agents::search::{Answer, Pushes, SearchLimits, best_first};
use base::Seed;
use engine::{Action, Analysis, Episode, Level, Outcome};
use generators::Evaluation;
use generators::boards::BoardVariation;
use std::collections::BTreeSet;
use std::slice;
use validators::{Criterion, CriterionSet, Gates, Judging, NotInstant, Panel, Report};

/// The number of ticks that an idle player must survive.
const GRACE: usize = 10;
/// The number of ticks within which an idle player must not win.
const IDLE: usize = 200;
/// The number of episodes with random actions.
const RANDOM_PLAYS: u64 = 24;
/// The maximum number of episodes with random actions that may win.
const LUCKY: u64 = 1;
/// The length of an episode with random actions, in ticks.
const RANDOM_TICKS: usize = 400;
/// The number of ticks that a win search allows beyond the longest win requested.
const BEYOND: usize = 20;
/// The minimum and maximum fraction of deviations that should have a cost.
pub(super) const TRAPS: (f64, f64) = (0.3, 0.8);
/// The desired fraction of fatal deviations. Some deviations must be fatal because players do not notice that they have
/// reached a mere dead end.
const DEATHS: f64 = 0.15;
/// The fraction of a win at which a wrong choice should still have a cost. Otherwise, the rest of the win is free of
/// risk.
const LAST: f64 = 0.7;
/// The number of cells that a self-moving sprite should sweep.
const SWEEP: f64 = 5.0;
/// The maximum fraction of the board that may be one empty rectangle.
const EMPTY: f64 = 0.25;
/// The maximum fraction of a win that may pass without an event.
const DEAD: f64 = 0.4;
/// The weight of deviations in the quality.
const TRAPS_WEIGHT: f64 = 0.24;
/// The weight of the last costly deviation in the quality.
const LAST_WEIGHT: f64 = 0.10;
/// The maximum difference in quality from the best board at which a board is still examined closely.
const MARGIN: f64 = 0.05;
/// The number of alternative random futures in which a win is replayed to test whether it still wins.
const FUTURES: u64 = 6;
/// The number of constraints checked before the win search.
const SEARCHED: f64 = 3.0;
/// The fraction of its quality that a board loses if it fails every gate.
const GATES_WEIGHT: f64 = 0.3;
/// The number of constraints.
const CONSTRAINTS: f64 = 10.0;
/// The maximum fraction of supplies that a win may leave in place. Supplies are resources to collect and sprites to
/// push. One unused supply is always allowed.
const SPARE: f64 = 0.25;

/// The judge in a board search.
#[derive(Clone)]
pub(super) struct Judge<'a> {
    pub(super) analysis: &'a Analysis,
    pub(super) order: &'a BoardOrder,
    pub(super) budget: &'a BoardBudget,
    pub(super) variation: &'a BoardVariation<'a>,
    pub(super) ablations: &'a Ablations,
    /// The judges of those gates (criteria for whole games) that can be applied to a single board; `None` if no gates
    /// were requested.
    pub(super) panel: Option<Panel>,
    pub(super) seed: Seed,
}

/// The judge's verdict on one board.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    pub(super) evaluation: Evaluation,
    pub(super) calls: u64,
    /// `true` if a win search was run.
    pub(super) is_searched: bool,
    /// The win of a feasible board, with its measures; `None` for an infeasible board.
    pub(super) won: Option<(Episode, BoardMeasures)>,
}

impl Judged {
    /// Returns the judgement on an infeasible board, given the number of constraints that it meets and the degree to
    /// which it meets the next one.
    fn failed(met: f64, degree: f64, calls: u64) -> Judged {
        let feasibility = ((met + degree.clamp(0.0, 1.0)) / CONSTRAINTS).min(0.999);
        Judged {
            evaluation: Evaluation { feasibility, objective: 0.0, measures: Vec::new() },
            calls,
            is_searched: met >= SEARCHED,
            won: None,
        }
    }
}

impl Judge<'_> {
    /// Judges a board. Skips the deviations if the board is clearly worse than the best so far, because the cost of its
    /// deviations could hardly make it the best board. Skipped deviations count as having no cost.
    pub(super) fn judge(&self, level: &Level, best: f64) -> Judged {
        if self.order.unlike.iter().any(|other| are_one_board(level, other)) {
            return Judged::failed(0.0, 0.0, 0);
        }
        let mut calls = 0;
        if let Some(degree) = self.idle_fault(level, &mut calls) {
            return Judged::failed(1.0, degree, calls);
        }
        let lucky = self.lucky_plays(level, &mut calls);
        if lucky > LUCKY {
            return Judged::failed(2.0, 1.0 - lucky as f64 / RANDOM_PLAYS as f64, calls);
        }
        let is_first = self.order.brief.demand == 0;
        let instant = NotInstant(Gates::default());
        let game = self.analysis.game();
        if !is_first && instant.is_walked_through(game, level, self.order.ticks.1, self.seed) {
            return Judged::failed(3.0, 0.0, calls);
        }
        let (win, is_shortest) = match self.win(level, &mut calls) {
            Ok(found) => found,
            Err(degree) => return Judged::failed(4.0, degree, calls),
        };
        let (low, high) = self.order.ticks;
        let ticks = win.actions.len();
        if ticks < low || ticks > high {
            let degree = if ticks < low { ticks as f64 / low as f64 } else { high as f64 / ticks as f64 };
            return Judged::failed(5.0, degree, calls);
        }
        if !is_first && instant.is_too_short(self.analysis, level, &win) {
            return Judged::failed(6.0, 0.0, calls);
        }
        let events = events(self.analysis, level, &win);
        if !self.order.mechanics.is_empty() && events.handled < 1.0 {
            return Judged::failed(7.0, events.handled, calls);
        }
        let most_spare = (events.supplies as f64 * SPARE).max(1.0);
        if !self.order.mechanics.is_empty() && events.spare as f64 > most_spare {
            return Judged::failed(8.0, most_spare / events.spare as f64, calls);
        }
        // The mechanics matter most, so the other interactions are tried only after the mechanics.
        let ordered: BTreeSet<usize> = self.order.mechanics.iter().flatten().copied().collect();
        // Guards leave no events in a win, so only a search without them can show whether they are needed.
        let is_tried = |line: &usize| events.firsts.contains(line) || is_guard(self.analysis, *line);
        let tried = ordered.iter().copied().filter(is_tried);
        let (mut needed, spent) = self.ablations.needed(tried, level, &win, self.budget.small_calls);
        calls += spent;
        let (matter, spent) =
            self.ablations.matter(self.analysis, &needed, level, &win, self.budget.small_calls);
        calls += spent;
        let idle = matter.iter().filter(|matters| !**matters).count();
        if idle > self.order.idle {
            return Judged::failed(9.0, 1.0 - (idle - self.order.idle) as f64 / matter.len() as f64, calls);
        }
        let others = events.firsts.iter().copied().filter(|line| !ordered.contains(line));
        let (others, spent) = self.ablations.needed(others, level, &win, self.budget.small_calls);
        needed.extend(others);
        calls += spent;
        let known = BoardMeasures { is_shortest, needed, ..BoardMeasures::default() };
        let measures = self.measure(level, &win, (known, events), best, &mut calls);
        let evaluation = Evaluation { feasibility: 1.0, objective: measures.quality, measures: Vec::new() };
        Judged { evaluation, calls, is_searched: true, won: Some((win, measures)) }
    }

    /// Returns `None` if an idle player does not win, and does not lose in the first ticks. Otherwise, returns how
    /// close the level comes to meeting this condition, from 0 to 0.5.
    fn idle_fault(&self, level: &Level, calls: &mut u64) -> Option<f64> {
        let game = self.analysis.game();
        let mut state = game.start(level, self.seed);
        for tick in 0..IDLE {
            *calls += 1;
            match game.step(&mut state, Action::Nil) {
                Outcome::Ongoing => {}
                Outcome::Won => return Some(0.5),
                _ if tick < GRACE => return Some(tick as f64 / (2 * GRACE) as f64),
                _ => return None,
            }
        }
        None
    }

    /// Counts the random episodes that win. Stops at the first win over the limit.
    fn lucky_plays(&self, level: &Level, calls: &mut u64) -> u64 {
        let game = self.analysis.game();
        let mut wins = 0;
        for number in 0..RANDOM_PLAYS {
            let seed = self.seed.child("random play", number);
            let mut state = game.start(level, seed);
            let mut sampler = seed.child("actions", 0).sampler();
            for _ in 0..RANDOM_TICKS {
                *calls += 1;
                let action = *sampler.choose(game.actions(&state));
                match game.step(&mut state, action) {
                    Outcome::Ongoing => {}
                    Outcome::Won => {
                        wins += 1;
                        break;
                    }
                    _ => break,
                }
            }
            if wins > LUCKY {
                break;
            }
        }
        wins
    }

    /// Searches for a shortest win or, if that fails, for any win. If no win is found, returns how close the search
    /// came.
    fn win(&self, level: &Level, calls: &mut u64) -> Result<(Episode, bool), f64> {
        let game = self.analysis.game();
        let start = game.start(level, self.seed);
        let limits = Limits { calls: self.budget.calls, ticks: self.order.ticks.1 + BEYOND };
        let found = shortest_win(self.analysis, &start, limits);
        *calls += found.calls;
        let (actions, is_shortest) = match found.win {
            Some(actions) => (actions, found.is_proved),
            None if found.is_proved || !self.analysis.is_deterministic_from(&start) => {
                return Err(self.nearness(level, found.missing));
            }
            None => {
                let limits = SearchLimits::calls(self.budget.calls / 2);
                let any = best_first(self.analysis, &Pushes::default(), &start, limits);
                *calls += any.calls;
                let Answer::Won { actions, .. } = any.answer else {
                    return Err(self.nearness(level, found.missing));
                };
                (actions, false)
            }
        };
        let (mut episode, mut state) = Episode::begin(game, level, self.seed);
        for action in actions {
            episode.play(game, &mut state, action);
        }
        match episode.outcome {
            Outcome::Won => Ok((episode, is_shortest)),
            _ => Err(0.0),
        }
    }

    /// Returns the fraction of a win's requirements that the best state of a search meets.
    fn nearness(&self, level: &Level, missing: u32) -> f64 {
        let start = self.analysis.game().start(level, self.seed);
        let goals = self.analysis.goals().iter().filter(|goal| goal.win);
        let all = goals.map(|goal| self.analysis.missing(goal, &start)).min().unwrap_or(0);
        (1.0 - f64::from(missing) / f64::from(all.max(1))).clamp(0.0, 1.0)
    }

    fn measure(
        &self,
        level: &Level,
        win: &Episode,
        (known, events): (BoardMeasures, Events),
        best: f64,
        calls: &mut u64,
    ) -> BoardMeasures {
        let mut measures = BoardMeasures {
            ticks: win.actions.len(),
            steady: self.steady(level, &win.actions),
            used: events.used,
            dead: events.dead,
            sweep: events.sweep,
            is_new: !events.firsts.is_empty() && !self.order.known.contains(&events.firsts),
            emptiness: self.variation.emptiness(level),
            firsts: events.firsts,
            gates: 1.0,
            ..known
        };
        measures.quality = quality(&measures);
        if measures.quality + TRAPS_WEIGHT + LAST_WEIGHT + MARGIN < best {
            measures.gates = 0.0;
            return measures;
        }
        let limits = Limits { calls: self.budget.small_calls, ticks: self.order.ticks.1 + BEYOND };
        let game = self.analysis.game();
        let deviations = Deviation::draw(game, level, &win.actions, self.seed, self.budget.deviations);
        let costs = costs(&deviations, self.analysis, level, &win.actions, self.seed, limits);
        *calls += costs.calls;
        (measures.traps, measures.deaths, measures.last) = (costs.traps, costs.deaths, costs.last);
        measures.gates = self.gates(level, win);
        measures.quality = quality(&measures);
        measures
    }
}

impl Judge<'_> {
    /// Returns the fraction of the single-board gates that the board meets.
    fn gates(&self, level: &Level, win: &Episode) -> f64 {
        let Some(panel) = &self.panel else { return 1.0 };
        let report = Report { judgements: Vec::new(), witness: Some(win.clone()) };
        let (boards, reports) = (slice::from_ref(level), slice::from_ref(&report));
        let seed = self.seed.child("gates", 0);
        let judged = panel.judge(Judging::together(self.analysis.game(), boards, reports, seed));
        let met = judged.iter().filter(|judgement| judgement.finding.verdict.is_pass()).count();
        if judged.is_empty() { 1.0 } else { met as f64 / judged.len() as f64 }
    }

    /// Returns the fraction of alternative random futures in which the same actions win.
    fn steady(&self, level: &Level, win: &[Action]) -> f64 {
        let game = self.analysis.game();
        let wins = (0..FUTURES).filter(|&future| {
            let mut state = game.start(level, self.seed.child("future", future));
            win.iter().any(|&action| game.step(&mut state, action) == Outcome::Won)
        });
        wins.count() as f64 / FUTURES as f64
    }
}

/// The gates (criteria for whole games) that can be applied to a single board.
pub(super) const ALONE: CriterionSet =
    CriterionSet::of(&[Criterion::Drama, Criterion::NoDeadTime, Criterion::ActorsMatter, Criterion::Tight]);

/// Returns the quality of a won board. Costly wrong choices weigh most, followed by the measured necessity of the
/// rules. Unmet gates lower the total.
fn quality(measures: &BoardMeasures) -> f64 {
    let (low, high) = TRAPS;
    let traps = match measures.traps {
        traps if traps < low => traps / low,
        traps if traps > high => (1.0 - traps) / (1.0 - high),
        _ => 1.0,
    };
    let lively = if measures.dead <= DEAD { 1.0 } else { (1.0 - measures.dead) / (1.0 - DEAD) };
    let sweep = measures.sweep.map_or(1.0, |sweep| (sweep / SWEEP).min(1.0));
    let form = 1.0 - ((measures.emptiness - EMPTY) / EMPTY).clamp(0.0, 1.0);
    let own = 0.20 * measures.necessity()
        + 0.10 * (measures.deaths / DEATHS).min(1.0)
        + TRAPS_WEIGHT * traps
        + LAST_WEIGHT * (measures.last / LAST).min(1.0)
        + 0.07 * form
        + 0.08 * measures.used
        + 0.05 * lively
        + 0.06 * sweep
        + 0.06 * f64::from(u8::from(measures.is_new))
        + 0.04 * f64::from(u8::from(measures.is_shortest));
    own * (1.0 - GATES_WEIGHT * (1.0 - measures.gates))
}

/// Returns `true` if the board has every property that the search requires.
pub(super) fn is_complete(measures: &BoardMeasures) -> bool {
    measures.necessity() >= 1.0
        && (TRAPS.0..=TRAPS.1).contains(&measures.traps)
        && measures.deaths >= DEATHS
        && measures.last >= LAST
        && measures.gates >= 1.0
        && measures.used >= 1.0
        && measures.dead <= DEAD
        && measures.emptiness <= EMPTY
        && measures.sweep.is_none_or(|sweep| sweep >= SWEEP)
        && measures.is_new
}
