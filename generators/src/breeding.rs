//! Creation and breeding of candidates for populations and archives. No candidate is proposed twice.

use crate::Variation;
use base::{Digest, Sampler, Seed};
use std::collections::BTreeSet;

/// The maximum number of attempts to find an unseen candidate for one proposal.
const TRIES: usize = 8;

/// The key function. Candidates with the same key count as the same candidate.
type Key<'a, C> = Box<dyn Fn(&C) -> Digest + Send + 'a>;

/// Generates candidates that have not been proposed before.
pub(crate) struct Breeding<'a, V: Variation> {
    variation: &'a V,
    key: Key<'a, V::Candidate>,
    seed: Seed,
    /// The probability that a proposal is a crossover of two parents.
    crossing: f64,
    /// The number of proposals so far. Each proposal draws from its own seed.
    drawn: u64,
    /// The keys of all candidates proposed so far, so that none is proposed twice.
    seen: BTreeSet<Digest>,
}

impl<'a, V: Variation> Breeding<'a, V> {
    pub(crate) fn new(variation: &'a V, key: Key<'a, V::Candidate>, crossing: f64, seed: Seed) -> Self {
        Breeding { variation, key, seed, crossing, drawn: 0, seen: BTreeSet::new() }
    }

    /// Returns the sampler for the next proposal.
    pub(crate) fn next_sampler(&mut self) -> Sampler {
        self.drawn += 1;
        self.seed.child("proposal", self.drawn).sampler()
    }

    /// Creates a new candidate from scratch; `None` if several seeds all lead to known candidates.
    pub(crate) fn create(&mut self) -> Option<V::Candidate> {
        (0..TRIES).find_map(|_| {
            self.drawn += 1;
            let made = self.variation.create(self.seed.child("create", self.drawn));
            made.filter(|candidate| self.note(candidate))
        })
    }

    /// Breeds a new candidate from one or two parents. Two parents are crossed, and their child is mutated half of the
    /// time. A single parent is only mutated. A child that is already known is mutated further. Returns `None` if all
    /// attempts yield known candidates.
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

    /// Records a candidate. Returns `true` if the candidate was new.
    pub(crate) fn note(&mut self, candidate: &V::Candidate) -> bool {
        self.seen.insert((self.key)(candidate))
    }
}
