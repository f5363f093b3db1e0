//! Fixtures: sprites that other sprites collide with, but that no rule creates, moves, changes or removes.
//! Most fixtures are walls.
//!
//! Fixtures stay where the level placed them for the whole episode, so all states of a level share them, and
//! copying a state does not copy them. Their slots are numbered downwards from the highest slot. The running
//! hash contains their contributions from the start. They come last in a cell's chain, so that no fixture
//! links to a sprite that is not a fixture.

use super::{Models, NONE, Slot, Sprite, Watcher, World};
use crate::world::hash::contribution::{Contribution, exchange};
use std::sync::Arc;

/// The fixtures, which are sprites that never change, in order of creation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fixtures(Vec<Sprite>);

/// Converts a slot into a fixture's index, or an index into a slot.
pub(super) fn mirrored(number: usize) -> usize {
    usize::from(NONE) - 1 - number
}

impl World {
    /// Returns the fixture in a slot.
    #[inline]
    pub(crate) fn fixture(&self, slot: Slot) -> &Sprite {
        let Fixtures(sprites) =
            self.fixtures.as_deref().expect("slots without a sprite are those of fixtures");
        &sprites[mirrored(usize::from(slot))]
    }

    /// Returns the number of fixtures.
    pub(crate) fn fixture_count(&self) -> usize {
        self.all_fixtures().len()
    }

    /// Returns the fixtures, in order of creation.
    pub(super) fn all_fixtures(&self) -> &[Sprite] {
        self.fixtures.as_ref().map_or(&[], |fixtures| &fixtures.0)
    }

    fn edit_fixture(&mut self, slot: Slot) -> &mut Sprite {
        let Fixtures(sprites) = Arc::make_mut(self.fixtures.get_or_insert_default());
        &mut sprites[mirrored(usize::from(slot))]
    }

    /// Creates a fixture, which is a sprite that never changes. If other states share the fixtures, gives this state
    /// its own copy first.
    pub(crate) fn add_fixture(&mut self, models: &Models, mut sprite: Sprite, watcher: &mut impl Watcher) {
        let slot = mirrored(self.fixture_count()) as Slot;
        (sprite.column, sprite.row) = self.place_of(sprite.rect);
        self.census_changed |= models.of_type[sprite.stype.index()].counted;
        let group = &mut self.groups[sprite.stype.index()];
        group.count += 1;
        let tail = std::mem::replace(&mut group.tail, slot);
        if tail == NONE {
            group.head = slot;
        } else {
            self.edit_fixture(tail).next = slot;
        }
        sprite.previous = tail;
        Arc::make_mut(self.fixtures.get_or_insert_default()).0.push(sprite);
        self.next_id += 1;
        self.population += 1;
        let contribution = Contribution::fresh(&sprite, slot, &self.side_tables());
        exchange(Contribution::default(), contribution, &mut self.sum, &mut self.hash_classes);
        if models.bit(sprite.stype) == 0 {
            return;
        }
        // The fixture comes after all sprites that are not fixtures.
        let cell = self.cell_of(&sprite);
        let (mut last, mut next) = (NONE, self.cells[cell]);
        while usize::from(next) < self.sprites.len() {
            (last, next) = (next, self.sprite(next).cell_next);
        }
        self.edit_fixture(slot).cell_next = next;
        match last {
            NONE => self.cells[cell] = slot,
            last => self.sprites[usize::from(last)].cell_next = slot,
        }
        self.arrive(models.bits[sprite.stype.index()], cell, watcher);
    }

    /// Records all fixtures (sprites that never change) in their cells again, after the cells have been emptied.
    pub(super) fn reenter_fixtures(&mut self, models: &Models, watcher: &mut impl Watcher) {
        for slot in (0..self.fixture_count()).map(|number| mirrored(number) as Slot) {
            let sprite = *self.fixture(slot);
            if models.bit(sprite.stype) != 0 {
                let cell = self.cell_of(&sprite);
                self.cells[cell] = slot;
                self.arrive(models.bits[sprite.stype.index()], cell, watcher);
            }
        }
    }
}
