//! How populations and archives come by new candidates: from nothing, or from parents, and never the same one twice.

use crate::Variation;
use engine::{Digest, Sampler, Seed};
use std::collections::BTreeSet;

/// How often a candidate that is known already is changed further before it is given up.
const TRIES: usize = 8;

/// Whose candidates are the same: those with the same key.
type Key<'a, C> = Box<dyn Fn(&C) -> Digest + Send + 'a>;

/// Makes candidates, each of which nobody has asked for before.
pub(crate) struct Breeding<'a, V: Variation> {
    variation: &'a V,
    key: Key<'a, V::Candidate>,
    seed: Seed,
    /// The probability that two parents are crossed.
    crossing: f64,
    /// Proposals so far: each draws from a seed of its own.
    drawn: u64,
    /// The keys of all that was proposed.
    seen: BTreeSet<Digest>,
}

impl<'a, V: Variation> Breeding<'a, V> {
    pub(crate) fn new(variation: &'a V, key: Key<'a, V::Candidate>, crossing: f64, seed: Seed) -> Self {
        Breeding { variation, key, seed, crossing, drawn: 0, seen: BTreeSet::new() }
    }

    /// The draws for the next proposal.
    pub(crate) fn next_sampler(&mut self) -> Sampler {
        self.drawn += 1;
        self.seed.child("proposal", self.drawn).sampler()
    }

    /// A new candidate from nothing; none if no seed of a few leads to one.
    pub(crate) fn create(&mut self) -> Option<V::Candidate> {
        for _ in 0..TRIES {
            self.drawn += 1;
            let made = self.variation.create(self.seed.child("create", self.drawn));
            if let Some(candidate) = made.filter(|candidate| self.note(candidate)) {
                return Some(candidate);
            }
        }
        None
    }

    /// A new candidate from one parent or from two: crossed, and mutated once in two times; or only mutated. What is known
    /// already is mutated on. None if it stays known.
    pub(crate) fn breed(
        &mut self,
        parent: &V::Candidate,
        mate: Option<&V::Candidate>,
        sampler: &mut Sampler,
    ) -> Option<V::Candidate> {
        let mate = mate.filter(|_| sampler.unit() < self.crossing);
        let mut child = match mate {
            Some(mate) => self.variation.cross(parent, mate, sampler),
            None => self.variation.mutate(parent, sampler),
        };
        if mate.is_some() && sampler.ratio(1, 2) {
            child = self.variation.mutate(&child, sampler);
        }
        for _ in 0..TRIES {
            if self.note(&child) {
                return Some(child);
            }
            child = self.variation.mutate(&child, sampler);
        }
        None
    }

    /// Notes a candidate. Whether it was new.
    pub(crate) fn note(&mut self, candidate: &V::Candidate) -> bool {
        self.seen.insert((self.key)(candidate))
    }
}
