//! The rectangles of sprites at the start of their own last update, which the reference stores in each sprite.
//!
//! A sprite holds its earlier corner. Its earlier size equals its size, except for the few sprites that have been resized
//! since.

use super::{Slot, Sprite, World, flag};
use crate::flat::bytes_of_fields;
use crate::geometry::Rect;

/// The size that a sprite had before it was resized in this tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Resized {
    pub(crate) slot: Slot,
    pub(crate) w: i32,
    pub(crate) h: i32,
}

bytes_of_fields! { Resized { slot w h } }

/// The rectangle of a sprite at the start of its own update in this tick.
#[inline]
pub(crate) fn last_of(sprite: &Sprite, slot: Slot, resized: &[Resized]) -> Rect {
    let last = sprite.rect.at(sprite.last_corner.0, sprite.last_corner.1);
    if sprite.is(flag::RESIZED) { of_size_then(last, slot, resized) } else { last }
}

#[cold]
fn of_size_then(last: Rect, slot: Slot, resized: &[Resized]) -> Rect {
    let found = resized.binary_search_by_key(&slot, |one| one.slot);
    found.map_or(last, |at| Rect { w: resized[at].w, h: resized[at].h, ..last })
}

impl Sprite {
    /// Tests whether the sprite has the same place and size as at the start of its own update in this tick.
    #[inline]
    pub(crate) fn is_back(&self) -> bool {
        self.last_corner == (self.rect.x, self.rect.y) && !self.is(flag::RESIZED)
    }
}

impl World {
    /// The rectangle of a sprite at the start of its own update in this tick.
    #[inline]
    pub(crate) fn last(&self, slot: Slot) -> Rect {
        last_of(self.sprite(slot), slot, &self.resized)
    }

    /// Sets the rectangle of a sprite at the start of its own update in this tick: it counts as moved.
    pub(crate) fn set_last(&mut self, slot: Slot, last: Rect) {
        let sprite = &mut self.sprites[usize::from(slot)];
        let (before, resized) = (sprite.flags, (sprite.rect.w, sprite.rect.h) != (last.w, last.h));
        sprite.last_corner = (last.x, last.y);
        sprite.set(flag::MOVED, true);
        sprite.set(flag::RESIZED, resized);
        if before & flag::MOVED == 0 {
            self.moved.push(slot);
        }
        if resized || before & flag::RESIZED != 0 {
            self.note_size(slot, resized, last);
        }
    }

    /// The sprites that have moved, or may have.
    #[inline(always)]
    pub(crate) fn moved(&self) -> &[Slot] {
        &self.moved
    }

    /// The number of those that have another size now.
    pub(crate) fn resized_count(&self) -> usize {
        self.resized.len()
    }

    /// Starts a move of a sprite by itself: its age starts anew. The caller relocates it.
    #[inline(always)]
    pub(crate) fn start_move(&mut self, slot: Slot) {
        self.sprites[usize::from(slot)].moved_at = self.tick;
    }

    /// Shortens the list of the moved sprites to those with a flag that says so.
    pub(crate) fn shorten_moved(&mut self) {
        let World { moved, sprites, .. } = self;
        moved.retain(|&slot| sprites[usize::from(slot)].is(flag::MOVED));
    }

    /// Notes that a sprite that is not in the list has moved.
    pub(crate) fn note_moved(&mut self, slot: Slot) {
        self.sprites[usize::from(slot)].set(flag::MOVED, true);
        self.moved.push(slot);
    }

    #[inline(never)]
    fn note_size(&mut self, slot: Slot, resized: bool, Rect { w, h, .. }: Rect) {
        let one = Resized { slot, w, h };
        match self.resized.binary_search_by_key(&slot, |one| one.slot) {
            Ok(at) if resized => self.resized[at] = one,
            Ok(at) => drop(self.resized.remove(at)),
            Err(at) => self.resized.insert(at, one),
        }
    }

    /// Forgets the moves of released sprites.
    pub(crate) fn forget_moved(&mut self) {
        let World { moved, resized, sprites, .. } = self;
        let stays = |slot: Slot| !sprites[usize::from(slot)].is(flag::FREE);
        moved.retain(|&slot| stays(slot));
        resized.retain(|one| stays(one.slot));
    }

    /// Makes the current rectangles the last rectangles. The reference does so for every sprite before its own update;
    /// only sprites that have moved since show a difference, and nothing reads another sprite's last rectangle before the
    /// events.
    #[inline]
    pub(crate) fn settle_moved(&mut self) {
        let World { sprites, moved, resized, .. } = self;
        let mut frozen = false;
        for &slot in &*moved {
            let sprite = &mut sprites[usize::from(slot)];
            if sprite.flags & flag::FROZEN == 0 {
                sprite.last_corner = (sprite.rect.x, sprite.rect.y);
                sprite.flags &= !(flag::MOVED | flag::RESIZED);
            } else if sprite.is_back() {
                sprite.flags &= !flag::MOVED;
            } else {
                // It remains in the list of moved sprites.
                frozen = true;
            }
        }
        if frozen {
            moved.retain(|&slot| sprites[usize::from(slot)].is(flag::MOVED));
        } else {
            moved.clear();
        }
        if !resized.is_empty() {
            resized.retain(|one| sprites[usize::from(one.slot)].is(flag::RESIZED));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Action, Game, Seed, State};

    /// A bud that opens becomes a flower of two cells; its last rectangle is a bud's until the next update.
    const GAME: &str = "BasicGame square_size=10\n  SpriteSet\n    bud > Immovable\n    flower > Immovable wMult=2\n    avatar > MovingAvatar\n  \
                        LevelMapping\n    b > bud\n    f > flower\n    A > avatar\n  InteractionSet\n    bud avatar > transformTo stype=flower\n    \
                        avatar EOS > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n";

    #[test]
    fn earlier_sizes_are_kept_until_the_next_update() {
        let game = Game::from_source(GAME).unwrap();
        let mut state = game.start(&game.level("Ab f \n").unwrap(), Seed::from_text("bud"));
        let flower = game.sprite_type("flower").unwrap();
        let sizes = |state: &State| {
            let world = &state.world;
            world
                .slots(flower)
                .map(|slot| (world.sprite(slot).rect.w, world.last(slot).w))
                .collect::<Vec<_>>()
        };
        // The first of a type has the size of a cell until its first update.
        assert_eq!(sizes(&state), [(20, 10)]);
        game.step(&mut state, Action::Right);
        assert_eq!(sizes(&state), [(20, 20), (20, 10)]);
        state.recount(&game).unwrap();
        assert_eq!(state.state_hash(), state.state_hash_from_scratch());
        game.step(&mut state, Action::Nil);
        assert_eq!(sizes(&state), [(20, 20), (20, 20)]);
    }
}
