//! Swept cells of sprites in flight: the cells in which a sprite is entered, and the number of moves for which they
//! suffice.
//!
//! A sprite that moves along an axis is entered in two cells, its current one and the next one, so that its cells change
//! half as often. Tests for overlap use its actual position.

use crate::game::Rules;
use crate::geometry::Rect;
use crate::occupancy::Located;
use crate::state::{Slot, Sprite, State, flag};

impl State {
    /// The number of further moves by (`dx`, `dy`) that leave the cells of a small sprite unchanged.
    #[inline]
    pub(crate) fn moves_within(&self, sprite: &Sprite, dx: i32, dy: i32) -> i32 {
        let (column, row) = (i32::from(sprite.column), i32::from(sprite.row));
        let along = |at: i32, size: i32, by: i32, cell: i32, cells: i32| {
            if by == 0 {
                return i32::MAX;
            }
            let start = (cell - 1).wrapping_mul(self.block);
            match cell {
                // Off the board and moving further away.
                0 if by < 0 && size <= at.wrapping_neg() => i32::MAX,
                0 => 0,
                cell if cell > cells => {
                    if by > 0 {
                        i32::MAX
                    } else {
                        0
                    }
                }
                _ => {
                    let offset = at - start;
                    let reach = self.block - size.max(1);
                    let (low, high) = if offset > reach { (reach + 1, self.block - 1) } else { (0, reach) };
                    let (room, by) = if by > 0 { (high - offset, by) } else { (offset - low, -by) };
                    if room < by { 0 } else { room / by }
                }
            }
        };
        let x = along(sprite.rect.x, sprite.rect.w, dx, column, self.columns);
        let y = along(sprite.rect.y, sprite.rect.h, dy, row, self.rows);
        x.min(y)
    }

    /// Enters a sprite in flight into its swept cells. Returns the number of further moves by (`dx`, `dy`) for which
    /// these suffice.
    ///
    /// A slow sprite is not entered ahead if it would stay there for long beside a sprite that a rule pairs it with.
    #[inline(always)]
    pub(crate) fn enter_swept_cells(&mut self, rules: &Rules, slot: Slot, (dx, dy): (i32, i32)) -> i32 {
        let (rect, from) = (self.sprite(slot).rect, self.located(slot));
        let exact = self.locate(rect, from.column, from.row);
        let swept = self
            .swept_cells(rect, exact, dx, dy)
            .filter(|(swept, _)| !self.is_beside_partners(rules, slot, *swept));
        let to = swept.map_or(exact, |(to, _)| to);
        if from != to {
            self.shift(rules, slot, from, to);
        }
        swept.map_or_else(|| self.moves_within(self.sprite(slot), dx, dy), |(_, moves)| moves)
    }

    fn is_beside_partners(&self, rules: &Rules, slot: Slot, swept: Located) -> bool {
        let sprite = self.sprite(slot);
        let kind = &rules.contacts.kinds[sprite.stype.index()];
        let cell = self.cell(i32::from(swept.column), i32::from(swept.row));
        let mut cells = self.span(cell, swept.flags).cells();
        sprite.period() != 1 && cells.any(|cell| kind.has_partners_among(self.masks[cell]))
    }

    /// The common case of [`State::enter_swept_cells`]: a sprite in two cells, or in two pairs of cells, goes on to the second
    /// and the one after it. `None` in all other cases.
    #[inline(always)]
    pub(crate) fn enter_next_swept_cells(
        &mut self,
        rules: &Rules,
        slot: Slot,
        (dx, dy): (i32, i32),
    ) -> Option<i32> {
        let (block, stride) = (self.block, (self.columns + 2) as usize);
        let sprite = &mut self.sprites[usize::from(slot)];
        let before = sprite.row as usize * stride + sprite.column as usize;
        let (lies, slow) = (sprite.flags & flag::PLACEMENT, sprite.period() != 1);
        let (by, at, size, low, cells, unit, across) = match lies & !(flag::RIGHT | flag::BELOW) {
            0 if dy == 0 && lies & flag::RIGHT != 0 => {
                let across = if lies & flag::BELOW == 0 { 0 } else { stride };
                (dx, sprite.rect.x, sprite.rect.w, &mut sprite.column, self.columns, 1, across)
            }
            0 if dx == 0 && lies & flag::BELOW != 0 => {
                let across = usize::from(lies & flag::RIGHT != 0);
                (dy, sprite.rect.y, sprite.rect.h, &mut sprite.row, self.rows, stride, across)
            }
            _ => return None,
        };
        let next = i32::from(*low) + by.signum();
        let offset = at - (next - 1) * block;
        let room = if by > 0 { 2 * block - size - offset } else { offset };
        let ahead = if by > 0 { offset < block } else { offset + size > block };
        let inside = offset >= 0 && offset + size <= 2 * block;
        if by == 0 || !ahead || !inside || next < 1 || next >= cells {
            return None;
        }
        let (after, gone, new) = if by > 0 {
            (before + unit, before, before + 2 * unit)
        } else {
            (before - unit, before + unit, before - unit)
        };
        let kind = &rules.contacts.kinds[sprite.stype.index()];
        let is_beside = |cell: usize| kind.has_partners_among(self.masks[cell]);
        if slow && (is_beside(new) || is_beside(new + across)) {
            return None;
        }
        *low = next as i16;
        if kind.own != 0 {
            self.unlink(slot, before);
            self.link(slot, after);
            self.depart_beside(&rules.contacts, kind, gone, across);
            self.arrive_beside(&rules.contacts, kind, new, across);
        }
        let by = by.abs();
        Some(if room < by { 0 } else { room / by })
    }

    /// The two swept cells of [`State::enter_swept_cells`], if both are on the board, and the number of moves for which the
    /// sprite stays in them.
    #[inline(always)]
    fn swept_cells(&self, rect: Rect, exact: Located, dx: i32, dy: i32) -> Option<(Located, i32)> {
        let sized = rect.w > 0 && rect.h > 0;
        if exact.flags & (flag::OFF | flag::BIG) != 0 || (dx != 0) == (dy != 0) || !sized {
            return None;
        }
        let along = |at: i32, size: i32, by: i32, cell: i16, over: bool, cells: i32| {
            let cell = i32::from(cell);
            let (low, room) = if by > 0 {
                (cell, (cell + 1) * self.block - (at + size))
            } else {
                let low = if over { cell } else { cell - 1 };
                (low, at - (low - 1) * self.block)
            };
            let by = by.abs();
            (1 <= low && low < cells).then_some((low as i16, if room < by { 0 } else { room / by }))
        };
        if dy == 0 {
            let over = exact.flags & flag::RIGHT != 0;
            let (column, moves) = along(rect.x, rect.w, dx, exact.column, over, self.columns)?;
            Some((Located { column, flags: exact.flags | flag::RIGHT, ..exact }, moves))
        } else {
            let over = exact.flags & flag::BELOW != 0;
            let (row, moves) = along(rect.y, rect.h, dy, exact.row, over, self.rows)?;
            Some((Located { row, flags: exact.flags | flag::BELOW, ..exact }, moves))
        }
    }
}
