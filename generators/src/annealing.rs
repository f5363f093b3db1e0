//! Simulated annealing with a few chains of candidates. As the search proceeds, each chain accepts fewer steps to worse
//! candidates.

use crate::{Evaluation, Search, Variation};
use base::{Sampler, Seed};
use std::cmp::Ordering;
use std::collections::VecDeque;

/// The number of seeds to try for a chain's starting candidate before the chain's turn is skipped.
const STARTS: usize = 16;

/// The parameters of an annealing search.
#[derive(Clone, Debug, PartialEq)]
pub struct AnnealingConfig {
    /// The total number of candidates to evaluate. The temperature schedule spans all of them.
    pub evaluations: usize,
    /// The number of independent chains.
    pub chains: usize,
    /// The decrease in objective, relative to the current candidate, that is accepted with probability 1/e at the start
    /// of the search.
    pub warmest: f64,
    /// The decrease in objective that is accepted with probability 1/e at the end of the search. Must be positive.
    pub coldest: f64,
    /// The number of starting candidates per chain. The chain continues from the best starting candidate.
    pub starts: usize,
    /// The number of consecutive candidates, none better than the chain's best, after which the chain restarts.
    pub patience: usize,
}

impl AnnealingConfig {
    /// Returns default parameters for a given number of evaluations.
    pub fn of(evaluations: usize) -> AnnealingConfig {
        let chains = (evaluations / 60).clamp(1, 4);
        let patience = (evaluations / chains / 3).max(20);
        AnnealingConfig { evaluations, chains, warmest: 0.08, coldest: 0.004, starts: 1, patience }
    }
}

/// Simulated annealing (Kirkpatrick, Gelatt and Vecchi 1983, "Optimization by simulated annealing") with an
/// ask-and-tell interface for batches.
///
/// Each chain stores a current candidate and proposes its neighbours. Infeasible candidates are compared only by
/// feasibility, and feasible candidates only by objective. An infeasible candidate never replaces a feasible one. The
/// temperature falls geometrically with the number of reported evaluations, not with time. A batch's neighbours are
/// processed in order, and each is compared with the chain's current candidate at that moment. A chain that has
/// stagnated restarts.
///
/// Memory use: two candidates per chain, plus the best candidate. [`Search::ask`] returns an empty batch once it has
/// proposed all candidates.
#[derive(Debug)]
pub struct Annealing<V: Variation> {
    variation: V,
    config: AnnealingConfig,
    seed: Seed,
    chains: Vec<Chain<V::Candidate>>,
    /// The index of the chain whose turn is next.
    turn: usize,
    /// The chain of each proposed candidate that has not been evaluated yet, in order of proposal.
    pending: VecDeque<usize>,
    asked: usize,
    told: usize,
    /// The number of seeds already used for starting candidates.
    started: u64,
    best: Option<(V::Candidate, Evaluation)>,
}

#[derive(Debug)]
struct Chain<C> {
    /// A sampler that draws neighbours and decides on acceptance.
    sampler: Sampler,
    present: Option<(C, Evaluation)>,
    /// The number of starting candidates still to be proposed.
    starts: usize,
    /// The best evaluation since the chain last started.
    peak: Option<Evaluation>,
    /// The number of candidates evaluated since `peak` was set.
    stale: usize,
}

impl<V: Variation> Annealing<V> {
    /// Creates a search with the given variation and parameters.
    pub fn new(variation: V, config: AnnealingConfig, seed: Seed) -> Annealing<V> {
        let chain = |at: u64| Chain {
            sampler: seed.child("chain", at).sampler(),
            present: None,
            starts: config.starts,
            peak: None,
            stale: 0,
        };
        let chains = (0..config.chains.max(1) as u64).map(chain).collect();
        Annealing {
            variation,
            config,
            seed,
            chains,
            turn: 0,
            pending: VecDeque::new(),
            asked: 0,
            told: 0,
            started: 0,
            best: None,
        }
    }

    /// Returns the best candidate so far, with its evaluation.
    pub fn best(&self) -> Option<(&V::Candidate, &Evaluation)> {
        self.best.as_ref().map(|(candidate, evaluation)| (candidate, evaluation))
    }

    /// Returns `true` once all candidates have been evaluated.
    pub fn is_over(&self) -> bool {
        self.told >= self.config.evaluations
    }

    /// Returns the variation that proposes candidates.
    pub fn variation(&self) -> &V {
        &self.variation
    }

    /// Creates a candidate from which a chain starts; `None` if all attempts fail.
    fn start(&mut self) -> Option<V::Candidate> {
        (0..STARTS).find_map(|_| {
            self.started += 1;
            self.variation.create(self.seed.child("start", self.started))
        })
    }

    fn temperature(&self) -> f64 {
        let share = self.told as f64 / self.config.evaluations.max(1) as f64;
        let ratio = self.config.coldest / self.config.warmest;
        self.config.warmest * libm::pow(ratio, share.min(1.0))
    }
}

impl<V: Variation> Search for Annealing<V> {
    type Candidate = V::Candidate;

    fn ask(&mut self, count: usize) -> Vec<V::Candidate> {
        let count = count.min(self.config.evaluations.saturating_sub(self.asked));
        let mut candidates = Vec::with_capacity(count);
        for _ in 0..count {
            let at = self.turn;
            let chain = &mut self.chains[at];
            let candidate = match &chain.present {
                Some((present, _)) if chain.starts == 0 => {
                    Some(self.variation.mutate(present, &mut chain.sampler))
                }
                _ => {
                    chain.starts = chain.starts.saturating_sub(1);
                    self.start()
                }
            };
            let Some(candidate) = candidate else { continue };
            self.pending.push_back(at);
            self.turn = (at + 1) % self.chains.len();
            candidates.push(candidate);
        }
        self.asked += candidates.len();
        candidates
    }

    fn tell(&mut self, evaluated: Vec<(V::Candidate, Evaluation)>) {
        for (candidate, evaluation) in evaluated {
            let Some(at) = self.pending.pop_front() else { return };
            let temperature = self.temperature();
            self.told += 1;
            if self.best.as_ref().is_none_or(|(_, best)| compare(&evaluation, best) == Ordering::Greater) {
                self.best = Some((candidate.clone(), evaluation.clone()));
            }
            self.chains[at].take(candidate, evaluation, temperature, &self.config);
        }
    }
}

impl<C> Chain<C> {
    /// Moves to the given candidate, or stays at the current candidate.
    fn take(&mut self, candidate: C, evaluation: Evaluation, temperature: f64, config: &AnnealingConfig) {
        if self.peak.as_ref().is_none_or(|peak| compare(&evaluation, peak) == Ordering::Greater) {
            self.peak = Some(evaluation.clone());
            self.stale = 0;
        } else {
            self.stale += 1;
        }
        // Drawn even if unused, so that later draws do not depend on the outcome.
        let luck = self.sampler.unit();
        let goes = self.present.as_ref().is_none_or(|(_, present)| {
            compare(&evaluation, present) != Ordering::Less
                || self.starts == 0
                    && loss(&evaluation, present).is_some_and(|loss| luck < libm::exp(-loss / temperature))
        });
        if goes {
            self.present = Some((candidate, evaluation));
        }
        if self.stale >= config.patience {
            (self.present, self.peak, self.stale, self.starts) = (None, None, 0, config.starts);
        }
    }
}

/// Compares feasible candidates by objective, and infeasible candidates by feasibility. Feasible candidates always rank
/// above infeasible ones.
fn compare(one: &Evaluation, two: &Evaluation) -> Ordering {
    let key = |evaluation: &Evaluation| {
        let feasible = evaluation.is_feasible();
        (feasible, if feasible { evaluation.objective } else { evaluation.feasibility })
    };
    let (one, two) = (key(one), key(two));
    one.0.cmp(&two.0).then(one.1.total_cmp(&two.1))
}

/// Returns the amount by which the first evaluation is worse than the second; `None` if only one of them is feasible.
fn loss(one: &Evaluation, two: &Evaluation) -> Option<f64> {
    match (one.is_feasible(), two.is_feasible()) {
        (true, true) => Some(two.objective - one.objective),
        (false, false) => Some(two.feasibility - one.feasibility),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feasible_candidates_are_never_abandoned() {
        let of = |feasibility: f64, objective: f64| Evaluation { feasibility, objective, measures: vec![] };
        let mut chain = Chain {
            sampler: Seed::from_text("chain").sampler(),
            present: None,
            starts: 0,
            peak: None,
            stale: 0,
        };
        let patient = &AnnealingConfig { patience: 100, ..AnnealingConfig::of(0) };
        let hasty = &AnnealingConfig { patience: 3, starts: 2, ..AnnealingConfig::of(0) };
        chain.take(1, of(0.2, 0.9), 1e9, patient);
        chain.take(2, of(0.1, 0.9), 1e9, patient);
        assert_eq!(chain.present.as_ref().unwrap().0, 2, "anything goes when it is hot");
        chain.take(3, of(1.0, 0.0), 1e-9, patient);
        chain.take(4, of(0.99, 1.0), 1e9, patient);
        assert_eq!(chain.present.as_ref().unwrap().0, 3);
        chain.take(5, of(1.0, 0.5), 1e-9, hasty);
        chain.take(6, of(1.0, 0.4), 1e-9, hasty);
        assert_eq!(chain.present.as_ref().unwrap().0, 5);
        chain.take(7, of(1.0, 0.4), 1e-9, hasty);
        chain.take(8, of(1.0, 0.4), 1e-9, hasty);
        assert!(chain.present.is_none(), "a chain that stagnates starts anew");
        assert_eq!(chain.starts, 2);
        chain.take(9, of(1.0, 0.4), 1e9, hasty);
        chain.take(10, of(1.0, 0.3), 1e9, hasty);
        assert_eq!(chain.present.as_ref().unwrap().0, 9, "of its starts a chain takes the best, hot or not");
    }
}
