//! The order in which kernels (hand-written game designs) take turns in a set of games.

use crate::games::Kind;
use crate::kernels::file::kernel::Kernel;
use crate::kernels::words::scene::Scene;
use base::{Sampler, Seed};

/// The maximum number of turns per kind in a round, however many kernels the kind has.
const MOST: usize = 3;

/// Returns the kinds that have kernels, in [`Kind::ALL`] order.
pub fn kinds() -> impl Iterator<Item = Kind> {
    let has_kernel = |kind: &Kind| Kernel::all().iter().any(|kernel| kernel.kind == *kind);
    Kind::ALL.iter().copied().filter(has_kernel)
}

/// The order in which kernels (hand-written game designs) take turns. Each kernel has one turn before any kernel has a
/// second, and kinds alternate.
#[derive(Clone, Debug)]
pub struct Turns {
    order: Vec<&'static Kernel>,
}

impl Turns {
    /// Draws the turns of all kernels of the given kinds.
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
        // Each round takes up to `MOST` kernels of each kind.
        while kinds.iter().any(|kernels| !kernels.is_empty()) {
            for _ in 0..MOST {
                let mut again: Vec<&'static Kernel> = kinds.iter_mut().filter_map(Vec::pop).collect();
                sampler.shuffle(&mut again);
                order.extend(again);
            }
        }
        Turns { order }
    }

    /// Returns the kernels and their kinds, in the order in which kernels take turns.
    pub fn kernels(&self) -> impl Iterator<Item = (&'static str, Kind)> + '_ {
        self.order.iter().map(|kernel| (kernel.name.as_str(), kernel.kind))
    }

    /// Draws a kernel uniformly at random; `None` if there are no kernels.
    pub(crate) fn any(&self, sampler: &mut Sampler) -> Option<&'static Kernel> {
        self.order.get(sampler.below(self.order.len().max(1))).copied()
    }
}
