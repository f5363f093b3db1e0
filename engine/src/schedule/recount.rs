//! Recounts all incrementally maintained parts of a schedule, for tests and fuzzing.

use super::{Foresight, Plan, Schedule, mark};
use crate::world::{Models, Slot, World, flag};

impl Schedule {
    /// Compares all incrementally maintained values with values counted from scratch. Cost: O(sprites +
    /// cells).
    ///
    /// # Errors
    /// Returns a message that describes the first difference.
    pub(crate) fn recount(&self, plan: &Plan, models: &Models, world: &World) -> Result<(), String> {
        if !self.touched.is_empty() {
            return Err("contacts: an entry is left over from the last event phase".to_owned());
        }
        let mut fresh = Schedule::empty(plan, world);
        world.clone().reoccupy(models, &mut Foresight::new(plan, &mut fresh, world));
        for slot in 0..world.slot_count() as Slot {
            let sprite = world.sprite(slot);
            let is_skipped = sprite.activity & mark::SKIPPED != 0 && !sprite.is(flag::FREE);
            let flights = self.flights.iter().filter(|flight| flight.slot == slot).count();
            let sleepers = self.sleepers.iter().filter(|sleeper| sleeper.slot == slot).count();
            if is_skipped {
                fresh.skipped[sprite.stype.index()] += 1;
            }
            let expected = (is_skipped && sprite.flies(), is_skipped && !sprite.flies());
            if (flights, sleepers) != (usize::from(expected.0), usize::from(expected.1)) {
                return Err(format!(
                    "slot {slot} flies {flights} and sleeps {sleepers} times, not {expected:?}"
                ));
            }
        }
        let contacts = |schedule: &Schedule| {
            let Schedule { together, meets, reasons, possible, skipped, .. } = schedule;
            format!("{together:?} {meets:?} {reasons:?} {possible:?} {skipped:?}")
        };
        let (kept, counted) = (contacts(self), contacts(&fresh));
        if kept != counted {
            return Err(format!("contacts: {counted} counted, but {kept} stored"));
        }
        Ok(())
    }
}
