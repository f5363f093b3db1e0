//! The turns that kernels take in a set of games.

use super::kernel::Kernel;
use super::scene::Scene;
use crate::games::Kind;
use engine::Seed;

/// The most turns of a kind in a round, however many kernels it has.
const MOST: usize = 3;

/// The scenes between those of neighbouring places: most kernels fit one of so many.
const STRIDE: usize = 7;

/// The kinds that have kernels, in the order of [`Kind::ALL`].
pub fn kinds() -> impl Iterator<Item = Kind> {
    let has_kernel = |kind: &Kind| Kernel::all().iter().any(|kernel| kernel.kind == *kind);
    Kind::ALL.iter().copied().filter(has_kernel)
}

/// The order in which kernels take turns: kinds first, then the kernels of each, both in an order that is drawn.
#[derive(Clone, Debug)]
pub struct Turns {
    /// The kernels of each kind.
    kinds: Vec<Vec<&'static Kernel>>,
    /// Indices of kinds, for one round.
    round: Vec<usize>,
    scenes: Vec<&'static Scene>,
    seed: Seed,
}

impl Turns {
    /// Draws the turns of the kernels of these kinds.
    pub fn draw(kinds: &[Kind], seed: Seed) -> Turns {
        let sampler = &mut seed.child("turns", 0).sampler();
        let of_kind = |kind: &Kind| {
            let staged = |kernel: &&Kernel| kernel.kind == *kind && Scene::of(kernel).next().is_some();
            let mut kernels: Vec<&'static Kernel> = Kernel::all().iter().filter(staged).collect();
            sampler.shuffle(&mut kernels);
            kernels
        };
        let mut kinds: Vec<Vec<&'static Kernel>> = kinds.iter().map(of_kind).collect();
        kinds.retain(|kernels| !kernels.is_empty());
        let sampler = &mut seed.child("round", 0).sampler();
        let mut round = Vec::new();
        for turn in 0..MOST {
            let mut again: Vec<usize> = (0..kinds.len()).filter(|&kind| kinds[kind].len() > turn).collect();
            sampler.shuffle(&mut again);
            round.extend(again);
        }
        let mut scenes: Vec<&'static Scene> = Scene::all().iter().collect();
        seed.child("scenes", 0).sampler().shuffle(&mut scenes);
        Turns { kinds, round, scenes, seed }
    }

    /// The scene of a place in the set, of those that a kernel can be set in: far from those of the places before it.
    pub(crate) fn scene(&self, kernel: &Kernel, place: u32) -> Option<&'static Scene> {
        let from = STRIDE * place as usize % self.scenes.len().max(1);
        let (before, after) = self.scenes.split_at(from);
        after.iter().chain(before).copied().find(|scene| scene.fits(kernel))
    }

    /// The kernel of a place in the set, or the next one after some passes; `None` if there are no kernels.
    pub(crate) fn kernel(&self, place: u32, passes: u32) -> Option<&'static Kernel> {
        let length = self.round.len();
        if length == 0 {
            return None;
        }
        let (rounds, at) = (place as usize / length, place as usize % length);
        let kind = self.round[at];
        let in_round = |until: usize| self.round[..until].iter().filter(|&&other| other == kind).count();
        let kernels = &self.kinds[kind];
        let first = kernels[(rounds * in_round(length) + in_round(at)) % kernels.len()];
        let mut others: Vec<&'static Kernel> =
            self.kinds.iter().flatten().copied().filter(|kernel| kernel.name != first.name).collect();
        self.seed.child("others", place.into()).sampler().shuffle(&mut others);
        match passes as usize % (others.len() + 1) {
            0 => Some(first),
            pass => Some(others[pass - 1]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    #[test]
    fn fifty_places_have_many_kernels_and_no_crowd() {
        let turns = Turns::draw(Kind::ALL, Seed::from_text("turns"));
        let (mut kernels, mut kinds) = (BTreeMap::new(), BTreeMap::new());
        for place in 0..50 {
            let kernel = turns.kernel(place, 0).unwrap();
            *kernels.entry(&kernel.name).or_insert(0) += 1;
            *kinds.entry(kernel.kind).or_insert(0) += 1;
        }
        assert!(kernels.len() >= 30 && kinds.values().all(|&there| there <= 7), "{kernels:?} {kinds:?}");
        let passed: Vec<_> = (0..10).map(|pass| &turns.kernel(3, pass).unwrap().name).collect();
        assert!((1..10).all(|at| !passed[..at].contains(&passed[at])), "{passed:?}");
        let scene = |place: u32| turns.scene(turns.kernel(place, 0)?, place).map(|scene| &scene.name);
        let scenes: BTreeSet<_> = (0..12).map(scene).collect();
        assert!(scenes.len() >= 10 && !scenes.contains(&None), "{scenes:?}");
        assert!(Turns::draw(&[], Seed::from_text("none")).kernel(0, 0).is_none());
    }
}
