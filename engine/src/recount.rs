//! A recount of everything that a state maintains incrementally: chains, cells, counts and lists. For tests and fuzzing.

use crate::game::Game;
use crate::geometry::Rect;
use crate::schedule::{Foresight, Schedule, mark};
use crate::state::State;
use crate::world::{Group, NONE, Slot, Sprite, World, flag};

impl State {
    /// Compares everything that is maintained incrementally with a count from scratch. Returns the number of sprites of
    /// each type. Cost: O(sprites + cells).
    ///
    /// # Errors
    /// The first difference, in words.
    #[doc(hidden)]
    pub fn recount(&self, game: &Game) -> Result<Vec<usize>, String> {
        let mut alive = vec![false; self.world.sprites.len()];
        let mut counts = Vec::new();
        for stype in game.sprite_types() {
            let counted = self.recount_group(game, stype, &mut alive)?;
            let kept = self.world.group(stype);
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
            let last =
                at.saturating_add(size.saturating_sub(1)).div_euclid(self.world.block).clamp(-1, cells) + 1;
            last > i32::from(cell)
        };
        let off = if self.world.screen().contains(sprite.rect) { 0 } else { flag::OFF };
        if w > self.world.block || h > self.world.block {
            return off | flag::BIG;
        }
        let right = if over(x, w, sprite.column, self.world.columns) { flag::RIGHT } else { 0 };
        off | right | if over(y, h, sprite.row, self.world.rows) { flag::BELOW } else { 0 }
    }

    /// Recounts the types that share cells and the resulting possible rules.
    fn recount_contacts(&self, game: &Game) -> Result<(), String> {
        let fresh = self.contacts_from_scratch(game);
        let contacts = |state: &State| {
            let State { world, schedule } = state;
            let crowds: Vec<u64> = (0..world.cells.len()).map(|cell| world.crowds_in(cell)).collect();
            let World { masks, big, off, .. } = world;
            let Schedule { together, meets, reasons, possible, skipped, .. } = schedule;
            format!(
                "{masks:?} {crowds:?} {together:?} {meets:?} {reasons:?} {possible:?} {skipped:?} {big} {off}"
            )
        };
        let (kept, counted) = (contacts(self), contacts(&fresh));
        if kept != counted {
            return Err(format!("contacts: counted {counted}, kept {kept}"));
        }
        let bits = |world: &World| {
            let few = [world.multi_cell_bits, world.big_bits, world.vast];
            few.into_iter().chain(world.covered.iter().copied()).collect::<Vec<u64>>()
        };
        // These bits may contain too many types, but never too few.
        if bits(&fresh.world).iter().zip(bits(&self.world)).any(|(&fresh, kept)| fresh & !kept != 0) {
            return Err("contacts: a sprite in several cells is not known as one".to_owned());
        }
        if !self.schedule.touched.is_empty() {
            return Err("contacts: something is left over from the last event phase".to_owned());
        }
        Ok(())
    }

    /// The same state, with the tables of cells and contacts computed from scratch. Cost: O(sprites + cells).
    fn contacts_from_scratch(&self, game: &Game) -> State {
        let mut state = self.clone();
        let models = &game.0.models;
        state.schedule =
            Schedule { flights: self.schedule.flights.clone(), ..Schedule::empty(&game.0.plan, &self.world) };
        let mut foresight = Foresight::new(&game.0.plan, &mut state.schedule, &self.world);
        state.world.reoccupy(models, &mut foresight);
        let skipped = game.sprite_types().flat_map(|stype| self.world.slots(stype));
        for sprite in skipped.map(|slot| self.world.sprite(slot)).filter(|s| s.activity & mark::SKIPPED != 0)
        {
            state.schedule.skipped[sprite.stype.index()] += 1;
        }
        state
    }

    /// Walks the chain of a type.
    fn recount_group(
        &self,
        game: &Game,
        stype: crate::SpriteType,
        alive: &mut [bool],
    ) -> Result<Group, String> {
        let kept = self.world.group(stype);
        let scenery = self.world.scenery_of(stype).len() as u16;
        let mut counted = Group { head: kept.head, count: scenery, ..Group::EMPTY };
        for slot in self.world.slots(stype) {
            let sprite = self.world.sprite(slot);
            let name = game.name(stype);
            if std::mem::replace(&mut alive[usize::from(slot)], true) || sprite.is(flag::FREE) {
                return Err(format!("slot {slot} of `{name}` is in two chains, or free"));
            }
            let ordered = counted.tail == NONE || self.world.sprite(counted.tail).id < sprite.id;
            if sprite.previous != counted.tail || sprite.stype != stype || !ordered {
                return Err(format!("slot {slot} is out of place in the chain of `{name}`"));
            }
            counted.tail = slot;
            counted.count += 1;
            counted.disabled += u16::from(sprite.is(flag::DISABLED));
            counted.multi_cell += u16::from(sprite.is(flag::MULTI_CELL));
            counted.big += u16::from(sprite.is(flag::BIG));
            counted.off += u16::from(sprite.is(flag::OFF));
            let correct = self.recounted_flags(&self.world.present(slot)) == sprite.flags & flag::PLACEMENT;
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
        for (cell, &head) in self.world.cells.iter().enumerate() {
            let (mut slot, mut previous) = (head, NONE);
            while slot != NONE {
                let sprite = self.world.sprite(slot);
                if std::mem::replace(&mut seen[usize::from(slot)], true) || sprite.cell_previous != previous {
                    return Err(format!("slot {slot} is out of place in the chain of cell {cell}"));
                }
                let Rect { x, y, .. } = self.world.rect(sprite);
                let (column, row) = (self.world.column(x), self.world.row(y));
                let place = (i32::from(sprite.column), i32::from(sprite.row));
                if place != (column, row) || (place.1 * (self.world.columns + 2) + place.0) as usize != cell {
                    return Err(format!("slot {slot} is at ({column}, {row}), not in cell {cell}"));
                }
                (slot, previous) = (sprite.cell_next, slot);
            }
        }
        let takes_part = |sprite: &Sprite| game.0.models.bit(sprite.stype) != 0;
        let expected = |(at, &alive): (usize, &bool)| alive && takes_part(&self.world.sprites[at]);
        if !alive.iter().enumerate().map(expected).eq(seen) {
            Err("the cells hold other sprites than the types".to_owned())
        } else {
            Ok(())
        }
    }

    /// Checks the free list, the list of moved sprites, resources and extras.
    fn recount_lists(&self, game: &Game, alive: &[bool]) -> Result<(), String> {
        let mut free = self.world.free;
        let mut holes = 0;
        while free != NONE {
            if alive[usize::from(free)] || holes > self.world.sprites.len() {
                return Err(format!("slot {free} is in the free list and in use, or the list is a ring"));
            }
            (holes, free) = (holes + 1, self.world.sprite(free).next);
        }
        let used = alive.iter().filter(|&&alive| alive).count();
        if used + holes != self.world.sprites.len() {
            return Err(format!(
                "{used} slots in use and {holes} free ones make not {}",
                self.world.sprites.len()
            ));
        }
        let mut moved: Vec<Slot> = self.world.moved.clone();
        moved.sort_unstable();
        let marked =
            (0..self.world.sprites.len()).filter(|&at| alive[at] && self.world.sprites[at].is(flag::MOVED));
        if !marked.map(|at| at as Slot).eq(moved.iter().copied()) {
            return Err(format!("the list of those that moved is {moved:?}"));
        }
        for (at, sprite) in self.world.sprites.iter().enumerate().filter(|&(at, _)| alive[at]) {
            let flies = self.schedule.flights.iter().filter(|flight| usize::from(flight.slot) == at).count();
            let sleepers =
                self.schedule.sleepers.iter().filter(|sleeper| usize::from(sleeper.slot) == at).count();
            let expected = (
                usize::from(sprite.flies()),
                usize::from(sprite.activity & mark::SKIPPED != 0 && !sprite.flies()),
            );
            if (flies, sleepers) != expected {
                return Err(format!("slot {at} flies {flies} and sleeps {sleepers} times, not {expected:?}"));
            }
            let resized = self.world.resized.iter().filter(|one| usize::from(one.slot) == at).count();
            let is_resized = sprite.is(flag::RESIZED);
            if resized != usize::from(is_resized) || is_resized && !sprite.is(flag::MOVED) {
                return Err(format!("slot {at} was resized {resized} times, or has not moved"));
            }
            if !sprite.is_back() && !sprite.is(flag::MOVED) && flies == 0 {
                return Err(format!("slot {at} moved and is not in the list"));
            }
            let is_avatar = game.class(sprite.stype).is_some_and(crate::SpriteClass::is_avatar);
            if is_avatar && !sprite.is(flag::FROZEN) && at != usize::from(self.world.avatar) {
                return Err(format!(
                    "slot {at} is an avatar that the player does not control, and is still updated"
                ));
            }
            if sprite.is(flag::KILLED) || sprite.is(flag::DIRTY) != self.world.dirty.contains(&(at as Slot)) {
                return Err(format!("slot {at} was left half-way by the last step"));
            }
            let overrides = self.world.overrides_of(sprite);
            let is_own = overrides.holder != NONE;
            if is_own != (usize::from(sprite.overrides) >= game.0.types.len())
                || is_own && usize::from(overrides.holder) != at
            {
                return Err(format!("the overrides of slot {at} belong to slot {}", overrides.holder));
            }
            let extra = self.world.extra_of(sprite).map(|extra| usize::from(extra.holder));
            if extra != (overrides.extra != NONE).then_some(at) {
                return Err(format!("the extra of slot {at} belongs to {extra:?}"));
            }
        }
        let holders =
            self.world.overrides.iter().map(|overrides| overrides.holder).filter(|&holder| holder != NONE);
        if holders.clone().count() + game.0.types.len() != self.world.overrides.len() {
            return Err("the overrides of the types are not in their place".to_owned());
        }
        if let Some(holder) = holders.clone().find(|&holder| self.world.overrides(holder).holder != holder) {
            return Err(format!("slot {holder} has overrides that it does not use"));
        }
        if !self.world.resized.is_sorted_by_key(|one| one.slot) {
            return Err("the list of resized sprites is out of order".to_owned());
        }
        if !self.world.held.is_sorted_by_key(|held| (held.holder, held.resource)) {
            return Err("the list of held resources is out of order".to_owned());
        }
        let mut holders = self
            .world
            .held
            .iter()
            .map(|held| held.holder)
            .chain(self.world.extras.iter().map(|e| e.holder))
            .chain(holders);
        match holders.find(|&slot| !alive[usize::from(slot)]) {
            Some(slot) => Err(format!("slot {slot} is gone and still holds something")),
            None => Ok(()),
        }
    }
}
