//! Scenery: sprites that do nothing on their own, and to whose types no rule, other sprite or termination
//! refers.
//!
//! Scenery stays where the level placed it for the whole episode. In a typical game, half of all sprites are
//! the floor, which is scenery. All states of a level share its scenery, so copying a state does not copy it.
//! Scenery has no slots, and the running hash contains its contributions from the start.

use super::{NONE, Sprite, World};
use crate::rules::SpriteType;
use crate::world::hash::contribution::{Contribution, exchange};
use std::sync::Arc;

/// The scenery sprites, by type, in order of creation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scenery(Vec<(SpriteType, Vec<Sprite>)>);

impl Scenery {
    fn of(&self, stype: SpriteType) -> &[Sprite] {
        self.0.iter().find(|(other, _)| *other == stype).map_or(&[], |(_, sprites)| sprites)
    }
}

impl World {
    /// Creates a scenery sprite, which no rule involves. If other states share the scenery, gives this state its own
    /// copy first.
    pub(crate) fn add_scenery(&mut self, sprite: Sprite) {
        self.groups[sprite.stype.index()].count += 1;
        self.next_id += 1;
        self.population += 1;
        let contribution = Contribution::fresh(&sprite, NONE, &self.side_tables());
        exchange(Contribution::default(), contribution, &mut self.sum, &mut self.hash_classes);
        let Scenery(types) = Arc::make_mut(self.scenery.get_or_insert_default());
        match types.iter_mut().find(|(other, _)| *other == sprite.stype) {
            Some((_, sprites)) => sprites.push(sprite),
            None => types.push((sprite.stype, vec![sprite])),
        }
    }

    /// Returns a type's scenery sprites. Either all or none of a type's sprites are scenery.
    pub(crate) fn scenery_of(&self, stype: SpriteType) -> &[Sprite] {
        self.scenery.as_ref().map_or(&[], |scenery| scenery.of(stype))
    }

    /// Returns a type's current sprites, in order of creation, whether they have slots or are scenery. Call
    /// only between steps.
    pub(crate) fn sprites_of(&self, stype: SpriteType) -> impl Iterator<Item = Sprite> + '_ {
        self.scenery_of(stype).iter().copied().chain(self.slots(stype).map(|slot| self.present(slot)))
    }
}
