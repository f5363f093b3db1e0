//! Side tables for data about single sprites: held resources, and replaced entries in the lists of types to
//! create. Few sprites have such data, so it is stored in two sorted lists in the state.

use crate::flat::bytes_of_fields;
use crate::rules::{Rules, SpriteType};
use crate::world::{Slot, World};

/// The amount of a resource that a sprite holds. Entries remain when the amount is 0 (`spec/02` §1.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Held {
    pub(crate) holder: Slot,
    pub(crate) resource: SpriteType,
    pub(crate) amount: i32,
}

bytes_of_fields! { Held { holder resource amount } }

/// A replaced entry in a BomberRandomMissile's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Replaced {
    pub(crate) holder: Slot,
    /// The position in the list.
    pub(crate) place: u16,
    pub(crate) stype: SpriteType,
}

bytes_of_fields! { Replaced { holder place stype } }

impl World {
    /// Finds the entry for a resource, or the index at which to insert it.
    fn find_held(&self, holder: Slot, resource: SpriteType) -> Result<usize, usize> {
        self.held.binary_search_by_key(&(holder, resource), |held| (held.holder, held.resource))
    }

    /// Returns the resource holdings of all sprites.
    pub(crate) fn held(&self) -> &[Held] {
        &self.held
    }

    /// Returns the amount of a resource that a sprite holds.
    pub(crate) fn amount(&self, holder: Slot, resource: SpriteType) -> i32 {
        self.find_held(holder, resource).map_or(0, |at| self.held[at].amount)
    }

    /// Adds to the amount of a resource that a sprite holds. The amount never drops below 0, and even an
    /// amount of 0 gets an entry.
    pub(crate) fn add_amount(&mut self, holder: Slot, resource: SpriteType, change: i32) {
        match self.find_held(holder, resource) {
            Ok(at) => self.held[at].amount = self.held[at].amount.wrapping_add(change).max(0),
            Err(at) => self.held.insert(at, Held { holder, resource, amount: change.max(0) }),
        }
    }

    /// Subtracts from the amount of a resource that a sprite holds. The amount may drop below 0.
    pub(crate) fn overdraw(&mut self, holder: Slot, resource: SpriteType, cost: i32) {
        if let Ok(at) = self.find_held(holder, resource) {
            self.held[at].amount = self.held[at].amount.saturating_sub(cost);
        }
    }

    /// Returns the resources that a sprite holds, sorted by resource.
    pub(crate) fn held_by(&self, holder: Slot) -> &[Held] {
        let start = self.held.partition_point(|held| held.holder < holder);
        let end = self.held.partition_point(|held| held.holder <= holder);
        &self.held[start..end]
    }

    /// Removes a sprite's entries when the sprite is released.
    #[inline]
    pub(crate) fn release_side_tables(&mut self, holder: Slot) {
        if !self.held.is_empty() {
            let count = self.held_by(holder).len();
            let start = self.held.partition_point(|held| held.holder < holder);
            self.held.drain(start..start + count);
        }
        if !self.replaced.is_empty() {
            let count = self.replaced_by(holder).len();
            let start = self.replaced.partition_point(|one| one.holder < holder);
            self.replaced.drain(start..start + count);
        }
    }

    /// Returns the type at a position in a BomberRandomMissile's list.
    pub(crate) fn missile(&self, rules: &Rules, slot: Slot, place: usize) -> SpriteType {
        let own = |_| rules.types[self.sprite(slot).stype.index()].traits.stypes[place];
        self.find_replaced(slot, place).map_or_else(own, |at| self.replaced[at].stype)
    }

    fn find_replaced(&self, slot: Slot, place: usize) -> Result<usize, usize> {
        self.replaced.binary_search_by_key(&(slot, place), |one| (one.holder, usize::from(one.place)))
    }

    /// Returns the replaced entries of a sprite's list.
    pub(crate) fn replaced_by(&self, slot: Slot) -> &[Replaced] {
        let start = self.replaced.partition_point(|one| one.holder < slot);
        let end = self.replaced.partition_point(|one| one.holder <= slot);
        &self.replaced[start..end]
    }

    /// Replaces the first entry of a BomberRandomMissile's list that equals `before`.
    pub(crate) fn replace_missile(
        &mut self,
        rules: &Rules,
        slot: Slot,
        before: SpriteType,
        stype: SpriteType,
    ) {
        let count = rules.types[self.sprite(slot).stype.index()].traits.stypes.len();
        let Some(place) = (0..count).find(|&place| self.missile(rules, slot, place) == before) else {
            return;
        };
        match self.find_replaced(slot, place) {
            Ok(at) => self.replaced[at].stype = stype,
            Err(at) => self.replaced.insert(at, Replaced { holder: slot, place: place as u16, stype }),
        }
    }
}
