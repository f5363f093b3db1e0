//! The points in a tick at which work may be skipped.

use super::{Step, Watch};
use crate::numbers::geometry::Rect;
use crate::rules::{EffectInfo, Pass};
use crate::world::{Slot, Watcher, World};

/// A scheduler, which is notified of a tick's changes and may skip work that has no effect.
///
/// By default, it skips nothing, and a tick follows the cycle of `spec/01` §4.
pub(crate) trait Scheduler: Watcher + Sized {
    /// Called before the updates of a tick.
    fn begin(_: &mut Step<'_, Self>) {}

    /// Updates all sprites except the avatar.
    fn update_all(step: &mut Step<'_, Self>) {
        for &stype in step.rules.order.iter().rev() {
            step.update_type(stype);
            if step.stopped.is_some() {
                return;
            }
        }
    }

    /// Returns the next event-phase pass with an index of at least `from`; `None` if there is no such pass.
    fn next_pass(step: &Step<'_, Self>, from: usize) -> Option<usize> {
        Some(from).filter(|&number| number < step.rules.passes.len())
    }

    /// Runs a pass. Sprites whose creation number is `newborn` or higher do not take part.
    fn run_pass(step: &mut Step<'_, Self>, pass: &Pass, newborn: u32, watch: &mut (impl Watch + ?Sized)) {
        step.visit_first_side(pass, newborn, watch);
    }

    /// Returns `true` if a sprite with the type bit `own` may share a cell with a sprite that has any of the
    /// type bits `others`.
    fn may_meet(&self, _world: &World, _own: u64, _others: u64) -> bool {
        true
    }

    /// Called before a pass compares two sprites that may overlap.
    fn meets(_: &mut Step<'_, Self>, _one: Slot, _two: Slot) {}

    /// Called before an effect runs on a sprite and its partners.
    fn executes(_: &mut Step<'_, Self>, _: &EffectInfo, _one: Slot, _partners: &[Slot]) {}

    /// Called before an operation that may change anything anywhere.
    fn unsettles(_: &mut Step<'_, Self>) {}

    /// Moves a sprite to a different rectangle.
    fn relocates(step: &mut Step<'_, Self>, slot: Slot, rect: Rect) {
        step.relocate(slot, rect);
    }

    /// Called before a sprite's last rectangle is set.
    fn changes(_: &mut Step<'_, Self>, _: Slot) {}

    /// Called after a sprite has been created.
    fn made(_: &mut Step<'_, Self>, _: Slot) {}

    /// Called before a killed sprite is removed.
    fn removes(_: &mut Step<'_, Self>, _: Slot) {}

    /// Called after the killed sprites have been removed.
    fn ends(_: &mut Step<'_, Self>) {}
}

/// A scheduler that skips nothing.
pub(crate) struct Unscheduled;

impl Scheduler for Unscheduled {}

impl Watcher for Unscheduled {}
