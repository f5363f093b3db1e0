//! Tests of the variation of kernel games.

use super::drawn;
use base::Seed;
use generators::Variation;
use generators::games::Kind;
use generators::kernels::{KernelGenome, KernelVariation};
use std::collections::BTreeSet;

#[test]
fn all_results_build_and_bring_new_types() {
    let variation = KernelVariation::new(Kind::ALL);
    let mut sampler = Seed::from_text("variation").sampler();
    let mut parents: Vec<KernelGenome> = (0..24)
        .filter_map(|number| variation.create(Seed::from_text("variation").child("start", number)))
        .collect();
    let mut grafts = BTreeSet::new();
    for _ in 0..200 {
        let (one, two) = (sampler.below(parents.len()), sampler.below(parents.len()));
        let mut child = variation.mutate(&parents[one], &mut sampler);
        if sampler.ratio(1, 4) {
            child = variation.cross(&child, &parents[two], &mut sampler);
        }
        let built = child.build().unwrap_or_else(|error| panic!("{error}"));
        grafts.extend(built.game.patterns.into_iter().filter(|name| name.starts_with("graft/")));
        parents[two] = child;
    }
    assert!(grafts.len() >= 5, "{grafts:?}");
}

#[test]
fn most_kernels_can_take_a_graft() {
    let takes = |kernel: &&str| {
        let seed = Seed::from_text(kernel);
        let genome = drawn(kernel, None, seed);
        (0..8).any(|number| genome.grafted(seed.child("graft", number)).is_some())
    };
    let (takers, all) = (KernelGenome::kernels().filter(takes).count(), KernelGenome::kernels().count());
    assert!(2 * takers >= all, "{takers} of {all}");
}
