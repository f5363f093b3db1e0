//! A scheduler that skips work that has no effect. The table lists all work that it skips, with the reason.
//!
//! | Skipped | Because | Where |
//! |---|---|---|
//! | a pass of the event phase | no two sprites of its sides share a cell, so no sprites overlap | `contacts.rs` |
//! | a type within a pass | it shares no cell with the other side | `contacts.rs` |
//! | the first side of a pass | the effect allows hits to be found from the other side and executed in the
//! same order | `passes.rs` |
//! | an update that would not move the sprite | its speed, cooldown or class says so; draws are still made | `updates.rs` |
//! | an update in which a producer only draws a random number | the draw is made, and it is too high to
//! create a sprite | `updates.rs` |
//! | updates of a sprite that flies straight on | its position follows from the tick; it lands before anything else happens to it | `flight.rs` |
//! | updates of a sprite that the same rule moves back every time | nothing entered or left its cells; whatever does wakes it | `sleep.rs` |
//!
//! Nothing else is skipped. Unforeseeable events (timers, effects on distant sprites, and a stopped tick)
//! wake and land all sprites: see [`Scheduler::unsettles`]. Tests compare every tick with
//! [`Unscheduled`](crate::tick::Unscheduled), on all games and on random games.
//! `docs/lab/decisions/0005-foreseen-sprites.md` documents the cost and the gain of each shortcut.

use super::{Plan, Schedule, updates};
use crate::numbers::geometry::Rect;
use crate::rules::{EffectInfo, Pass};
use crate::tick::{Scheduler, Step, Watch};
use crate::world::{Slot, Watcher, World};

/// A schedule in use during a step.
pub(crate) struct Foresight<'a> {
    pub(super) plan: &'a Plan,
    pub(super) schedule: &'a mut Schedule,
    /// `true` if sprites may sleep in this step, which means that their updates are skipped.
    pub(super) sleeps: bool,
    /// `true` if sprites may fly in this step.
    pub(super) flies: bool,
    /// `true` if any sprite whose updates may be skipped has moved by itself.
    pub(super) any_moved: bool,
}

impl<'a> Foresight<'a> {
    /// Returns the scheduler for a step that starts with this world. Without an avatar, no sprite sleeps (is skipped),
    /// because a rule with a score would then stop the game.
    pub(crate) fn new(plan: &'a Plan, schedule: &'a mut Schedule, world: &World) -> Foresight<'a> {
        let sleeps = plan.any_sleep && world.has_avatar();
        Foresight { plan, schedule, sleeps, flies: plan.any_fly, any_moved: false }
    }
}

impl Scheduler for Foresight<'_> {
    #[inline(always)]
    fn begin(step: &mut Step<'_, Self>) {
        if !step.scheduler.sleeps && !step.scheduler.schedule.sleepers.is_empty() {
            step.scheduler.wake_all(step.world);
        }
        step.fly();
        step.wake();
    }

    #[inline(always)]
    fn update_all(step: &mut Step<'_, Self>) {
        updates::update_all(step);
    }

    #[inline(always)]
    fn next_pass(step: &Step<'_, Self>, from: usize) -> Option<usize> {
        step.scheduler.schedule.next_possible(from)
    }

    #[inline(always)]
    fn run_pass(step: &mut Step<'_, Self>, pass: &Pass, newborn: u32, watch: &mut (impl Watch + ?Sized)) {
        if step.is_second_side_smaller(pass) {
            step.visit_second_side(pass, newborn, watch);
        } else {
            step.visit_first_side(pass, newborn, watch);
        }
    }

    #[inline(always)]
    fn may_meet(&self, world: &World, own: u64, others: u64) -> bool {
        self.schedule.may_meet(world, own, others)
    }

    #[inline(always)]
    fn meets(step: &mut Step<'_, Self>, one: Slot, two: Slot) {
        step.land_one(one);
        step.land_one(two);
    }

    #[inline(always)]
    fn executes(step: &mut Step<'_, Self>, info: &EffectInfo, one: Slot, partners: &[Slot]) {
        if step.scheduler.flies {
            step.foresee(info, one, partners);
        }
    }

    fn unsettles(step: &mut Step<'_, Self>) {
        step.wake_and_land_all();
    }

    #[inline(always)]
    fn relocates(step: &mut Step<'_, Self>, slot: Slot, rect: Rect) {
        if step.scheduler.sleeps {
            step.relocate_noisily(slot, rect);
        } else {
            step.relocate(slot, rect);
        }
    }

    #[inline(always)]
    fn changes(step: &mut Step<'_, Self>, slot: Slot) {
        if step.scheduler.sleeps {
            step.stamp(slot);
        }
    }

    #[inline(always)]
    fn made(step: &mut Step<'_, Self>, slot: Slot) {
        if step.scheduler.sleeps {
            step.touch(slot);
            step.stamp(slot);
            step.wake();
        }
    }

    #[inline(always)]
    fn removes(step: &mut Step<'_, Self>, slot: Slot) {
        if step.scheduler.sleeps {
            step.touch(slot);
            step.stamp(slot);
        }
    }

    #[inline(always)]
    fn ends(step: &mut Step<'_, Self>) {
        step.wake();
        step.sleep_or_fly();
    }
}

impl Watcher for Foresight<'_> {
    #[inline(never)]
    fn arrives(&mut self, own: u64, partners: u64) {
        self.schedule.arrives(&self.plan.contacts, own, partners);
    }

    #[inline(never)]
    fn departs(&mut self, own: u64, partners: u64) {
        self.schedule.departs(&self.plan.contacts, own, partners);
    }

    fn enlarged(&mut self, stype: usize) {
        self.schedule.enlarged(&self.plan.contacts, stype);
    }

    fn reduced(&mut self, stype: usize) {
        self.schedule.reduced(&self.plan.contacts, stype);
    }
}
