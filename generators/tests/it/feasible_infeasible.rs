//! The search with two populations, of fences.

use crate::toys::{Fences, best_of_random, run};
use base::{Digest, Seed};
use generators::{Evaluation, FeasibleInfeasible, FeasibleInfeasibleConfig, Search};

fn search(fences: &Fences, seed: u64) -> FeasibleInfeasible<'_, Fences> {
    let seed = Seed::from_text("fences").child("run", seed);
    FeasibleInfeasible::new(fences, |fence| Fences::key(fence), FeasibleInfeasibleConfig::default(), seed)
}

/// Random sampling finds one feasible candidate in 26,000, and then a poor one.
#[test]
fn the_optimum_is_found_although_random_sampling_finds_nothing_feasible() {
    let fences = Fences { posts: 48 };
    for seed in 0..3 {
        let mut search = search(&fences, seed);
        let judged = run(&mut search, |candidate| fences.judge(candidate), 150, 40);
        let feasible = |part: &[(Vec<bool>, Evaluation)]| {
            part.iter().filter(|(_, evaluation)| evaluation.is_feasible()).count()
        };
        assert_eq!(feasible(&judged[..100]), 0);
        assert!(feasible(&judged[judged.len() - 1000..]) > 100);
        assert!(search.feasible()[0].evaluation.objective >= 23.0 / 24.0);
        let random = best_of_random(&fences, |candidate| fences.judge(candidate), seed, judged.len());
        assert!(random.is_none_or(|best| best <= 0.8), "{random:?}");
    }
}

#[test]
fn no_candidate_is_asked_for_twice() {
    let fences = Fences { posts: 12 };
    let mut search = search(&fences, 0);
    let judged = run(&mut search, |candidate| fences.judge(candidate), 40, 25);
    let mut keys: Vec<Digest> = judged.iter().map(|(candidate, _)| Fences::key(candidate)).collect();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), judged.len());
    assert_eq!(search.feasible()[0].evaluation.objective, 1.0);
}

#[test]
fn equal_seeds_ask_for_equal_candidates() {
    let fences = Fences { posts: 30 };
    let asked = |seed| run(&mut search(&fences, seed), |candidate| fences.judge(candidate), 12, 20);
    assert_eq!(asked(1), asked(1));
    assert_ne!(asked(1), asked(2));
}

/// Populations are sorted, bounded and apart, and the best objective never falls.
#[test]
fn populations_keep_their_best() {
    let fences = Fences { posts: 24 };
    let mut search = search(&fences, 3);
    let mut best = 0.0;
    for _ in 0..40 {
        let asked = search.ask(20);
        search.tell(asked.into_iter().map(|fence| (fence.clone(), fences.judge(&fence))).collect());
        let objectives: Vec<f64> =
            search.feasible().iter().map(|member| member.evaluation.objective).collect();
        assert!(objectives.is_sorted_by(|one, two| one >= two) && objectives.len() <= 32);
        assert!(search.feasible().iter().all(|member| member.evaluation.is_feasible()));
        assert!(search.infeasible().iter().all(|member| !member.evaluation.is_feasible()));
        let now = objectives.first().copied().unwrap_or(0.0);
        assert!(now >= best);
        best = now;
    }
}

#[test]
fn an_exhausted_variation_ends_the_search() {
    let fences = Fences { posts: 0 };
    let mut search = search(&fences, 0);
    assert!(search.ask(5).is_empty());
}
