//! An episode's boards. Each board is stored as a difference from the previous board.

use render::{Picture, Tile, svg_tile};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::fmt::Write;

/// The tiles on a game's boards. Each tile is stored once in the page.
pub(super) struct Tiles {
    pub(super) prefix: String,
    known: Vec<Tile>,
}

impl Tiles {
    pub(super) fn new(prefix: String) -> Tiles {
        Tiles { prefix, known: Vec::new() }
    }

    /// Returns the tiles as SVG groups with IDs.
    pub(super) fn symbols(&self) -> String {
        let symbol = |(at, tile)| svg_tile(&format!("{}{at}", self.prefix), tile);
        self.known.iter().enumerate().map(symbol).collect()
    }

    fn number(&mut self, tile: &Tile) -> usize {
        self.known.iter().position(|known| known == tile).unwrap_or_else(|| {
            self.known.push(tile.clone());
            self.known.len() - 1
        })
    }
}

/// A tile's index, and its left edge, top edge, width and height in pixels.
type Mark = (usize, [i32; 4]);

pub(super) struct Boards {
    cell: i32,
    last: Vec<Mark>,
    /// For each board, the replacements that turn the previous board into it, ordered from the end of the
    /// board to its beginning. The first board replaces an empty one.
    pub(super) changes: Vec<String>,
}

impl Boards {
    /// Creates an empty sequence of boards whose cells have `cell` pixels.
    pub(super) fn new(cell: u32) -> Boards {
        Boards { cell: cell.cast_signed(), last: Vec::new(), changes: Vec::new() }
    }

    /// Adds a board to the sequence. Cost: O(stamps · changes).
    pub(super) fn push(&mut self, picture: &Picture, tiles: &mut Tiles) {
        let here: Vec<usize> = picture.tiles().iter().map(|tile| tiles.number(tile)).collect();
        let place =
            |place: render::Place| [place.x, place.y, place.w, place.h].map(|part| part.round() as i32);
        let marks: Vec<Mark> =
            picture.stamps().iter().map(|stamp| (here[stamp.tile], place(stamp.place))).collect();
        self.changes.push(change(&self.last, &marks, self.cell));
        self.last = marks;
    }
}

/// Returns the change from one board to the next, with one line `AT COUNT MARK…` per replaced range. The last range
/// comes first, so that the positions of earlier ranges stay valid. A mark is written as `TILE,X,Y`, followed by its
/// width and height if they differ from those of a cell.
fn change(from: &[Mark], to: &[Mark], cell: i32) -> String {
    let mut text = String::new();
    for op in capture_diff_slices(Algorithm::Myers, from, to).iter().rev() {
        if matches!(op, DiffOp::Equal { .. }) {
            continue;
        }
        let (old, new) = (op.old_range(), op.new_range());
        if !text.is_empty() {
            text.push('\n');
        }
        let _ = write!(text, "{} {}", old.start, old.len());
        for (tile, [x, y, w, h]) in &to[new] {
            let _ = write!(text, " {tile},{x},{y}");
            if (*w, *h) != (cell, cell) {
                let _ = write!(text, ",{w},{h}");
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Applies a change to a board in the same way as the page's script does.
    fn applied(marks: &[Mark], change: &str, cell: i32) -> Vec<Mark> {
        let mut marks = marks.to_vec();
        for line in change.lines() {
            let parts: Vec<&str> = line.split(' ').collect();
            let (at, count): (usize, usize) = (parts[0].parse().unwrap(), parts[1].parse().unwrap());
            let mark = |text: &&str| {
                let numbers: Vec<i32> = text.split(',').map(|part| part.parse().unwrap()).collect();
                let size = if numbers.len() == 5 { [numbers[3], numbers[4]] } else { [cell, cell] };
                (usize::try_from(numbers[0]).unwrap(), [numbers[1], numbers[2], size[0], size[1]])
            };
            marks.splice(at..at + count, parts[2..].iter().map(mark));
        }
        marks
    }

    #[test]
    fn changes_lead_from_board_to_board() {
        let mark = |tile, x| (tile, [x, 0, 10, 10]);
        let boards = [
            vec![],
            vec![mark(0, 0), mark(1, 10), (2, [3, 3, 100, 4])],
            vec![mark(0, 0), mark(1, 20), (2, [3, 3, 100, 4]), mark(3, 30)],
            vec![mark(3, 30)],
            vec![mark(3, 30)],
        ];
        for pair in boards.windows(2) {
            let change = change(&pair[0], &pair[1], 10);
            assert_eq!(applied(&pair[0], &change, 10), pair[1], "{change}");
        }
        assert_eq!(change(&boards[1], &boards[2], 10), "3 0 3,30,0\n1 1 1,20,0");
        assert_eq!(change(&boards[3], &boards[4], 10), "");
    }
}
