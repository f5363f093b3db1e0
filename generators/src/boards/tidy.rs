//! Tidying of boards. It creates variants that each lack a small part, so that a search can determine whether that part
//! matters.

use super::draft::Draft;

/// The maximum number of cells in a group that can be removed as a whole.
const SMALL: usize = 2;

impl Draft<'_> {
    /// Returns the sound boards that each lack one small group, ordered from the smallest group to the largest. A group
    /// consists of walls away from the border, or of one piece that is not counted by any goal and whose number exceeds
    /// the minimum.
    pub(crate) fn tidied(&self) -> Vec<Self> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let walls = self.grid.regions(|cell| self.is_wall(cell));
        groups.extend(walls.into_iter().filter(|group| group.len() <= SMALL));
        for piece in self.kit.pieces.iter().filter(|piece| !self.kit.is_aim(piece.stype)) {
            if self.count(piece.symbol) > piece.counts.0 {
                let own = self.pieces().into_iter().filter(|&cell| self.cells[cell] == piece.symbol);
                groups.extend(own.map(|cell| vec![cell]));
            }
        }
        groups.sort_by_key(Vec::len);
        let without = |group: Vec<usize>| {
            let mut draft = self.clone();
            group.into_iter().for_each(|cell| draft.clear(cell));
            draft.is_sound().then_some(draft)
        };
        groups.into_iter().filter_map(without).collect()
    }
}
