//! The numbers in a world that do not belong to a sprite: time, score, outcome, random number generators,
//! timers and the effects' memory.

use super::{NONE, Slot, Timer, World};
use crate::numbers::chance::Chance;
use crate::rules::{Action, Outcome, SpriteType};

/// Declares getters for copied fields.
macro_rules! readers {
    ($($(#[$doc:meta])* $field:ident: $Field:ty,)*) => {
        impl World {
            $($(#[$doc])*
            #[inline(always)]
            pub(crate) fn $field(&self) -> $Field {
                self.$field
            })*
        }
    };
}

readers! {
    /// Returns the number of ticks played, minus one.
    tick: i32,
    score: i64,
    outcome: Outcome,
    /// Returns the slot of the player's avatar, even if the avatar is disabled.
    avatar: Slot,
    /// Returns the cell size in pixels.
    block: i32,
    columns: i32,
    rows: i32,
    /// Returns the creation number of the next sprite.
    next_id: u32,
    /// Returns the reference's sprite counter, including its drift (`spec/03` §5.1).
    population: i32,
    /// Returns the number of messages logged so far.
    messages: u32,
    /// Returns `true` if counters can end the game.
    can_end: bool,
    /// Returns the number of sprites that are not completely on the screen.
    off: u32,
    /// Returns `true` if the sprite counts have changed since terminations were last checked.
    census_changed: bool,
}

impl World {
    /// Starts a tick with the player's action.
    pub(crate) fn start_tick(&mut self, action: Action) {
        self.tick += 1;
        self.last_action = action;
    }

    /// Ends the episode.
    pub(crate) fn end(&mut self, outcome: Outcome) {
        self.outcome = outcome;
    }

    /// Returns the last tick's action.
    pub(crate) fn last_action(&self) -> Action {
        self.last_action
    }

    pub(crate) fn set_outcome_and_action(&mut self, outcome: Outcome, action: Action) {
        (self.outcome, self.last_action) = (outcome, action);
    }

    /// Returns the random number generator.
    #[inline(always)]
    pub(crate) fn chance(&self) -> Chance {
        self.chance
    }

    /// Returns the random number generator, for drawing from it.
    #[inline(always)]
    pub(crate) fn dice(&mut self) -> &mut Chance {
        &mut self.chance
    }

    /// Returns the second random-number stream.
    pub(crate) fn jumps(&self) -> Chance {
        self.jumps
    }

    /// Returns the second random-number stream, for drawing from it.
    pub(crate) fn second_dice(&mut self) -> &mut Chance {
        &mut self.jumps
    }

    /// Replaces both random-number streams.
    pub(crate) fn reseed(&mut self, chance: Chance, jumps: Chance) {
        (self.chance, self.jumps) = (chance, jumps);
    }

    pub(crate) fn add_score(&mut self, change: i64) {
        self.score += change;
    }

    pub(crate) fn reset_score(&mut self) {
        self.score = 0;
    }

    /// Returns the game's counters.
    pub(crate) fn counters(&self) -> &[i32] {
        &self.counters
    }

    pub(crate) fn add_to_counter(&mut self, at: usize, change: i32) {
        self.counters[at] = self.counters[at].wrapping_add(change);
    }

    /// Counts messages that the reference would log.
    pub(crate) fn add_messages(&mut self, count: u32) {
        self.messages = self.messages.saturating_add(count);
    }

    pub(crate) fn forget_messages(&mut self) {
        self.messages = 0;
    }

    /// Records that terminations have read the current sprite counts, unless `look_again` requests another
    /// check.
    pub(crate) fn settle_census(&mut self, look_again: bool) {
        self.census_changed = look_again;
    }

    /// Sets whether counters can end the game. Returns `true` if the setting changes.
    pub(crate) fn permit_end(&mut self, can_end: bool) -> bool {
        std::mem::replace(&mut self.can_end, can_end) != can_end
    }

    /// Returns the scheduled timers, with the next one last.
    pub(crate) fn timers(&self) -> &[Timer] {
        &self.timers
    }

    /// Schedules a timer. It runs before all other timers that are due in the same tick (`spec/03` §6.2).
    pub(crate) fn plan(&mut self, timer: Timer) {
        let at = self.timers.partition_point(|other| other.due >= timer.due);
        self.timers.insert(at, timer);
    }

    /// Removes and returns the next due timer; `None` if no timer is due.
    pub(crate) fn take_due(&mut self) -> Option<Timer> {
        self.timers.pop_if(|timer| timer.due <= self.tick)
    }

    /// Returns an effect's memory: see [`crate::rules::memory`].
    #[inline(always)]
    pub(crate) fn memory(&self, effect: u16) -> u8 {
        self.memory[usize::from(effect)]
    }

    /// Sets or clears a bit in an effect's memory.
    pub(crate) fn remember(&mut self, effect: u16, bit: u8, on: bool) {
        let byte = &mut self.memory[usize::from(effect)];
        let before = std::mem::replace(byte, if on { *byte | bit } else { *byte & !bit });
        self.memory_is_dirty |= before != *byte;
    }

    /// Returns `true` if a sprite of a type has already been created.
    pub(crate) fn has_had(&self, stype: SpriteType) -> bool {
        self.templates[stype.index()] != 0
    }

    /// Records the creation of a sprite of a type. Returns `true` if it is the first of its type.
    pub(crate) fn is_first_of(&mut self, stype: SpriteType) -> bool {
        let first = std::mem::replace(&mut self.templates[stype.index()], 1) == 0;
        self.memory_is_dirty |= first;
        first
    }

    /// Makes a sprite the avatar. Returns the previous avatar.
    pub(crate) fn set_avatar(&mut self, slot: Slot) -> Slot {
        std::mem::replace(&mut self.avatar, slot)
    }

    /// Returns `true` if an avatar exists, even a disabled one.
    pub(crate) fn has_avatar(&self) -> bool {
        self.avatar != NONE
    }

    /// Adds a shield (the disabling of some interactions) for the rest of this tick.
    pub(crate) fn shield(&mut self, shield: (SpriteType, SpriteType, u16)) {
        if let Err(at) = self.shields.binary_search(&shield) {
            self.shields.insert(at, shield);
        }
    }

    /// Returns `true` if a shield has been added in this tick.
    #[inline]
    pub(crate) fn is_shielded(&self, shield: (SpriteType, SpriteType, u16)) -> bool {
        !self.shields.is_empty() && self.shields.binary_search(&shield).is_ok()
    }

    /// Records that an effect has pulled a sprite in this tick. Returns the previous number of entries, or
    /// `None` if the effect has already pulled the sprite.
    pub(crate) fn pull(&mut self, effect: u16, slot: Slot) -> Option<usize> {
        let at = self.pulled.binary_search(&(effect, slot)).err()?;
        self.pulled.insert(at, (effect, slot));
        Some(self.pulled.len() - 1)
    }

    /// Clears all data that is valid for one tick only.
    pub(crate) fn end_tick(&mut self) {
        self.shields.clear();
        self.pulled.clear();
    }
}
