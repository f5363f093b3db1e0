//! The turns that kernels take in a set of games.

use super::kernel::Kernel;
use super::scene::Scene;
use crate::games::Kind;
use engine::Seed;

/// The most turns of a kind in a round, however many kernels it has.
const MOST: usize = 3;

/// The scenes between those of neighbouring places: most kernels fit one of so many.
const STRIDE: usize = 7;

/// The places that have different scenes, as far as their kernels allow.
const BLOCK: u32 = 40;

/// The kinds that have kernels, in the order of [`Kind::ALL`].
pub fn kinds() -> impl Iterator<Item = Kind> {
    let has_kernel = |kind: &Kind| Kernel::all().iter().any(|kernel| kernel.kind == *kind);
    Kind::ALL.iter().copied().filter(has_kernel)
}

/// The order in which kernels take turns: each has one before any has a second, and kinds mingle.
#[derive(Clone, Debug)]
pub struct Turns {
    /// All kernels, in rounds.
    order: Vec<&'static Kernel>,
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
        let mut order = Vec::new();
        // Up to `MOST` kernels of each kind, and then the others.
        while kinds.iter().any(|kernels| !kernels.is_empty()) {
            for _ in 0..MOST {
                let mut again: Vec<&'static Kernel> = kinds.iter_mut().filter_map(Vec::pop).collect();
                sampler.shuffle(&mut again);
                order.extend(again);
            }
        }
        let mut scenes: Vec<&'static Scene> = Scene::all().iter().collect();
        seed.child("scenes", 0).sampler().shuffle(&mut scenes);
        Turns { order, scenes, seed }
    }

    /// The kernels and their kinds, in the order of their turns.
    pub fn kernels(&self) -> impl Iterator<Item = (&'static str, Kind)> + '_ {
        self.order.iter().map(|kernel| (kernel.name.as_str(), kernel.kind))
    }

    /// The scene of a place in the set, of those that a kernel can be set in: one that no place shortly before it has, if
    /// there is one.
    pub(crate) fn scene(&self, kernel: &Kernel, place: u32) -> Option<&'static Scene> {
        let mut taken: Vec<&'static Scene> = Vec::new();
        for before in place - place % BLOCK..place {
            taken.extend(self.free_scene(self.first(before)?, before, &taken));
        }
        self.free_scene(kernel, place, &taken)
    }

    /// The first scene of a place that its kernel can be set in and that none of the places before it has.
    fn free_scene(&self, kernel: &Kernel, place: u32, taken: &[&'static Scene]) -> Option<&'static Scene> {
        let from = STRIDE * place as usize % self.scenes.len().max(1);
        let (before, after) = self.scenes.split_at(from);
        let mut fitting = after.iter().chain(before).copied().filter(|scene| scene.fits(kernel));
        let first = fitting.clone().next();
        let is_free = |scene: &&Scene| !taken.iter().any(|other| other.name == scene.name);
        fitting.find(is_free).or(first)
    }

    /// The kernel whose turn it is.
    fn first(&self, place: u32) -> Option<&'static Kernel> {
        self.order.get(place as usize % self.order.len().max(1)).copied()
    }

    /// The kernel of a place in the set, or the next one after some passes; `None` if there are no kernels.
    pub(crate) fn kernel(&self, place: u32, passes: u32) -> Option<&'static Kernel> {
        let (first, length) = (self.first(place)?, self.order.len());
        let sampler = &mut self.seed.child("others", place.into()).sampler();
        // Kernels that have their turn late, and that smaller sets have no place for, come first.
        let (mut early, mut late) = (self.order[..length / 2].to_vec(), self.order[length / 2..].to_vec());
        sampler.shuffle(&mut late);
        sampler.shuffle(&mut early);
        let mut others = late.into_iter().chain(early).filter(|kernel| kernel.name != first.name);
        match passes as usize % length {
            0 => Some(first),
            pass => others.nth(pass - 1),
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
        assert!(kernels.len() == Kernel::all().len(), "{kernels:?}");
        assert!(kernels.values().all(|&there| there <= 2), "{kernels:?}");
        assert!(kinds.values().all(|&there| there <= 9), "{kinds:?}");
        let passed: Vec<_> = (0..10).map(|pass| &turns.kernel(3, pass).unwrap().name).collect();
        assert!((1..10).all(|at| !passed[..at].contains(&passed[at])), "{passed:?}");
        let scene = |place: u32| turns.scene(turns.kernel(place, 0)?, place).map(|scene| &scene.name);
        let scenes: BTreeSet<_> = (0..12).map(scene).collect();
        assert!(scenes.len() >= 11 && !scenes.contains(&None), "{scenes:?}");
        assert!(Turns::draw(&[], Seed::from_text("none")).kernel(0, 0).is_none());
    }
}
