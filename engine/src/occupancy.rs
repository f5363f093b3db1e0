//! Who is where: each cell of the board, and of a ring around it, has a chain of the sprites whose top-left corner lies
//! in it. Kept as sprites move, so asking who overlaps a rectangle costs what stands there.

use crate::game::{Rules, SpriteType, TypeInfo};
use crate::geometry::Rect;
use crate::state::{NONE, Slot, State};
use smallvec::SmallVec;

/// The slots that overlap a rectangle; seldom more than a few.
pub(crate) type Hits = SmallVec<[Slot; 8]>;

impl State {
    /// Column of a pixel, counted with the ring: 0 is left of the board.
    fn column(&self, x: i32) -> i32 {
        x.div_euclid(self.block).clamp(-1, self.columns) + 1
    }

    fn row(&self, y: i32) -> i32 {
        y.div_euclid(self.block).clamp(-1, self.rows) + 1
    }

    fn cell_of(&self, rect: Rect) -> u32 {
        (self.row(rect.y) * (self.columns + 2) + self.column(rect.x)) as u32
    }

    /// How many cells the board has with its ring.
    pub(crate) fn cell_count(columns: i32, rows: i32) -> usize {
        ((columns + 2) * (rows + 2)) as usize
    }

    fn is_loose(&self, rect: Rect) -> bool {
        rect.x.rem_euclid(self.block) != 0
            || rect.y.rem_euclid(self.block) != 0
            || rect.w > self.block
            || rect.h > self.block
    }

    pub(crate) fn enter_cell(&mut self, slot: Slot) {
        let rect = self.sprite(slot).rect;
        let cell = self.cell_of(rect);
        let head = std::mem::replace(&mut self.cells[cell as usize], slot);
        if head != NONE {
            self.sprites[usize::from(head)].cell_previous = slot;
        }
        let loose = self.is_loose(rect);
        let sprite = &mut self.sprites[usize::from(slot)];
        (sprite.cell, sprite.cell_next, sprite.cell_previous) = (cell, head, NONE);
        self.groups[sprite.stype.index()].loose += u16::from(loose);
    }

    pub(crate) fn leave_cell(&mut self, slot: Slot) {
        let sprite = *self.sprite(slot);
        match sprite.cell_previous {
            NONE => self.cells[sprite.cell as usize] = sprite.cell_next,
            previous => self.sprites[usize::from(previous)].cell_next = sprite.cell_next,
        }
        if sprite.cell_next != NONE {
            self.sprites[usize::from(sprite.cell_next)].cell_previous = sprite.cell_previous;
        }
        self.groups[sprite.stype.index()].loose -= u16::from(self.is_loose(sprite.rect));
    }

    /// Whether any sprite of the tree is not aligned to one cell: then neighbours have to be asked too.
    fn has_loose(&self, tree: &[SpriteType]) -> bool {
        tree.iter().any(|&stype| self.group(stype).loose > 0)
    }

    /// Collects the sprites of `family`'s tree that overlap `rect`, in no particular order. `above` excludes sprites
    /// created since that id was next.
    pub(crate) fn overlapping(
        &self,
        rules: &Rules,
        family: &TypeInfo,
        rect: Rect,
        above: u32,
        hits: &mut Hits,
    ) {
        let reach = if self.has_loose(&family.tree) { rules.reach.saturating_mul(self.block) - 1 } else { 0 };
        let columns =
            self.column(rect.x.saturating_sub(reach))..=self.column(rect.x.saturating_add(rect.w - 1));
        let rows = self.row(rect.y.saturating_sub(reach))..=self.row(rect.y.saturating_add(rect.h - 1));
        for row in rows {
            for column in columns.clone() {
                let mut at = self.cells[(row * (self.columns + 2) + column) as usize];
                while at != NONE {
                    let sprite = self.sprite(at);
                    if family.in_tree(sprite.stype) && sprite.id < above && sprite.rect.intersects(rect) {
                        hits.push(at);
                    }
                    at = sprite.cell_next;
                }
            }
        }
    }
}
