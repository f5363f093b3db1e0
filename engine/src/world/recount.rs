//! Recounts all incrementally maintained parts of a world (chains, cells, counts and lists), for tests and
//! fuzzing.

use super::fixtures::mirrored;
use super::{Group, Models, NONE, Slot, Sprite, World, flag};
use crate::numbers::geometry::Rect;
use crate::rules::class::SpriteClass;
use crate::rules::{Rules, SpriteType};

impl World {
    /// Compares all incrementally maintained values with values counted from scratch. Returns the number of
    /// sprites of each type. Cost: O(sprites + cells).
    ///
    /// # Errors
    /// Returns a message that describes the first difference.
    pub(crate) fn recount(&self, rules: &Rules, models: &Models) -> Result<Vec<usize>, String> {
        let mut alive = vec![false; self.sprites.len() + self.fixture_count()];
        let mut counts = Vec::new();
        for stype in (0..rules.types.len() as u16).map(SpriteType) {
            let counted = self.recount_group(rules, stype, &mut alive)?;
            let kept = self.group(stype);
            if counted != *kept {
                let name = &rules.types[stype.index()].name;
                return Err(format!("`{name}`: counted {counted:?}, kept {kept:?}"));
            }
            counts.push(usize::from(counted.count));
        }
        self.recount_cells(models, &alive)?;
        self.recount_masks(models)?;
        self.recount_lists(rules, &alive[..self.sprites.len()])?;
        Ok(counts)
    }

    /// Compares the types in each cell with those in the same cell of a world whose cells are filled from
    /// scratch.
    fn recount_masks(&self, models: &Models) -> Result<(), String> {
        let mut fresh = self.clone();
        fresh.reoccupy(models, &mut ());
        let masks = |world: &World| {
            let crowds: Vec<u64> = (0..world.cells.len()).map(|cell| world.crowds_in(cell)).collect();
            format!("{:?} {crowds:?} {} {}", world.masks, world.big, world.off)
        };
        let (kept, counted) = (masks(self), masks(&fresh));
        if kept != counted {
            return Err(format!("types by cell: {counted} counted, but {kept} stored"));
        }
        let bits = |world: &World| {
            let few = [world.multi_cell_bits, world.big_bits, world.vast];
            few.into_iter().chain(world.covered.iter().copied()).collect::<Vec<u64>>()
        };
        // These bit sets may contain too many types, but never too few.
        if bits(&fresh).iter().zip(bits(self)).any(|(&fresh, kept)| fresh & !kept != 0) {
            return Err("a sprite that covers several cells is not recorded as such".to_owned());
        }
        Ok(())
    }

    /// Returns the flags that describe how a sprite lies in its cell: see `occupancy.rs`.
    fn recounted_flags(&self, sprite: &Sprite) -> u32 {
        let Rect { x, y, w, h } = sprite.rect;
        let over = |at: i32, size: i32, cell: i16, cells: i32| {
            let last = at.saturating_add(size.saturating_sub(1)).div_euclid(self.block).clamp(-1, cells) + 1;
            last > i32::from(cell)
        };
        let off = if self.screen().contains(sprite.rect) { 0 } else { flag::OFF };
        if w > self.block || h > self.block {
            return off | flag::BIG;
        }
        let right = if over(x, w, sprite.column, self.columns) { flag::RIGHT } else { 0 };
        off | right | if over(y, h, sprite.row, self.rows) { flag::BELOW } else { 0 }
    }

    /// Returns a slot's index in lists of all sprites, in which fixtures (sprites that never change) come last.
    fn counted_at(&self, slot: Slot) -> usize {
        match usize::from(slot) {
            slot if slot < self.sprites.len() => slot,
            slot => self.sprites.len() + mirrored(slot),
        }
    }

    /// Walks the chain of a type's sprites, and checks every sprite in it.
    fn recount_group(&self, rules: &Rules, stype: SpriteType, alive: &mut [bool]) -> Result<Group, String> {
        let kept = self.group(stype);
        let scenery = self.scenery_of(stype).len() as u16;
        let mut counted = Group { head: kept.head, count: scenery, ..Group::EMPTY };
        for slot in self.slots(stype) {
            let sprite = self.sprite(slot);
            let name = &rules.types[stype.index()].name;
            if std::mem::replace(&mut alive[self.counted_at(slot)], true) || sprite.is(flag::FREE) {
                return Err(format!("slot {slot} of `{name}` is in two chains, or free"));
            }
            let ordered = counted.tail == NONE || self.sprite(counted.tail).id < sprite.id;
            if sprite.previous != counted.tail || sprite.stype != stype || !ordered {
                return Err(format!("slot {slot} is out of place in the chain of `{name}`"));
            }
            counted.tail = slot;
            counted.count += 1;
            counted.disabled += u16::from(sprite.is(flag::DISABLED));
            counted.multi_cell += u16::from(sprite.is(flag::MULTI_CELL));
            counted.big += u16::from(sprite.is(flag::BIG));
            counted.off += u16::from(sprite.is(flag::OFF));
            let correct = self.recounted_flags(&self.present(slot)) == sprite.flags & flag::PLACEMENT;
            if !correct {
                return Err(format!("slot {slot} of `{name}` does not cover the cells that its flags state"));
            }
        }
        if counted.tail != kept.tail {
            return Err(format!(
                "`{}`: the chain ends at {}, not {}",
                &rules.types[stype.index()].name,
                counted.tail,
                kept.tail
            ));
        }
        Ok(counted)
    }

    /// Walks every cell's chain. Each sprite of a type that takes part in rules must be in the cell of its
    /// corner exactly once.
    fn recount_cells(&self, models: &Models, alive: &[bool]) -> Result<(), String> {
        let mut seen = vec![false; alive.len()];
        for (cell, &head) in self.cells.iter().enumerate() {
            let (mut slot, mut previous) = (head, NONE);
            while slot != NONE {
                let sprite = self.sprite(slot);
                let at = self.counted_at(slot);
                let is_linked_back = sprite.cell_previous == previous || at >= self.sprites.len();
                if std::mem::replace(&mut seen[at], true) || !is_linked_back {
                    return Err(format!("slot {slot} is out of place in the chain of cell {cell}"));
                }
                let Rect { x, y, .. } = self.rect(sprite);
                let (column, row) = (self.column(x), self.row(y));
                let place = (i32::from(sprite.column), i32::from(sprite.row));
                if place != (column, row) || (place.1 * (self.columns + 2) + place.0) as usize != cell {
                    return Err(format!("slot {slot} is at ({column}, {row}), not in cell {cell}"));
                }
                (slot, previous) = (sprite.cell_next, slot);
            }
        }
        let takes_part = |sprite: &Sprite| models.bit(sprite.stype) != 0;
        let sprites = self.sprites.iter().chain(self.all_fixtures());
        if !alive.iter().zip(sprites).map(|(&alive, sprite)| alive && takes_part(sprite)).eq(seen) {
            Err("the lists by cell and the lists by type contain different sprites".to_owned())
        } else {
            Ok(())
        }
    }

    /// Checks the free list, the list of moved sprites, the resources and the extra values.
    fn recount_lists(&self, rules: &Rules, alive: &[bool]) -> Result<(), String> {
        let mut free = self.free;
        let mut holes = 0;
        while free != NONE {
            if alive[usize::from(free)] || holes > self.sprites.len() {
                return Err(format!(
                    "slot {free} is in use but on the free list, or the free list has a cycle"
                ));
            }
            (holes, free) = (holes + 1, self.sprite(free).next);
        }
        let used = alive.iter().filter(|&&alive| alive).count();
        if used + holes != self.sprites.len() {
            return Err(format!(
                "{used} used slots and {holes} free slots do not add up to {}",
                self.sprites.len()
            ));
        }
        let mut moved: Vec<Slot> = self.moved.clone();
        moved.sort_unstable();
        let marked = (0..self.sprites.len()).filter(|&at| alive[at] && self.sprites[at].is(flag::MOVED));
        if !marked.map(|at| at as Slot).eq(moved.iter().copied()) {
            return Err(format!("the list of moved sprites is {moved:?}"));
        }
        for (at, sprite) in self.sprites.iter().enumerate().filter(|&(at, _)| alive[at]) {
            let resized = self.resized.iter().filter(|one| usize::from(one.slot) == at).count();
            let is_resized = sprite.is(flag::RESIZED);
            if resized != usize::from(is_resized) || is_resized && !sprite.is(flag::MOVED) {
                return Err(format!("slot {at} was resized {resized} times, or has not moved"));
            }
            if !sprite.is_back() && !sprite.is(flag::MOVED) && !sprite.flies() {
                return Err(format!("slot {at} moved and is not in the list"));
            }
            let is_avatar = rules.types[sprite.stype.index()].class.is_some_and(SpriteClass::is_avatar);
            if is_avatar && !sprite.is(flag::FROZEN) && at != usize::from(self.avatar) {
                return Err(format!(
                    "slot {at} is an avatar that the player does not control, and is still updated"
                ));
            }
            if sprite.is(flag::KILLED) || sprite.is(flag::DIRTY) != self.dirty.contains(&(at as Slot)) {
                return Err(format!("the last step left slot {at} partly updated"));
            }
            let overrides = self.overrides_of(sprite);
            let is_own = overrides.holder != NONE;
            if is_own != (usize::from(sprite.overrides) >= rules.types.len())
                || is_own && usize::from(overrides.holder) != at
            {
                return Err(format!("the overrides of slot {at} belong to slot {}", overrides.holder));
            }
            let extra = self.extra_of(sprite).map(|extra| usize::from(extra.holder));
            if extra != (overrides.extra != NONE).then_some(at) {
                return Err(format!("the extra of slot {at} belongs to {extra:?}"));
            }
        }
        let holders =
            self.overrides.iter().map(|overrides| overrides.holder).filter(|&holder| holder != NONE);
        if holders.clone().count() + rules.types.len() != self.overrides.len() {
            return Err(
                "the number of overrides does not match the types and the sprites with their own values"
                    .to_owned(),
            );
        }
        if let Some(holder) = holders.clone().find(|&holder| self.overrides(holder).holder != holder) {
            return Err(format!("slot {holder} has overrides that it does not use"));
        }
        if !self.resized.is_sorted_by_key(|one| one.slot) {
            return Err("the list of resized sprites is out of order".to_owned());
        }
        if !self.held.is_sorted_by_key(|held| (held.holder, held.resource)) {
            return Err("the list of held resources is out of order".to_owned());
        }
        let mut holders = self
            .held
            .iter()
            .map(|held| held.holder)
            .chain(self.extras.iter().map(|e| e.holder))
            .chain(holders);
        match holders.find(|&slot| !alive[usize::from(slot)]) {
            Some(slot) => Err(format!("slot {slot} is free, but still has resources or values of its own")),
            None => Ok(()),
        }
    }
}
