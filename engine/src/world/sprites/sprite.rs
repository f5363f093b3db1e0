//! A sprite, and the list of the sprites of a type.

use crate::flat::bytes_of_fields;
use crate::numbers::geometry::Rect;
use crate::rules::SpriteType;

/// An index into the sprites of a state.
pub(crate) type Slot = u16;
/// The `heading` of an NPC that has not drawn a direction.
pub(crate) const NO_HEADING: u32 = 4;
/// No sprite.
pub(crate) const NONE: Slot = u16::MAX;

/// Bits of [`Sprite::flags`]; the first four are those that traces record.
pub(crate) mod flag {
    /// A killed avatar: it stays in its group but is no longer updated.
    pub(crate) const DISABLED: u32 = 1;
    pub(crate) const AVATAR: u32 = 2;
    pub(crate) const FROM_AVATAR: u32 = 4;
    /// The sprite stands on something solid; only for classes that detect it.
    pub(crate) const ON_GROUND: u32 = 8;
    /// The bits that traces record.
    pub(crate) const RECORDED: u32 = 15;
    pub(crate) const FIRST_TICK: u32 = 16;
    pub(crate) const ORIENTED: u32 = 32;
    /// The sprite is in the kill list.
    pub(crate) const KILLED: u32 = 64;
    /// The sprite is not updated, and `moved_at` holds its age: its type is not in the update order, or it is of an avatar
    /// class and not the player's, or disabled.
    pub(crate) const FROZEN: u32 = 128;
    /// The sprite is in `State::moved`: its last rectangle differs from its rectangle, or may.
    pub(crate) const MOVED: u32 = 256;
    /// The dirty flag. The sprite is in `State::dirty`: the running hash may contain an older version of it.
    pub(crate) const DIRTY: u32 = 512;
    /// The slot is free.
    pub(crate) const FREE: u32 = 1024;
    /// The sprite is not wholly on the screen.
    pub(crate) const OFF: u32 = 2048;
    /// The sprite is no larger than a cell, and covers the cell to the right too.
    pub(crate) const RIGHT: u32 = 4096;
    /// The sprite is no larger than a cell, and covers the cell below too.
    pub(crate) const BELOW: u32 = 8192;
    /// The sprite is larger than a cell.
    pub(crate) const BIG: u32 = 16_384;
    /// The sprite covers more than one cell, or may.
    pub(crate) const MULTI_CELL: u32 = RIGHT | BELOW | BIG;
    /// The cooldown never delays the sprite, so the tick of its last move does not matter.
    pub(crate) const NO_COOLDOWN: u32 = 32_768;
    /// More of the hash contribution has changed than what comes with moving.
    pub(crate) const CHANGED: u32 = 65_536;
    /// The sprite is in `State::resized`: it had another size at the start of its update.
    pub(crate) const RESIZED: u32 = 262_144;
    /// The bits of how a sprite lies in its cell.
    pub(crate) const PLACEMENT: u32 = MULTI_CELL | OFF;
    /// Spawner: it has been updated, and `Overrides::start` is the tick of the first update.
    pub(crate) const STARTED: u32 = 524_288;
    /// NPC: the position of the highest bits, with the last drawn direction as an index into the base directions, 4 for
    /// none.
    pub(crate) const HEADING: u32 = 29;
    /// The bits that are part of the state; the others are bookkeeping, in which two equal states may differ.
    pub(crate) const LASTING: u32 = 0xFF;
}

/// One sprite: the size of a cache line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sprite {
    pub(crate) rect: Rect,
    /// The corner at the start of its own update in this tick (`moved.rs`).
    pub(crate) last_corner: (i32, i32),
    /// The creation number, never reused.
    pub(crate) id: u32,
    /// The tick of the last move; the reference's `lastmove` is the tick minus this.
    pub(crate) moved_at: i32,
    pub(crate) time_to_live: i32,
    /// Flicker: its age. NPC: the number of repetitions of the last direction. Spawner: the number of sprites that it has
    /// spawned.
    pub(crate) count: i32,
    pub(crate) flags: u32,
    pub(crate) stype: SpriteType,
    /// Index into `State::overrides`: the entry of its type, or one of its own.
    pub(crate) overrides: u16,
    /// A note of the schedule: what happened to the sprite in this tick.
    pub(crate) activity: u16,
    /// In flight: the number of ticks between its moves (`flight.rs`); 0 for all others.
    pub(crate) period: u16,
    /// The chain of the type.
    pub(crate) next: Slot,
    pub(crate) previous: Slot,
    /// The chain of the cell.
    pub(crate) cell_next: Slot,
    pub(crate) cell_previous: Slot,
    /// The cell's column and row, counted with the ring around the board.
    pub(crate) column: i16,
    pub(crate) row: i16,
}

bytes_of_fields! { Sprite { rect last_corner id moved_at time_to_live count flags stype overrides activity period next previous cell_next cell_previous column row } }

const _: () = assert!(size_of::<Sprite>() == 64);

impl Sprite {
    pub(crate) fn is(&self, flag: u32) -> bool {
        self.flags & flag != 0
    }

    /// NPC: the last drawn direction as an index into the base directions, 4 for none.
    #[inline(always)]
    pub(crate) fn heading(&self) -> u32 {
        self.flags >> flag::HEADING
    }

    #[inline(always)]
    pub(crate) fn set_heading(&mut self, heading: u32) {
        self.flags = self.flags & !(7 << flag::HEADING) | heading << flag::HEADING;
    }

    /// Returns `true` if it is in flight (`flight.rs`).
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
    /// The number of sprites that cover more than one cell, or may.
    pub(crate) multi_cell: u16,
    /// The number of sprites that are larger than a cell.
    pub(crate) big: u16,
    /// The number of sprites that are not wholly on the screen.
    pub(crate) off: u16,
}

bytes_of_fields! { Group { head tail count disabled multi_cell big off } }

impl Group {
    pub(crate) const EMPTY: Group =
        Group { head: NONE, tail: NONE, count: 0, disabled: 0, multi_cell: 0, big: 0, off: 0 };
}
