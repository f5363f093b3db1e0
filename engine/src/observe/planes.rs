//! Observations for learning agents: boards as byte planes, one per sprite type, updated from tick to tick.

use crate::game::Game;
use crate::numbers::geometry::Rect;
use crate::rules::SpriteType;
use crate::state::State;
use crate::world::{Slot, Sprite, World, flag};

/// The maximum number of planes (arrays of cells, one per sprite type) whose changes are tracked individually. Boards
/// with more planes are redrawn.
const TRACKED: usize = 64;
/// The number of changes after which [`Planes::update`] settles the running hash, which empties the list of changes.
const MANY_CHANGES: usize = 24;

/// The [`Drawn`] entry for a slot that does not appear on any plane.
const NOWHERE: u32 = u32::MAX;
/// The cell value for a sprite that does not cover exactly one cell, is partly off the board, or is in
/// flight. Such a sprite is always treated as changed.
const SPREAD: u32 = 0xFFFF;

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
    /// A bit set of planes. A plane's bit is set if sprites of its type can move without being recorded in
    /// the list of changes.
    unnoted: u64,
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
        let mut unnoted = 0;
        for (plane, &stype) in types.iter().enumerate() {
            plane_of[stype.index()] = plane as u16;
            if game.0.plan.shortcuts[stype.index()].flies {
                unnoted |= bit(plane);
            }
        }
        Planes { columns, rows, types, plane_of, unnoted }
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
        drawn.0.extend((0..world.slot_count()).map(|slot| self.place(world.sprite(slot as Slot), world)));
        for (&stype, plane) in self.types.iter().zip(out.chunks_exact_mut(self.columns * self.rows)) {
            self.draw_type(world, stype, plane);
        }
    }

    /// Draws the changes since the last call with this state. Between the two calls, `drawn` and `out` must
    /// not change, and nothing else may settle the state's hash. Cost: O(changed sprites), plus O(cells +
    /// sprites) for each type with changes on the board.
    ///
    /// # Panics
    /// Panics if `out` is not [`Planes::size`] bytes long.
    pub fn update(&self, state: &mut State, drawn: &mut Drawn, out: &mut [u8]) {
        assert_eq!(out.len(), self.size(), "a byte for each cell of each plane");
        if self.types.len() > TRACKED {
            return self.draw(state, drawn, out);
        }
        let world = &state.world;
        let (mut changed, cells) = (self.unnoted, self.columns * self.rows);
        drawn.0.resize(world.slot_count(), NOWHERE);
        for &slot in world.dirty() {
            let (now, before) = (self.place(world.sprite(slot), world), &mut drawn.0[usize::from(slot)]);
            if now == *before && now & SPREAD != SPREAD {
                continue;
            }
            let (from, to) = (std::mem::replace(before, now), now);
            // If a sprite is the only one of its type, as most avatars are, no other sprite of the type
            // covers the cell that it leaves.
            if from >> 16 == to >> 16 && from & SPREAD != SPREAD && to & SPREAD != SPREAD {
                let plane = (to >> 16) as usize;
                if world.group(self.types[plane]).count == 1 && world.scenery_of(self.types[plane]).is_empty()
                {
                    let board = &mut out[plane * cells..][..cells];
                    (board[(from & SPREAD) as usize], board[(to & SPREAD) as usize]) = (0, 1);
                    continue;
                }
            }
            for place in [from, to].into_iter().filter(|&place| place != NOWHERE) {
                changed |= bit((place >> 16) as usize);
            }
        }
        let is_long = world.dirty().len() > MANY_CHANGES;
        while changed != 0 {
            let plane = changed.trailing_zeros() as usize;
            changed &= changed - 1;
            self.draw_type(world, self.types[plane], &mut out[plane * cells..][..cells]);
        }
        if is_long {
            state.settle_hash();
        }
    }

    /// Returns a sprite's plane (upper 16 bits) and cell (lower 16 bits).
    #[inline(always)]
    fn place(&self, sprite: &Sprite, world: &World) -> u32 {
        let plane = self.plane_of[sprite.stype.index()];
        if sprite.is(flag::FREE) || plane == Planes::NO_PLANE {
            return NOWHERE;
        }
        u32::from(plane) << 16 | self.single_cell(sprite, world).map_or(SPREAD, |cell| cell as u32)
    }

    /// Returns the cell of a sprite that covers exactly one cell and stays in it until it is recorded as changed;
    /// `None` for any other sprite.
    #[inline(always)]
    fn single_cell(&self, sprite: &Sprite, world: &World) -> Option<usize> {
        let (column, row) = (i32::from(sprite.column) - 1, i32::from(sprite.row) - 1);
        let is_inside = (0..world.columns()).contains(&column) && (0..world.rows()).contains(&row);
        let is_plain = sprite.flags & flag::PLACEMENT == 0 && sprite.rect.w > 0 && sprite.rect.h > 0;
        let cell = (row * self.columns as i32 + column) as usize;
        (is_inside && is_plain && !sprite.flies() && cell < SPREAD as usize).then_some(cell)
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
            match self.single_cell(sprite, world) {
                Some(cell) => mark(cell),
                None => self.cover(world, world.rect(sprite), &mut mark),
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
