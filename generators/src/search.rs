//! Ask-and-tell search: a search proposes candidates, the caller evaluates them, and the search learns from the results.
//!
//! A search is independent of the candidates and of their evaluation: the same three algorithms make levels, rules, or
//! anything else that has a [`Variation`]. The interface follows Fontaine et al., "pyribs: A Bare-Bones Python Library
//! for Quality Diversity Optimization" (2023).

use base::{Sampler, Seed};

/// Proposes candidates and learns from their evaluations.
pub trait Search {
    /// The type of the candidates.
    type Candidate;

    /// Returns the next candidates to evaluate, at most `count`. They do not depend on the evaluator, or on the number of
    /// threads.
    fn ask(&mut self, count: usize) -> Vec<Self::Candidate>;

    /// Takes the evaluations of all the candidates that were asked for, in their order.
    fn tell(&mut self, evaluated: Vec<(Self::Candidate, Evaluation)>);
}

/// The evaluation of a candidate, as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// The degree to which it meets the constraints, from 0.0 to 1.0: the mean of graded constraints. It is feasible at
    /// 1.0, and only there.
    pub feasibility: f64,
    /// Its quality, from 0.0 to 1.0. It counts among feasible candidates only.
    pub objective: f64,
    /// Its characteristics, in the order of the measures that the judges declare: the axes of an archive.
    pub measures: Vec<f64>,
}

impl Evaluation {
    /// Returns `true` if every constraint is met.
    pub fn is_feasible(&self) -> bool {
        self.feasibility >= 1.0
    }
}

/// Creates and varies candidates of one kind. All results are well-formed, but not necessarily good.
pub trait Variation: Sync {
    /// The type of the candidates.
    type Candidate: Clone + Send + Sync;

    /// Creates a candidate from nothing; `None` if that fails with this seed.
    fn create(&self, seed: Seed) -> Option<Self::Candidate>;

    /// Returns a candidate that differs slightly from another.
    fn mutate(&self, parent: &Self::Candidate, sampler: &mut Sampler) -> Self::Candidate;

    /// Returns a candidate with parts of two others.
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
