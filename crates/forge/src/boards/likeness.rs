//! The similarity of two boards, up to mirroring and rotation. Used to prevent the levels of one game from repeating a
//! board.

use engine::Level;

/// The similarity at which two levels of a game count as the same board. For the median hand-written game, the highest
/// similarity between two levels is 0.54. Two of the 27 hand-written games have levels above this threshold.
const ONE_BOARD: f64 = 0.75;
/// The symbol of bare floor in generated levels.
const FLOOR: u8 = b'.';
/// The maximum number of cells by which a board may overhang the edge of the other board when the two are aligned.
const SHIFT: isize = 1;

/// The symbols of a board, row by row.
struct Board {
    columns: usize,
    rows: usize,
    cells: Vec<u8>,
}

/// Returns `true` if two levels show the same board except for mirroring, rotation, a shift, and a few cells.
pub(crate) fn are_one_board(one: &Level, other: &Level) -> bool {
    likeness(&Board::of(one), &Board::of(other)) >= ONE_BOARD
}

/// Returns the similarity of two boards at their best alignment, from 0 to 1. It is the fraction of equal cells,
/// ignoring cells that are bare floor on both boards. Costs half a million comparisons for the largest generated
/// boards.
fn likeness(one: &Board, other: &Board) -> f64 {
    let shifts = |a: usize, b: usize| {
        let spare = a as isize - b as isize;
        spare.min(0) - SHIFT..=spare.max(0) + SHIFT
    };
    let mut most = 0.0_f64;
    for turned in other.turned() {
        for dy in shifts(one.rows, turned.rows) {
            for dx in shifts(one.columns, turned.columns) {
                most = most.max(one.overlap(&turned, (dx, dy)));
            }
        }
    }
    most
}

impl Board {
    fn of(level: &Level) -> Board {
        Board { columns: level.columns(), rows: level.rows(), cells: level.cells().to_vec() }
    }

    /// Returns the symbol of a cell, or bare floor for a position outside the board.
    fn at(&self, x: isize, y: isize) -> u8 {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.columns && y < self.rows => self.cells[y * self.columns + x],
            _ => FLOOR,
        }
    }

    /// Returns the number of cells that are not bare floor.
    fn filled(&self) -> usize {
        self.cells.iter().filter(|&&symbol| symbol != FLOOR).count()
    }

    /// Returns the fraction of equal cells after shifting the second board, ignoring cells that are bare floor on both
    /// boards.
    fn overlap(&self, other: &Board, (dx, dy): (isize, isize)) -> f64 {
        let (mut equal, mut shared) = (0, 0);
        for (at, &symbol) in other.cells.iter().enumerate().filter(|(_, symbol)| **symbol != FLOOR) {
            let here = self.at((at % other.columns) as isize + dx, (at / other.columns) as isize + dy);
            equal += usize::from(here == symbol);
            shared += usize::from(here != FLOOR);
        }
        equal as f64 / (self.filled() + other.filled() - shared).max(1) as f64
    }

    /// Returns the eight rotations and mirror images of the board.
    fn turned(&self) -> impl Iterator<Item = Board> + '_ {
        (0..8).map(|way| {
            let (across, down, swapped) = (way & 1 != 0, way & 2 != 0, way & 4 != 0);
            let (columns, rows) = if swapped { (self.rows, self.columns) } else { (self.columns, self.rows) };
            let symbol = |at: usize| {
                let (x, y) = (at % columns, at / columns);
                let (x, y) = if swapped { (y, x) } else { (x, y) };
                let x = if across { self.columns - 1 - x } else { x };
                let y = if down { self.rows - 1 - y } else { y };
                self.cells[y * self.columns + x]
            };
            Board { columns, rows, cells: (0..columns * rows).map(symbol).collect() }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable\n    plum > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    p > plum\n  InteractionSet\n    avatar wall > stepBack\n    plum avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=plum win=True\n";
    const BOARD: &str = "wwwwww\nwA..pw\nw.ww.w\nw..w.w\nwwwwww\n";

    fn check(other: &str, is_one: bool) {
        let game = Game::from_source(GAME).unwrap();
        let [one, other] = [BOARD, other].map(|text| game.level(text).unwrap());
        assert_eq!(are_one_board(&one, &other), is_one, "{other}");
        assert_eq!(are_one_board(&other, &one), is_one, "{other}");
    }

    #[test]
    fn mirror_images_turns_and_shifts_are_one_board() {
        check(BOARD, true);
        check("wwwwww\nwp..Aw\nw.ww.w\nw.w..w\nwwwwww\n", true);
        check("wwwww\nw..Aw\nw.w.w\nwww.w\nw..pw\nwwwww\n", true);
        check("wwwwwww\nwwA..pw\nww.ww.w\nww..w.w\nwwwwwww\n", true);
        check("wwwwww\nwA..pw\nw.ww.w\nw..wpw\nwwwwww\n", true);
        check("wwwwwwwww\nwA......w\nwwwww.w.w\nwp....w.w\nwwwwwwwww\n", false);
    }
}
