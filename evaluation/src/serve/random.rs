//! Any action: the floor that every player should be above.

use super::deeds;
use super::shown::Shown;
use engine::{Action, Seed};

/// One of the actions other than nil, all with the same chance.
pub(super) fn choose(shown: &Shown<'_>, seed: Seed) -> Action {
    *seed.sampler().choose(&deeds(&shown.actions))
}
