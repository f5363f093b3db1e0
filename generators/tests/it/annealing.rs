//! Tests of simulated annealing with bit strings, whose optimum is known.

use base::{Sampler, Seed};
use generators::{Annealing, AnnealingConfig, Evaluation, Search, Variation};

const BITS: usize = 48;

/// Bit strings. A neighbour of a bit string differs from it in one or two bits.
struct Bits;

impl Variation for Bits {
    type Candidate = u64;

    fn create(&self, seed: Seed) -> Option<u64> {
        Some(seed.sampler().bits() & ((1 << BITS) - 1))
    }

    fn mutate(&self, parent: &u64, sampler: &mut Sampler) -> u64 {
        let other = if sampler.ratio(1, 2) { 1 << sampler.below(BITS) } else { 0 };
        parent ^ (1 << sampler.below(BITS)) ^ other
    }

    fn cross(&self, one: &u64, two: &u64, sampler: &mut Sampler) -> u64 {
        let mask = sampler.bits();
        one & mask | two & !mask
    }
}

/// Evaluates a bit string. It is feasible with at most 12 ones in the lower half. The objective rewards ones that fill
/// groups of four. The optimum is 12 + 24 ones in nine full groups.
fn judge(bits: &u64) -> Evaluation {
    let lower = (bits & 0xFF_FFFF).count_ones() as f64;
    let squares = (0..BITS / 4).map(|at| (bits >> (4 * at) & 0xF).count_ones().pow(2));
    let full = f64::from(squares.sum::<u32>()) / 16.0;
    let ones = bits.count_ones() as f64;
    let feasibility = 1.0 - (lower - 12.0).max(0.0) / 12.0;
    Evaluation { feasibility, objective: (full / 9.0 + ones / 36.0) / 2.0, measures: Vec::new() }
}

fn run(seed: &str, evaluations: usize, batch: usize) -> (Vec<u64>, Annealing<Bits>) {
    let config = AnnealingConfig::of(evaluations);
    let mut search = Annealing::new(Bits, config, Seed::from_text(seed));
    let mut asked = Vec::new();
    loop {
        let candidates = search.ask(batch);
        if candidates.is_empty() {
            return (asked, search);
        }
        asked.extend(&candidates);
        search.tell(candidates.into_iter().map(|candidate| (candidate, judge(&candidate))).collect());
    }
}

#[test]
fn the_optimum_is_found() {
    for seed in ["one", "two", "three"] {
        let (asked, search) = run(seed, 40_000, 16);
        assert_eq!(asked.len(), 40_000);
        assert!(search.is_over());
        let (best, evaluation) = search.best().unwrap();
        assert_eq!(evaluation, &judge(best));
        assert!(evaluation.is_feasible() && evaluation.objective >= 1.0, "{best:b} {evaluation:?}");
    }
}

#[test]
fn it_beats_random_sampling() {
    for seed in ["four", "five", "six"] {
        let (_, search) = run(seed, 600, 8);
        let found = search.best().unwrap().1.clone();
        let seed = Seed::from_text(seed);
        let random = (0..600).map(|at| judge(&Bits.create(seed.child("random", at)).unwrap()));
        let feasible = random.filter(Evaluation::is_feasible).map(|evaluation| evaluation.objective);
        let random = feasible.max_by(f64::total_cmp).unwrap();
        assert!(found.is_feasible() && found.objective > random + 0.1, "{found:?} {random}");
    }
}

#[test]
fn equal_seeds_ask_for_equal_candidates() {
    assert_eq!(run("seven", 500, 8).0, run("seven", 500, 8).0);
    assert_ne!(run("seven", 500, 8).0, run("eight", 500, 8).0);
}
