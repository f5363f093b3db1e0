//! Games from hand-written kernels.

use super::Proposal;
use base::Seed;
use engine::syntax;
use generators::kernels::{KernelGenome, Slot, kinds};

pub(super) fn propose(levels: usize, seed: Seed) -> Option<Proposal> {
    let allowed: Vec<_> = kinds().collect();
    let built = KernelGenome::draw(&allowed, seed.child("rules", 0)).ok()?.build().ok()?;
    let level = |number: usize| {
        // Any further levels repeat the last position of the sequence of levels.
        let slot = Slot::ALL[number.min(Slot::ALL.len() - 1)];
        built.course.level(slot, seed.child("level", number as u64)).ok().map(|level| level.text)
    };
    let levels = (0..levels).filter_map(level).collect();
    Some(Proposal { rules: syntax::print(built.game.rules.description()), levels })
}
