//! Variation of kernel games, for searches.

use super::genome::{KernelGenome, MAX_GRAFTS, pick};
use super::graft::Graft;
use super::habits::Habits;
use crate::Variation;
use crate::games::Kind;
use crate::kernels::file::kernel::Kernel;
use crate::kernels::words::scene::Scene;
use base::{Sampler, Seed};

/// The number of attempts at a change before a parent is returned unchanged.
const ATTEMPTS: usize = 16;

/// Kernel games as candidates of a search. They are drawn like constructive ones, mutated by changing a number, a
/// variant, a graft or the scene, and crossed.
///
/// All candidates build: their rules compile without errors or warnings. Cost: about a millisecond per mutation.
#[derive(Clone, Debug)]
pub struct KernelVariation {
    kinds: Vec<Kind>,
}

impl KernelVariation {
    /// Creates a variation for games of the given kinds.
    pub fn new(kinds: &[Kind]) -> KernelVariation {
        KernelVariation { kinds: kinds.to_vec() }
    }

    /// Returns a genome with one change; `None` if nothing can be changed in the way that is drawn.
    fn changed(&self, parent: &KernelGenome, sampler: &mut Sampler) -> Option<KernelGenome> {
        let mut genome = parent.clone();
        match sampler.weighted(&[4, 3, 5, 1, 2, 1, 2]).unwrap_or(0) {
            0 => {
                let at = pick(genome.values.len(), sampler)?;
                genome.values[at] = genome.kernel.numbers.draw(sampler)[at];
            }
            1 => {
                let at = pick(genome.kernel.variants.len(), sampler)?;
                match genome.variants.binary_search(&at) {
                    Ok(there) => drop(genome.variants.remove(there)),
                    Err(place) => genome.variants.insert(place, at),
                }
            }
            2 => genome.graft(sampler)?,
            3 => {
                let at = pick(genome.grafts.len(), sampler)?;
                genome.grafts.remove(at);
            }
            4 => {
                let of_kind = |kernel: &&Kernel| kernel.kind == genome.kernel.kind;
                let kernels: Vec<&'static Kernel> = Kernel::all().iter().filter(of_kind).collect();
                genome = KernelGenome::of(kernels[pick(kernels.len(), sampler)?], sampler);
            }
            5 => {
                let scenes: Vec<&'static Scene> = genome.in_scenes().collect();
                genome.scene = scenes[pick(scenes.len(), sampler)?];
            }
            _ => {
                genome.nouns = Seed::from_text("nouns").child("draw", sampler.bits());
                genome.habits = Habits::draw(genome.nouns);
            }
        }
        Some(genome)
    }
}

impl Variation for KernelVariation {
    type Candidate = KernelGenome;

    fn create(&self, seed: Seed) -> Option<KernelGenome> {
        KernelGenome::draw(&self.kinds, seed).ok().filter(|genome| genome.build().is_ok())
    }

    fn mutate(&self, parent: &KernelGenome, sampler: &mut Sampler) -> KernelGenome {
        let changed = (0..ATTEMPTS).filter_map(|_| self.changed(parent, sampler));
        let mut sound = changed.filter(|genome| genome.key() != parent.key() && genome.build().is_ok());
        sound.next().unwrap_or_else(|| parent.clone())
    }

    /// Crosses two games. The child has the kernel of `one`; if both have the same kernel, numbers and variants come
    /// from both. Grafts always come from both.
    fn cross(&self, one: &KernelGenome, two: &KernelGenome, sampler: &mut Sampler) -> KernelGenome {
        let mut child = one.clone();
        if one.kernel.is_same(two.kernel) {
            for (own, other) in child.values.iter_mut().zip(&two.values) {
                if sampler.ratio(1, 2) {
                    *own = *other;
                }
            }
            let both = 0..one.kernel.variants.len();
            child.variants = both
                .filter(|at| if sampler.ratio(1, 2) { &one.variants } else { &two.variants }.contains(at))
                .collect();
        }
        child.grafts.retain(|_| sampler.ratio(2, 3));
        for graft in &two.grafts {
            let fits = |own: &&Graft| own.name == graft.name && own.fits(child.scene, child.kernel);
            let own = child.addable().find(fits);
            child.grafts.extend(own.filter(|_| child.grafts.len() < MAX_GRAFTS));
        }
        if child.build().is_ok() { child } else { one.clone() }
    }
}
