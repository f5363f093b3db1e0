//! Random actions: the baseline that every player should beat.

use super::deeds;
use super::shown::Shown;
use engine::{Action, Seed};

/// Returns one of the actions other than nil, all with equal probability.
pub(super) fn choose(shown: &Shown<'_>, seed: Seed) -> Action {
    *seed.sampler().choose(&deeds(&shown.actions))
}
