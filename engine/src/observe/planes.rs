//! Boards as planes of bytes, one for each sprite type, kept up to date from tick to tick: the observations of learning
//! agents.

use crate::game::Game;
use crate::numbers::geometry::Rect;
use crate::rules::SpriteType;
use crate::state::State;
use crate::world::{Slot, Sprite, World, flag};

/// The number of planes whose changes are tracked one by one; boards with more planes are drawn anew.
const TRACKED: usize = 64;
/// The number of changes after which the running hash is settled, which empties the list of changes.
const MANY_CHANGES: usize = 24;

/// The record of a slot that is not on any plane.
const NOWHERE: u32 = u32::MAX;
/// The cell of a sprite that covers none or several, or is partly off the board: it counts as changed every time.
const SPREAD: u32 = 0xFFFF;

/// The planes of a game's boards of one size: the sprite types shown, in order.
///
/// A plane is `[rows][columns]`, row-major; a cell is 1 if a sprite of the type overlaps it, else 0. The planes follow each
/// other.
#[derive(Clone, Debug)]
pub struct Planes {
    columns: usize,
    rows: usize,
    types: Vec<SpriteType>,
    /// By type: its plane, or [`Planes::NO_PLANE`].
    plane_of: Vec<u16>,
    /// The planes of types whose sprites move without a note in the list of changes.
    unnoted: u64,
}

/// The sprites of a board as they were last drawn, by slot.
#[derive(Clone, Debug, Default)]
pub struct Drawn(Vec<u32>);

impl Planes {
    const NO_PLANE: u16 = u16::MAX;

    /// The planes of these types, on boards of `columns` by `rows` cells. Hidden types have no plane.
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

    /// The types, in the order of their planes.
    pub fn types(&self) -> &[SpriteType] {
        &self.types
    }

    /// The number of bytes of all planes.
    pub fn size(&self) -> usize {
        self.types.len() * self.columns * self.rows
    }

    /// Draws a whole board. A board smaller than the planes is at their top left. Cost: O(planes × cells + sprites).
    ///
    /// # Panics
    /// If `out` is not [`Planes::size`] bytes long.
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

    /// Draws what has changed since the last call for this state, whose results `drawn` and `out` hold unchanged. Nothing
    /// else may settle the state's hash in between. Cost: O(changed sprites), and O(cells + sprites) for each type with
    /// changes on the board.
    ///
    /// # Panics
    /// If `out` is not [`Planes::size`] bytes long.
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
            // The only sprite of its type, as most avatars are: no other covers the cell that it leaves.
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

    /// The plane of a sprite, and its cell.
    #[inline(always)]
    fn place(&self, sprite: &Sprite, world: &World) -> u32 {
        let plane = self.plane_of[sprite.stype.index()];
        if sprite.is(flag::FREE) || plane == Planes::NO_PLANE {
            return NOWHERE;
        }
        u32::from(plane) << 16 | self.single_cell(sprite, world).map_or(SPREAD, |cell| cell as u32)
    }

    /// The cell of a sprite that covers exactly one and stays in it until it is noted as changed.
    #[inline(always)]
    fn single_cell(&self, sprite: &Sprite, world: &World) -> Option<usize> {
        let (column, row) = (i32::from(sprite.column) - 1, i32::from(sprite.row) - 1);
        let is_inside = (0..world.columns()).contains(&column) && (0..world.rows()).contains(&row);
        let is_plain = sprite.flags & flag::PLACEMENT == 0 && sprite.rect.w > 0 && sprite.rect.h > 0;
        let cell = (row * self.columns as i32 + column) as usize;
        (is_inside && is_plain && !sprite.flies() && cell < SPREAD as usize).then_some(cell)
    }

    /// Calls `mark` with each cell, counted row by row, that a sprite of a plane overlaps; more than once where several do.
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

    /// Visits the cells that a rectangle overlaps, as observations list them.
    fn cover(&self, world: &World, rect: Rect, mark: &mut impl FnMut(usize)) {
        let block = world.block().max(1);
        let span = |from: i32, size: i32, limit: i32| {
            let (first, within) = (from.div_euclid(block), from.rem_euclid(block));
            let end = within.saturating_add(size.saturating_sub(1));
            // Most sprites are in one cell: no second division.
            let last = if (0..block).contains(&end) { first } else { first + end.div_euclid(block) };
            first.clamp(0, limit) as usize..(last.clamp(-1, limit - 1) + 1) as usize
        };
        let columns = span(rect.x, rect.w, world.columns());
        for row in span(rect.y, rect.h, world.rows()) {
            columns.clone().for_each(|column| mark(row * self.columns + column));
        }
    }
}

/// The bit of a plane; planes beyond the tracked ones have none.
fn bit(plane: usize) -> u64 {
    1u64.checked_shl(plane as u32).unwrap_or(0)
}
