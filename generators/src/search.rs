//! Search by asking and telling: a search proposes candidates, somebody else judges them, the search learns from that.
//!
//! A search never knows what it searches, nor who judges: the same three algorithms make levels, rules, or whatever else has a
//! [`Variation`]. The shape is that of Fontaine et al., "pyribs: A Bare-Bones Python Library for Quality Diversity
//! Optimization" (2023).

use engine::{Sampler, Seed};

/// Proposes candidates and learns from what the judges say of them.
pub trait Search {
    /// What is searched for.
    type Candidate;

    /// The next candidates to be judged, `count` of them or fewer. They do not depend on who judges, or on how many threads.
    fn ask(&mut self, count: usize) -> Vec<Self::Candidate>;

    /// Takes what the judges found of the candidates that were asked for, all of them, in their order.
    fn tell(&mut self, evaluated: Vec<(Self::Candidate, Evaluation)>);
}

/// What the judges say of a candidate, as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// How much of what every candidate must meet it meets, from 0.0 to 1.0: the mean of graded constraints. It is feasible
    /// at 1.0, and only there.
    pub feasibility: f64,
    /// How good it is, from 0.0 to 1.0. It counts among feasible candidates only.
    pub objective: f64,
    /// What it is like, in the order of the measures that the judges declare: the axes of an archive.
    pub measures: Vec<f64>,
}

impl Evaluation {
    /// Whether every constraint is met.
    pub fn is_feasible(&self) -> bool {
        self.feasibility >= 1.0
    }
}

/// How candidates of one kind come about. Whatever it gives is well-formed; it need not be any good.
pub trait Variation: Sync {
    /// What is varied.
    type Candidate: Clone + Send + Sync;

    /// A candidate from nothing; none if this seed leads nowhere.
    fn create(&self, seed: Seed) -> Option<Self::Candidate>;

    /// A candidate that differs from another in a small way.
    fn mutate(&self, parent: &Self::Candidate, sampler: &mut Sampler) -> Self::Candidate;

    /// A candidate with parts of two others.
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
