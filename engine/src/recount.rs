//! A recount of everything that a state maintains incrementally: chains, cells, counts and lists. For tests and fuzzing.

use crate::game::Game;
use crate::geometry::Rect;
use crate::sleep::mark;
use crate::state::{Group, NONE, Slot, Sprite, State, flag};

impl State {
    /// Compares everything that is maintained incrementally with a count from scratch. Returns the number of sprites of
    /// each type. Cost: O(sprites + cells).
    ///
    /// # Errors
    /// The first difference, in words.
    #[doc(hidden)]
    pub fn recount(&self, game: &Game) -> Result<Vec<usize>, String> {
        let mut alive = vec![false; self.sprites.len()];
        let mut counts = Vec::new();
        for stype in game.sprite_types() {
            let counted = self.recount_group(game, stype, &mut alive)?;
            let kept = self.group(stype);
            if counted != *kept {
                return Err(format!("`{}`: counted {counted:?}, kept {kept:?}", game.name(stype)));
            }
            counts.push(usize::from(counted.count));
        }
        self.recount_cells(game, &alive)?;
        self.recount_contacts(game)?;
        self.recount_lists(game, &alive)?;
        Ok(counts)
    }

    /// The flags of how a sprite lies in its cell; see `occupancy.rs`.
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

    /// Tests whether a sprite in flight is within the cells in which it is entered, and whether its screen flag is right.
    fn is_in_its_lane(&self, slot: Slot) -> bool {
        let present = self.present(slot);
        let place = |at: i32, cells: i32| at.div_euclid(self.block).clamp(-1, cells) + 1;
        let within = |at: i32, size: i32, cells: i32, cell: i16, more: bool| {
            let (first, last) = (place(at, cells), place(at.saturating_add(size.saturating_sub(1)), cells));
            i32::from(cell) <= first && last.max(first) <= i32::from(cell) + i32::from(more)
        };
        let Rect { x, y, w, h } = present.rect;
        within(x, w, self.columns, present.column, present.is(flag::RIGHT))
            && within(y, h, self.rows, present.row, present.is(flag::BELOW))
            && present.is(flag::OFF) != self.screen().contains(present.rect)
            && !present.is(flag::BIG)
    }

    /// Recounts the types that share cells and the resulting possible rules.
    fn recount_contacts(&self, game: &Game) -> Result<(), String> {
        let fresh = self.contacts_from_scratch(&game.0);
        let contacts = |state: &State| {
            let crowds: Vec<u64> = (0..state.cells.len()).map(|cell| state.crowds_in(cell)).collect();
            let State { masks, together, meets, reasons, possible, big, off, .. } = state;
            format!("{masks:?} {crowds:?} {together:?} {meets:?} {reasons:?} {possible:?} {big} {off}")
        };
        let (kept, counted) = (contacts(self), contacts(&fresh));
        if kept != counted {
            return Err(format!("contacts: counted {counted}, kept {kept}"));
        }
        let bits = |state: &State| {
            let few = [state.multi_cell_bits, state.big_bits, state.vast];
            few.into_iter().chain(state.covered.iter().copied()).collect::<Vec<u64>>()
        };
        // These bits may contain too many types, but never too few.
        if bits(&fresh).iter().zip(bits(self)).any(|(&fresh, kept)| fresh & !kept != 0) {
            return Err("contacts: a sprite in several cells is not known as one".to_owned());
        }
        if !self.touched.is_empty() {
            return Err("contacts: something is left over from the last event phase".to_owned());
        }
        Ok(())
    }

    /// Walks the chain of a type.
    fn recount_group(
        &self,
        game: &Game,
        stype: crate::SpriteType,
        alive: &mut [bool],
    ) -> Result<Group, String> {
        let kept = self.group(stype);
        let scenery = self.scenery_of(stype).len() as u16;
        let mut counted = Group { head: kept.head, count: scenery, ..Group::EMPTY };
        for slot in self.slots(stype) {
            let sprite = self.sprite(slot);
            let name = game.name(stype);
            if std::mem::replace(&mut alive[usize::from(slot)], true) || sprite.is(flag::FREE) {
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
            counted.skipped += u16::from(sprite.activity & mark::SKIPPED != 0);
            let correct = match sprite.flies() {
                true => self.is_in_its_lane(slot),
                false => self.recounted_flags(sprite) == sprite.flags & flag::PLACEMENT,
            };
            if !correct {
                return Err(format!("slot {slot} of `{name}` covers other cells than its flags say"));
            }
        }
        if counted.tail != kept.tail {
            return Err(format!(
                "`{}`: the chain ends at {}, not {}",
                game.name(stype),
                counted.tail,
                kept.tail
            ));
        }
        Ok(counted)
    }

    /// Walks the chain of every cell: each sprite of a type that takes part in rules is once in the cell of its corner.
    fn recount_cells(&self, game: &Game, alive: &[bool]) -> Result<(), String> {
        let mut seen = vec![false; alive.len()];
        for (cell, &head) in self.cells.iter().enumerate() {
            let (mut slot, mut previous) = (head, NONE);
            while slot != NONE {
                let sprite = self.sprite(slot);
                if std::mem::replace(&mut seen[usize::from(slot)], true) || sprite.cell_previous != previous {
                    return Err(format!("slot {slot} is out of place in the chain of cell {cell}"));
                }
                let column = sprite.rect.x.div_euclid(self.block).clamp(-1, self.columns) + 1;
                let row = sprite.rect.y.div_euclid(self.block).clamp(-1, self.rows) + 1;
                let place = (i32::from(sprite.column), i32::from(sprite.row));
                // The cells of sprites in flight have been checked already.
                let correct = place == (column, row) || sprite.flies();
                if !correct || (place.1 * (self.columns + 2) + place.0) as usize != cell {
                    return Err(format!("slot {slot} is at ({column}, {row}), not in cell {cell}"));
                }
                (slot, previous) = (sprite.cell_next, slot);
            }
        }
        let takes_part = |sprite: &Sprite| game.0.contacts.kinds[sprite.stype.index()].own != 0;
        let expected = |(at, &alive): (usize, &bool)| alive && takes_part(&self.sprites[at]);
        if !alive.iter().enumerate().map(expected).eq(seen) {
            Err("the cells hold other sprites than the types".to_owned())
        } else {
            Ok(())
        }
    }

    /// Checks the free list, the list of moved sprites, resources and extras.
    fn recount_lists(&self, game: &Game, alive: &[bool]) -> Result<(), String> {
        let mut free = self.free;
        let mut holes = 0;
        while free != NONE {
            if alive[usize::from(free)] || holes > self.sprites.len() {
                return Err(format!("slot {free} is in the free list and in use, or the list is a ring"));
            }
            (holes, free) = (holes + 1, self.sprite(free).next);
        }
        let used = alive.iter().filter(|&&alive| alive).count();
        if used + holes != self.sprites.len() {
            return Err(format!("{used} slots in use and {holes} free ones make not {}", self.sprites.len()));
        }
        let mut moved: Vec<Slot> = self.moved.clone();
        moved.sort_unstable();
        let marked = (0..self.sprites.len()).filter(|&at| alive[at] && self.sprites[at].is(flag::MOVED));
        if !marked.map(|at| at as Slot).eq(moved.iter().copied()) {
            return Err(format!("the list of those that moved is {moved:?}"));
        }
        for (at, sprite) in self.sprites.iter().enumerate().filter(|&(at, _)| alive[at]) {
            let flies = self.flights.iter().filter(|flight| usize::from(flight.slot) == at).count();
            let sleepers = self.sleepers.iter().filter(|sleeper| usize::from(sleeper.slot) == at).count();
            let expected = (usize::from(sprite.flies()), usize::from(sprite.activity == mark::SLEEPING));
            if (flies, sleepers) != expected {
                return Err(format!("slot {at} flies {flies} and sleeps {sleepers} times, not {expected:?}"));
            }
            let resized = self.resized.iter().filter(|one| usize::from(one.slot) == at).count();
            let is_resized = sprite.is(flag::RESIZED);
            if resized != usize::from(is_resized) || is_resized && !sprite.is(flag::MOVED) {
                return Err(format!("slot {at} was resized {resized} times, or has not moved"));
            }
            if !sprite.is_back() && !sprite.is(flag::MOVED) && flies == 0 {
                return Err(format!("slot {at} moved and is not in the list"));
            }
            let is_avatar = game.class(sprite.stype).is_some_and(crate::SpriteClass::is_avatar);
            if is_avatar && !sprite.is(flag::FROZEN) && at != usize::from(self.avatar) {
                return Err(format!(
                    "slot {at} is an avatar that the player does not control, and is still updated"
                ));
            }
            if sprite.is(flag::KILLED) || sprite.is(flag::DIRTY) != self.dirty.contains(&(at as Slot)) {
                return Err(format!("slot {at} was left half-way by the last step"));
            }
            let overrides = self.overrides_of(sprite);
            let is_own = overrides.holder != NONE;
            if is_own != (usize::from(sprite.overrides) >= game.0.types.len())
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
        if holders.clone().count() + game.0.types.len() != self.overrides.len() {
            return Err("the overrides of the types are not in their place".to_owned());
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
            Some(slot) => Err(format!("slot {slot} is gone and still holds something")),
            None => Ok(()),
        }
    }
}
