//! Sprites in flight, whose position is stored as a function of the tick. They move by the same displacement
//! every `period` ticks. `rect`, `last_corner` and `moved_at` describe an earlier move.

use crate::numbers::geometry::Rect;
use crate::world::{Slot, Sprite, World};

/// Advances a sprite in flight to its last move at or before a tick. Returns the displacement per move.
#[inline]
fn fly_to(sprite: &mut Sprite, tick: i32) -> (i32, i32) {
    let Sprite { rect, last_corner, moved_at, .. } = *sprite;
    let (dx, dy) = (rect.x.wrapping_sub(last_corner.0), rect.y.wrapping_sub(last_corner.1));
    let ticks = tick.wrapping_sub(moved_at);
    let period = i32::from(sprite.period);
    let moves = if period == 1 { ticks } else { ticks.div_euclid(period) };
    let along = |at: i32, by: i32| at.wrapping_add(by.wrapping_mul(moves));
    sprite.rect = rect.at(along(rect.x, dx), along(rect.y, dy));
    sprite.last_corner = (sprite.rect.x.wrapping_sub(dx), sprite.rect.y.wrapping_sub(dy));
    sprite.moved_at = moved_at.wrapping_add(moves.wrapping_mul(period));
    (dx, dy)
}

/// Gives a sprite in flight the values that it has at a tick.
pub(crate) fn settle_in(sprite: &mut Sprite, tick: i32) {
    fly_to(sprite, tick);
    if sprite.moved_at != tick {
        sprite.last_corner = (sprite.rect.x, sprite.rect.y);
    }
}

impl World {
    /// Advances a sprite in flight to its last move at or before this tick, without changing the cells in
    /// which it is recorded. Returns its rectangle and its displacement per move.
    pub(crate) fn fly_on(&mut self, slot: Slot) -> (Rect, (i32, i32)) {
        let sprite = &mut self.sprites[usize::from(slot)];
        let by = fly_to(sprite, self.tick);
        (sprite.rect, by)
    }

    /// Returns a sprite's rectangle, whether or not it is in flight. Call only in the event phase and between
    /// steps.
    pub(crate) fn rect(&self, sprite: &Sprite) -> Rect {
        if !sprite.flies() {
            return sprite.rect;
        }
        let mut sprite = *sprite;
        fly_to(&mut sprite, self.tick);
        sprite.rect
    }

    /// Returns a sprite's current values, whether or not it is in flight. Call only in the event phase and
    /// between steps.
    pub(crate) fn present(&self, slot: Slot) -> Sprite {
        let mut sprite = *self.sprite(slot);
        if sprite.flies() {
            settle_in(&mut sprite, self.tick);
        }
        sprite
    }

    /// Returns the number of further moves by (`dx`, `dy`) that leave a small sprite in the same cells.
    pub(crate) fn moves_within(&self, sprite: &Sprite, (dx, dy): (i32, i32)) -> i32 {
        let (column, row) = (i32::from(sprite.column), i32::from(sprite.row));
        let along = |at: i32, size: i32, by: i32, cell: i32, cells: i32| {
            if by == 0 {
                return i32::MAX;
            }
            let start = (cell - 1).wrapping_mul(self.block);
            match cell {
                // The sprite is off the board and moves further away.
                0 if by < 0 && size <= at.wrapping_neg() => i32::MAX,
                0 => 0,
                cell if cell > cells && by > 0 => i32::MAX,
                cell if cell > cells => 0,
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
}
