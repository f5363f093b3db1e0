//! Random actions: the baseline that every player should beat.

use super::actions_except_nil;
use super::shown::Shown;
use engine::{Action, Seed};

/// Returns one of the actions other than nil, all with equal probability.
pub(super) fn choose(shown: &Shown<'_>, seed: Seed) -> Action {
    *seed.sampler().choose(&actions_except_nil(&shown.actions))
}
