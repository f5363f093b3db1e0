//! Tests of the order in which kernels take turns in a set of games.

use base::Seed;
use generators::games::Kind;
use generators::kernels::{KernelGenome, Turns};
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of turns of a kind in a round, regardless of its number of kernels.
const MOST: usize = 3;

#[test]
fn every_kernel_has_a_turn_and_kinds_mingle() {
    let turns = Turns::draw(Kind::ALL, Seed::from_text("turns"));
    let names: BTreeSet<&str> = turns.kernels().map(|(name, _)| name).collect();
    assert!(
        names.len() == KernelGenome::kernels().count() && turns.kernels().count() == names.len(),
        "{names:?}"
    );
    let mut kinds = BTreeMap::new();
    for (_, kind) in turns.kernels().take(20) {
        *kinds.entry(kind).or_insert(0) += 1;
    }
    assert!(kinds.values().all(|&there| there <= MOST), "{kinds:?}");
    let none = Turns::draw(&[], Seed::from_text("none"));
    assert_eq!(none.kernels().next(), None);
    assert!(KernelGenome::draw(&[], Seed::from_text("any")).is_err());
}
