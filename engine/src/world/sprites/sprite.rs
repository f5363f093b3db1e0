//! Sprites, and the lists of each type's sprites.

use crate::flat::bytes_of_fields;
use crate::numbers::geometry::Rect;
use crate::rules::SpriteType;

/// An index into a state's sprites.
pub(crate) type Slot = u16;
/// The value of `heading` for an NPC that has not drawn a direction.
pub(crate) const NO_HEADING: u32 = 4;
/// The slot (index of a sprite in the state's storage) that stands for no sprite.
pub(crate) const NONE: Slot = u16::MAX;

/// The bits of [`Sprite::flags`]. Traces record the first four.
pub(crate) mod flag {
    /// The sprite is a killed avatar, which stays in its group but is no longer updated.
    pub(crate) const DISABLED: u32 = 1;
    pub(crate) const AVATAR: u32 = 2;
    pub(crate) const FROM_AVATAR: u32 = 4;
    /// The sprite stands on something solid. The flag is set only for classes that detect the ground.
    pub(crate) const ON_GROUND: u32 = 8;
    /// The bits that traces record.
    pub(crate) const RECORDED: u32 = 15;
    pub(crate) const FIRST_TICK: u32 = 16;
    pub(crate) const ORIENTED: u32 = 32;
    /// The sprite is in the kill list.
    pub(crate) const KILLED: u32 = 64;
    /// The sprite is not updated, and `moved_at` contains its age. Either its type is not in the update
    /// order, or it is a sprite of an avatar class that is disabled or not the player's avatar.
    pub(crate) const FROZEN: u32 = 128;
    /// The sprite is in `World::moved`, because its last rectangle differs, or may differ, from its current
    /// rectangle.
    pub(crate) const MOVED: u32 = 256;
    /// The sprite is dirty: it is in `World::dirty`, because the running hash may contain an older version of
    /// it.
    pub(crate) const DIRTY: u32 = 512;
    /// The slot (entry in the state's storage of sprites) is free.
    pub(crate) const FREE: u32 = 1024;
    /// The sprite is not completely on the screen.
    pub(crate) const OFF: u32 = 2048;
    /// The sprite is no larger than a cell, but it overlaps the cell to the right of its own.
    pub(crate) const RIGHT: u32 = 4096;
    /// The sprite is no larger than a cell, and also covers the cell below.
    pub(crate) const BELOW: u32 = 8192;
    /// The sprite is larger than a cell.
    pub(crate) const BIG: u32 = 16_384;
    /// The sprite covers, or may cover, more than one cell.
    pub(crate) const MULTI_CELL: u32 = RIGHT | BELOW | BIG;
    /// The cooldown never delays the sprite, so the tick of the sprite's last move does not matter.
    pub(crate) const NO_COOLDOWN: u32 = 32_768;
    /// In the hash contribution, a value has changed that movement does not change.
    pub(crate) const CHANGED: u32 = 65_536;
    /// The sprite is in `World::resized`, because it had a different size at the start of its update.
    pub(crate) const RESIZED: u32 = 262_144;
    /// The bits that describe how a sprite lies in its cell.
    pub(crate) const PLACEMENT: u32 = MULTI_CELL | OFF;
    /// The sprite is a spawner that has been updated, and `Overrides::start` is the tick of its first update.
    pub(crate) const STARTED: u32 = 524_288;
    /// The position of the highest bits. For an NPC, these bits contain the last drawn direction, as an index
    /// into the base directions, or 4 for no direction.
    pub(crate) const HEADING: u32 = 29;
    /// The bits that are part of the state. All other bits are bookkeeping and may differ between two equal
    /// states.
    pub(crate) const LASTING: u32 = 0xFF;
}

/// A sprite, which has the size of a cache line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sprite {
    pub(crate) rect: Rect,
    /// The corner at the start of the sprite's own update in this tick (`moved.rs`).
    pub(crate) last_corner: (i32, i32),
    /// The creation number, which is never reused.
    pub(crate) id: u32,
    /// The tick of the last move. The reference's `lastmove` is the current tick minus the tick of the last
    /// move.
    pub(crate) moved_at: i32,
    pub(crate) time_to_live: i32,
    /// A flicker's age, the number of times that an NPC has repeated its last direction, or the number of
    /// sprites that a spawner has created.
    pub(crate) count: i32,
    pub(crate) flags: u32,
    pub(crate) stype: SpriteType,
    /// The index in `World::overrides` of the sprite's own entry or of its type's entry.
    pub(crate) overrides: u16,
    /// The schedule's record of the sprite's activity in this tick.
    pub(crate) activity: u16,
    /// For a sprite in flight, the number of ticks between its moves (`flight.rs`). For all other sprites, 0.
    pub(crate) period: u16,
    /// The next and previous slot in the chain (linked list) of the type's sprites.
    pub(crate) next: Slot,
    pub(crate) previous: Slot,
    /// The next and previous slot in the chain (linked list) of the cell's sprites.
    pub(crate) cell_next: Slot,
    pub(crate) cell_previous: Slot,
    /// The cell's column and row. The ring around the board has column 0 and row 0.
    pub(crate) column: i16,
    pub(crate) row: i16,
}

bytes_of_fields! { Sprite { rect last_corner id moved_at time_to_live count flags stype overrides activity period next previous cell_next cell_previous column row } }

const _: () = assert!(size_of::<Sprite>() == 64);

impl Sprite {
    pub(crate) fn is(&self, flag: u32) -> bool {
        self.flags & flag != 0
    }

    /// Returns the direction that an NPC drew last, as an index into the base directions, or 4 for no
    /// direction.
    #[inline(always)]
    pub(crate) fn heading(&self) -> u32 {
        self.flags >> flag::HEADING
    }

    #[inline(always)]
    pub(crate) fn set_heading(&mut self, heading: u32) {
        self.flags = self.flags & !(7 << flag::HEADING) | heading << flag::HEADING;
    }

    /// Returns `true` if the sprite is in flight (`flight.rs`).
    #[inline(always)]
    pub(crate) fn flies(&self) -> bool {
        self.period != 0
    }

    pub(crate) fn set(&mut self, flag: u32, on: bool) {
        if on {
            self.flags |= flag;
        } else {
            self.flags &= !flag;
        }
    }
}

/// The sprites of one type, in order of creation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Group {
    pub(crate) head: Slot,
    pub(crate) tail: Slot,
    pub(crate) count: u16,
    pub(crate) disabled: u16,
    /// The number of sprites that cover, or may cover, more than one cell.
    pub(crate) multi_cell: u16,
    /// The number of sprites larger than a cell.
    pub(crate) big: u16,
    /// The number of sprites not completely on the screen.
    pub(crate) off: u16,
}

bytes_of_fields! { Group { head tail count disabled multi_cell big off } }

impl Group {
    pub(crate) const EMPTY: Group =
        Group { head: NONE, tail: NONE, count: 0, disabled: 0, multi_cell: 0, big: 0, off: 0 };
}
