//! The work that a tick may skip without changing the result (`docs/lab/decisions/0005-foreseen-sprites.md`).

mod contacts;
mod flight;
mod foresight;
mod passes;
mod recount;
mod sleep;
mod updates;

use crate::flat::flat;
use crate::rules::{Rules, SpriteType};
use crate::tick::Step;
use crate::world::{Models, Slot, World};
pub(crate) use contacts::Contacts;
pub(crate) use flight::Flight;
pub(crate) use foresight::Foresight;
use sleep::shortcuts;
pub(crate) use sleep::{Shortcuts, Sleeper, mark};
use updates::{Mover, movers};

flat! {
    /// The work that the next ticks may skip.
    pub(crate) struct Schedule {
        copied {}
        numbers {
            /// The tick in which the next sprite in flight is due.
            next_due: i32,
        }
        buffers {
            /// For each pair of type bits (`contacts.rs`), the number of cells whose mask contains both.
            together: u16,
            /// For each type bit, the type bits that share a cell with it anywhere.
            meets: u64,
            /// For each pass, the number of reasons to examine the pass.
            reasons: u16,
            /// The passes with at least one reason, as a bit set.
            possible: u64,
            /// The sleeping sprites, whose updates are skipped (`sleep.rs`).
            sleepers: Sleeper,
            /// For each cell, the number of sleeping (skipped) sprites that watch the cell. Empty for games in which
            /// sprites cannot sleep.
            watched: u8,
            /// For each cell, the tick of the last permanent change, or the tick until which a sprite flies there
            /// (moves without updates). Empty for games in which sprites cannot sleep.
            stamps: i16,
            /// The sprites in flight (`flight.rs`).
            flights: Flight,
            /// For each type, the number of its sprites that are asleep or in flight. Empty for games in
            /// which sprites can neither sleep nor fly.
            skipped: u16,
        }
        scratch {
            /// The watched cells that a sprite has entered or left during a step.
            touched: u32,
        }
        shared {}
    }
}

/// A game's shortcuts, derived from its rules.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The types whose sprites can do something in their updates, in update order.
    movers: Vec<Mover>,
    /// The tables from which the possible passes are derived, given the types that share cells.
    pub(crate) contacts: Contacts,
    /// Each type's shortcuts.
    pub(crate) shortcuts: Vec<Shortcuts>,
    /// `true` if there is a type whose sprites may sleep, which means that their updates are skipped.
    pub(crate) any_sleep: bool,
    /// `true` if there is a type whose sprites may fly (see `flight.rs`).
    pub(crate) any_fly: bool,
}

impl Plan {
    /// Derives a game's shortcuts. Cost: O(types² + passes × size of the largest trees).
    pub(crate) fn of(rules: &Rules, models: &Models) -> Plan {
        let shortcuts = shortcuts(&rules.types, &rules.passes, &rules.effects);
        Plan {
            movers: movers(rules, &shortcuts),
            contacts: Contacts::of(rules, models),
            any_sleep: shortcuts.iter().any(|of_type| of_type.sleeps),
            any_fly: shortcuts.iter().any(|of_type| of_type.flies),
            shortcuts,
        }
    }
}

impl Schedule {
    /// Returns the schedule for a world in which no sprite sleeps or flies, so that no updates are skipped. Cost:
    /// O(sprites + cells).
    pub(crate) fn of(plan: &Plan, models: &Models, world: &mut World) -> Schedule {
        let mut schedule = Schedule::empty(plan, world);
        let mut foresight = Foresight::new(plan, &mut schedule, world);
        world.reoccupy(models, &mut foresight);
        schedule
    }

    /// Wakes and lands all sprites between two steps.
    pub(crate) fn suspend(step: &mut Step<'_, Foresight<'_>>) {
        step.scheduler.wake_all(step.world);
        step.land_all(step.world.tick());
        (0..step.world.slot_count() as Slot).for_each(|slot| *step.world.activity(slot) = mark::NOTHING);
    }

    /// Returns the schedule for a world without sprites.
    pub(crate) fn empty(plan: &Plan, world: &World) -> Schedule {
        // Games without shortcuts do not pay for these tables.
        let cells = if plan.any_sleep { World::cell_count(world.columns(), world.rows()) } else { 0 };
        let types = if plan.any_sleep || plan.any_fly { world.groups().len() } else { 0 };
        let mut schedule = Schedule {
            next_due: i32::MAX,
            together: Vec::new(),
            meets: Vec::new(),
            reasons: Vec::new(),
            possible: Vec::new(),
            sleepers: Vec::new(),
            watched: vec![0; cells],
            stamps: vec![-1; cells],
            flights: Vec::new(),
            skipped: vec![0; types],
            touched: Vec::new(),
        };
        schedule.empty_contacts(&plan.contacts);
        schedule
    }

    /// Returns the number of a type's sprites that are asleep or in flight, and whose updates are skipped.
    #[inline(always)]
    pub(crate) fn skipped_of(&self, stype: SpriteType) -> u16 {
        self.skipped.get(stype.index()).copied().unwrap_or(0)
    }

    /// Returns the slots of the sprites in flight.
    pub(crate) fn flying(&self) -> impl Iterator<Item = Slot> {
        self.flights.iter().map(|flight| flight.slot)
    }
}
