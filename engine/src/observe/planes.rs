//! Observations for learning agents: boards as byte planes, one per sprite type, updated from tick to tick.

use crate::game::Game;
use crate::numbers::geometry::Rect;
use crate::rules::{SpriteType, TypeInfo};
use crate::state::State;
use crate::world::{Slot, Sprite, World, flag};

/// The maximum number of planes (arrays of cells, one per sprite type) whose changes are tracked individually. Boards
/// with more planes are redrawn.
const TRACKED: usize = 64;
/// The number of changes after which [`Planes::update`] settles the running hash, which empties the list of changes.
const MANY_CHANGES: usize = 24;

/// The [`Drawn`] entry for a slot that does not appear on any plane.
const NOWHERE: u32 = u32::MAX;
/// The positions of the parts of a [`Drawn`] entry: the row, the flags, and the plane. The lowest bits contain
/// the column. As in [`Sprite`], the first column and the first row are 1.
const ROW: u32 = 10;
const RIGHT: u32 = 20;
const BELOW: u32 = 21;
const PLANE: u32 = 22;
/// The bits below the plane of a sprite that is larger than a cell or not completely on the board. If such a
/// sprite is listed as changed, its plane is redrawn.
const SPREAD: u32 = (1 << PLANE) - 1;

/// The planes (arrays of cells) for a game's boards of a given size: one plane per visible sprite type, in the order of
/// the types given to [`Planes::new`].
///
/// A plane is a row-major array `[rows][columns]`. A cell is 1 if a sprite of the plane's type overlaps it,
/// and 0 otherwise. The planes are contiguous.
#[derive(Clone, Debug)]
pub struct Planes {
    columns: usize,
    rows: usize,
    types: Vec<SpriteType>,
    /// For each type, the index of its plane (its array of cells), or [`Planes::NO_PLANE`].
    plane_of: Vec<u16>,
    /// For each plane, the type's bit in the cell masks. The bit is 0 if sprites of the type are not in the
    /// masks, or if the game has sprites so small that they may be empty.
    masks: Vec<u64>,
}

/// The sprites of a board as last drawn, by slot.
#[derive(Clone, Debug, Default)]
pub struct Drawn(Vec<u32>);

impl Planes {
    const NO_PLANE: u16 = u16::MAX;

    /// Creates the planes (arrays of cells) for the given types, on boards of `columns` by `rows` cells. Hidden types
    /// get no plane.
    pub fn new(
        game: &Game,
        types: impl IntoIterator<Item = SpriteType>,
        columns: usize,
        rows: usize,
    ) -> Planes {
        let types: Vec<SpriteType> = types.into_iter().filter(|&stype| !game.is_hidden(stype)).collect();
        let mut plane_of = vec![Planes::NO_PLANE; game.sprite_types().count()];
        for (plane, &stype) in types.iter().enumerate() {
            plane_of[stype.index()] = plane as u16;
        }
        let rules = &game.0.rules;
        let is_sized = |info: &TypeInfo| info.traits.width_factor >= 0.5 && info.traits.height_factor >= 0.5;
        let own = if rules.types.iter().all(is_sized) { !0 } else { 0 };
        let masks = types.iter().map(|&stype| game.0.models.sole_bit(stype) & own).collect();
        Planes { columns, rows, types, plane_of, masks }
    }

    /// Returns the types in the order of their planes (arrays of cells).
    pub fn types(&self) -> &[SpriteType] {
        &self.types
    }

    /// Returns the total size of all planes (arrays of cells, one per sprite type) in bytes.
    pub fn size(&self) -> usize {
        self.types.len() * self.columns * self.rows
    }

    /// Draws a whole board. A board smaller than the planes is drawn in their top-left corner. Cost: O(planes
    /// × cells + sprites).
    ///
    /// # Panics
    /// Panics if `out` is not [`Planes::size`] bytes long.
    pub fn draw(&self, state: &mut State, drawn: &mut Drawn, out: &mut [u8]) {
        assert_eq!(out.len(), self.size(), "a byte for each cell of each plane");
        state.settle_hash();
        let world = &state.world;
        drawn.0.clear();
        drawn.0.extend((0..world.slot_count()).map(|slot| self.place(world.own(slot as Slot))));
        for (&stype, plane) in self.types.iter().zip(out.chunks_exact_mut(self.columns * self.rows)) {
            self.draw_type(world, stype, plane);
        }
    }

    /// Draws the changes since the last call with this state. Between the two calls, `drawn` and `out` must
    /// not change, and nothing else may settle the state's hash. Cost: O(changed sprites + sprites in flight),
    /// plus O(cells + sprites) for each type that has no rules or changed sprites larger than a cell.
    ///
    /// # Panics
    /// Panics if `out` is not [`Planes::size`] bytes long.
    pub fn update(&self, state: &mut State, drawn: &mut Drawn, out: &mut [u8]) {
        assert_eq!(out.len(), self.size(), "a byte for each cell of each plane");
        if self.types.len() > TRACKED {
            return self.draw(state, drawn, out);
        }
        let world = &state.world;
        let mut changed = 0;
        drawn.0.resize(world.slot_count(), NOWHERE);
        // Moves by sprites in flight are not recorded as changes.
        for slot in world.dirty().iter().copied().chain(state.schedule.flying()) {
            let (to, before) = (self.place(world.own(slot)), &mut drawn.0[usize::from(slot)]);
            if to == *before && to & SPREAD != SPREAD {
                continue;
            }
            let from = std::mem::replace(before, to);
            changed |= self.change(world, from, false, out) | self.change(world, to, true, out);
        }
        let is_long = world.dirty().len() > MANY_CHANGES;
        while changed != 0 {
            let plane = changed.trailing_zeros() as usize;
            changed &= changed - 1;
            self.draw_type(world, self.types[plane], self.board(plane, out));
        }
        if is_long {
            state.settle_hash();
        }
    }

    /// Draws the cells of an entry in [`Drawn`], which a sprite has entered or left. Returns the bit of the
    /// entry's plane if the plane must be redrawn instead, and otherwise 0.
    #[inline(always)]
    fn change(&self, world: &World, place: u32, is_new: bool, out: &mut [u8]) -> u64 {
        if place == NOWHERE {
            return 0;
        }
        let plane = (place >> PLANE) as usize;
        let mask = self.masks[plane];
        let is_exact = mask != 0 && world.group(self.types[plane]).big == 0 && world.block() > 1;
        if place & SPREAD == SPREAD || !is_exact {
            return bit(plane);
        }
        let board = self.board(plane, out);
        let (column, row) = (place & 0x3FF, place >> ROW & 0x3FF);
        // Another sprite of the type may cover a cell that the sprite has left.
        let mut set = |column: u32, row: u32| {
            board[self.cell(column, row)] = u8::from(is_new || world.is_covered(column, row, mask));
        };
        set(column, row);
        if place & (1 << RIGHT | 1 << BELOW) != 0 {
            let (right, below) = (place >> RIGHT & 1, place >> BELOW & 1);
            set(column + right, row);
            set(column, row + below);
            set(column + right, row + below);
        }
        0
    }

    fn board<'a>(&self, plane: usize, out: &'a mut [u8]) -> &'a mut [u8] {
        &mut out[plane * self.columns * self.rows..][..self.columns * self.rows]
    }

    /// Returns the row-major index of a cell. The first column and the first row are 1.
    fn cell(&self, column: u32, row: u32) -> usize {
        (row - 1) as usize * self.columns + (column - 1) as usize
    }

    /// Returns a sprite's entry in [`Drawn`].
    #[inline(always)]
    fn place(&self, sprite: &Sprite) -> u32 {
        let plane = self.plane_of[sprite.stype.index()];
        if sprite.is(flag::FREE) || plane == Planes::NO_PLANE {
            return NOWHERE;
        }
        if sprite.is(flag::BIG | flag::OFF) {
            return u32::from(plane) << PLANE | SPREAD;
        }
        let further = u32::from(sprite.is(flag::RIGHT)) << RIGHT | u32::from(sprite.is(flag::BELOW)) << BELOW;
        u32::from(plane) << PLANE | further | (sprite.row as u32) << ROW | sprite.column as u32
    }

    /// Calls `mark` with the row-major index of each cell that a sprite on the plane overlaps, once per
    /// overlapping sprite.
    pub fn visit(&self, state: &State, plane: usize, mark: impl FnMut(usize)) {
        self.visit_type(&state.world, self.types[plane], mark);
    }

    fn draw_type(&self, world: &World, stype: SpriteType, plane: &mut [u8]) {
        plane.fill(0);
        self.visit_type(world, stype, |cell| plane[cell] = 1);
    }

    #[inline(always)]
    fn visit_type(&self, world: &World, stype: SpriteType, mut mark: impl FnMut(usize)) {
        for sprite in world.scenery_of(stype) {
            self.cover(world, sprite.rect, &mut mark);
        }
        for slot in world.slots(stype) {
            let sprite = world.sprite(slot);
            match sprite.flags & flag::PLACEMENT {
                0 => mark(self.cell(sprite.column as u32, sprite.row as u32)),
                _ => self.cover(world, world.rect(sprite), &mut mark),
            }
        }
    }

    /// Visits the cells that a rectangle overlaps, using the same rule as observations.
    fn cover(&self, world: &World, rect: Rect, mark: &mut impl FnMut(usize)) {
        let block = world.block().max(1);
        let span = |from: i32, size: i32, limit: i32| {
            let (first, within) = (from.div_euclid(block), from.rem_euclid(block));
            let end = within.saturating_add(size.saturating_sub(1));
            // Most sprites are in a single cell, for which the second division is unnecessary.
            let last = if (0..block).contains(&end) { first } else { first + end.div_euclid(block) };
            first.clamp(0, limit) as usize..(last.clamp(-1, limit - 1) + 1) as usize
        };
        let columns = span(rect.x, rect.w, world.columns());
        for row in span(rect.y, rect.h, world.rows()) {
            columns.clone().for_each(|column| mark(row * self.columns + column));
        }
    }
}

/// Returns a plane's bit, or 0 for untracked planes.
fn bit(plane: usize) -> u64 {
    1u64.checked_shl(plane as u32).unwrap_or(0)
}
