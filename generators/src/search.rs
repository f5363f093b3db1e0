//! Ask-and-tell search. A search proposes candidates, the caller evaluates them, and the search learns from the
//! results.
//!
//! A search is independent of the candidate type and of the evaluation. The same algorithms generate levels, rules, or
//! anything else with a [`Variation`]. The interface follows Fontaine et al., "pyribs: A Bare-Bones Python Library for
//! Quality Diversity Optimization" (2023).

use base::{Sampler, Seed};

/// A search that proposes candidates and learns from their evaluations.
pub trait Search {
    /// The candidate type.
    type Candidate;

    /// Returns up to `count` candidates to evaluate next. The candidates do not depend on the evaluator, or on the
    /// number of threads.
    fn ask(&mut self, count: usize) -> Vec<Self::Candidate>;

    /// Records the evaluations of all proposed candidates, in the same order.
    fn tell(&mut self, evaluated: Vec<(Self::Candidate, Evaluation)>);
}

/// A candidate's evaluation, as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// The mean degree to which the candidate meets each constraint, from 0.0 to 1.0. The candidate is feasible only at
    /// 1.0.
    pub feasibility: f64,
    /// The candidate's quality, from 0.0 to 1.0. Only feasible candidates are compared by quality.
    pub objective: f64,
    /// The candidate's characteristics, in the order in which the judges declare the measures. The measures serve as
    /// the axes of an archive.
    pub measures: Vec<f64>,
}

impl Evaluation {
    /// Returns `true` if every constraint is met.
    pub fn is_feasible(&self) -> bool {
        self.feasibility >= 1.0
    }
}

/// A source that creates and varies candidates of one kind. All results are well-formed, but not necessarily good.
pub trait Variation: Sync {
    /// The candidate type.
    type Candidate: Clone + Send + Sync;

    /// Creates a candidate from scratch; `None` if the creation fails with the seed.
    fn create(&self, seed: Seed) -> Option<Self::Candidate>;

    /// Returns a candidate that differs slightly from `parent`.
    fn mutate(&self, parent: &Self::Candidate, sampler: &mut Sampler) -> Self::Candidate;

    /// Returns a candidate that combines parts of two given candidates.
    fn cross(&self, one: &Self::Candidate, two: &Self::Candidate, sampler: &mut Sampler) -> Self::Candidate;
}

impl<V: Variation> Variation for &V {
    type Candidate = V::Candidate;

    fn create(&self, seed: Seed) -> Option<V::Candidate> {
        (**self).create(seed)
    }

    fn mutate(&self, parent: &V::Candidate, sampler: &mut Sampler) -> V::Candidate {
        (**self).mutate(parent, sampler)
    }

    fn cross(&self, one: &V::Candidate, two: &V::Candidate, sampler: &mut Sampler) -> V::Candidate {
        (**self).cross(one, two, sampler)
    }
}
