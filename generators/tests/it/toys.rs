//! Toy problems for tests of the searches. They are variations whose best candidates are known.

use base::{Digest, Sampler, Seed};
use generators::{Evaluation, Search, Variation};

/// Rows of eight numbers from 0 to 100. The measures are the means of the two halves, and the objective is the
/// similarity of the numbers within each half. Every cell can be filled with an objective near 1. Feasible rows begin
/// and end with numbers that differ by at least 10.
pub(crate) struct Slopes;

impl Slopes {
    pub(crate) fn key(slope: &[u8; 8]) -> Digest {
        Digest::of(slope)
    }

    pub(crate) fn judge(slope: &[u8; 8]) -> Evaluation {
        let mean = |half: &[u8]| half.iter().map(|&number| f64::from(number)).sum::<f64>() / 400.0;
        let spread = |half: &[u8]| {
            let off = half.iter().map(|&number| (f64::from(number) / 100.0 - mean(half)).abs());
            off.sum::<f64>() / 2.0
        };
        let (low, high) = slope.split_at(4);
        let drop = f64::from(slope[0].abs_diff(slope[7]));
        Evaluation {
            feasibility: (drop / 10.0).min(1.0),
            objective: 1.0 - (spread(low) + spread(high)) / 2.0,
            measures: vec![mean(low), mean(high)],
        }
    }
}

impl Variation for Slopes {
    type Candidate = [u8; 8];

    fn create(&self, seed: Seed) -> Option<[u8; 8]> {
        let mut sampler = seed.sampler();
        Some([0; 8].map(|_| sampler.below(101) as u8))
    }

    fn mutate(&self, parent: &[u8; 8], sampler: &mut Sampler) -> [u8; 8] {
        let mut child = *parent;
        let number = sampler.choose(&[0, 1, 2, 3, 4, 5, 6, 7]).to_owned();
        child[number] = (child[number] + sampler.below(31) as u8).saturating_sub(15).min(100);
        child
    }

    fn cross(&self, one: &[u8; 8], two: &[u8; 8], sampler: &mut Sampler) -> [u8; 8] {
        let cut = sampler.below(8);
        let mut child = *two;
        child[..cut].copy_from_slice(&one[..cut]);
        child
    }
}

/// Requests and evaluates a number of batches. Returns all candidates with their evaluations.
pub(crate) fn run<S: Search>(
    search: &mut S,
    judge: impl Fn(&S::Candidate) -> Evaluation,
    batches: usize,
    size: usize,
) -> Vec<(S::Candidate, Evaluation)>
where
    S::Candidate: Clone,
{
    let mut all = Vec::new();
    for _ in 0..batches {
        let asked = search.ask(size).into_iter();
        let judged: Vec<(S::Candidate, Evaluation)> = asked.map(|c| (c.clone(), judge(&c))).collect();
        all.extend(judged.iter().cloned());
        search.tell(judged);
    }
    all
}

/// Creates and evaluates random candidates.
pub(crate) fn sample<V: Variation>(
    variation: &V,
    judge: impl Fn(&V::Candidate) -> Evaluation,
    seed: u64,
    count: usize,
) -> impl Iterator<Item = (V::Candidate, Evaluation)> {
    let seed = Seed::from_text("random sampling").child("run", seed);
    let create = move |at| variation.create(seed.child("create", at));
    (0..count as u64).filter_map(create).map(move |candidate| {
        let evaluation = judge(&candidate);
        (candidate, evaluation)
    })
}
