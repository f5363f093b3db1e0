//! Enlargement of boards. A column or row can be doubled if doubling it neither changes a path nor separates adjacent
//! sprites.

use super::Board;
use super::cell::Cell;
use base::Sampler;

/// The minimum number of cells at which a type counts as ground rather than as separate sprites. Ground continues into
/// doubled lines.
const GROUND: usize = 6;

/// Doubles columns and rows, chosen at random, until the board is large enough or no line can be doubled.
///
/// A new line can be inserted between two lines if each pair of facing cells consists of the same ground or includes
/// floor or a wall. A new cell becomes a wall next to a wall, floor next to floor, and otherwise the ground of both
/// sides. Thus, no path is opened or closed.
pub(super) fn stretch(board: Board, (columns, rows): Cell, sampler: &mut Sampler) -> Board {
    let wider = widened(board, columns, sampler);
    widened(wider.transposed(), rows, sampler).transposed()
}

fn widened(mut board: Board, columns: usize, sampler: &mut Sampler) -> Board {
    while board.columns < columns {
        // The border keeps its width.
        let gaps: Vec<(usize, Vec<Option<String>>)> =
            (2..board.columns - 1).filter_map(|x| Some((x, between(&board, x)?))).collect();
        if gaps.is_empty() {
            break;
        }
        let (x, column) = &gaps[sampler.below(gaps.len())];
        board = with_column(&board, *x, column);
    }
    board
}

/// Returns the cells of a new column before column `x`; `None` if the column would separate adjacent sprites.
fn between(board: &Board, x: usize) -> Option<Vec<Option<String>>> {
    let is_ground =
        |stype: &str| board.cells.iter().flatten().filter(|other| *other == stype).count() >= GROUND;
    let cell = |y: usize| {
        let sides = (board.at((x - 1, y)), board.at((x, y)));
        match sides {
            (Some("wall"), _) | (_, Some("wall")) => Some(Some("wall".to_owned())),
            (None, _) | (_, None) => Some(None),
            (Some(one), Some(other)) => (one == other && is_ground(one)).then(|| Some(one.to_owned())),
        }
    };
    (0..board.rows).map(cell).collect()
}

fn with_column(board: &Board, at: usize, column: &[Option<String>]) -> Board {
    let mut wider = Board::walls(board.columns + 1, board.rows);
    for (y, doubled) in column.iter().enumerate() {
        for x in 0..wider.columns {
            let stype = match x.cmp(&at) {
                std::cmp::Ordering::Less => board.at((x, y)),
                std::cmp::Ordering::Equal => doubled.as_deref(),
                std::cmp::Ordering::Greater => board.at((x - 1, y)),
            };
            wider.put((x, y), stype);
        }
    }
    wider
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use std::collections::BTreeMap;

    const WALLS: &str = "\
#########
#a.....p#
#.##.##.#
#.#sss#.#
#.#sss#.#
#kk...e.#
#########";

    fn board(text: &str) -> Board {
        let rows: Vec<&str> = text.lines().collect();
        let mut board = Board::walls(rows[0].len(), rows.len());
        for (y, row) in rows.iter().enumerate() {
            for (x, symbol) in row.chars().enumerate() {
                let name = symbol.to_string();
                board.put(
                    (x, y),
                    match symbol {
                        '#' => Some("wall"),
                        '.' => None,
                        _ => Some(&name),
                    },
                );
            }
        }
        board
    }

    fn counts(board: &Board) -> BTreeMap<&str, usize> {
        let mut counts = BTreeMap::new();
        board.cells.iter().flatten().for_each(|stype| *counts.entry(stype.as_str()).or_default() += 1);
        counts
    }

    /// Returns the sprites that the avatar can reach.
    fn reached(board: &Board) -> Vec<String> {
        let cells = (0..board.rows).flat_map(|y| (0..board.columns).map(move |x| (x, y)));
        let start = cells.into_iter().find(|&cell| board.at(cell) == Some("a")).unwrap();
        let steps = board.steps_from(start, |cell| !board.is_wall(cell) && board.at(cell) != Some("e"));
        let mut things: Vec<String> =
            steps.keys().filter_map(|&cell| board.at(cell)).map(str::to_owned).collect();
        things.sort();
        things.retain(|stype| stype != "s");
        things
    }

    #[test]
    fn a_stretched_board_has_the_same_things_and_ways() {
        let before = board(WALLS);
        for number in 0..20 {
            let sampler = &mut Seed::from_text("stretch").child("draw", number).sampler();
            let after = stretch(before.clone(), (14, 9), sampler);
            assert_eq!((after.columns, after.rows), (14, 9));
            let things = |board: &Board| {
                let mut counts = counts(board);
                counts.retain(|stype, _| !["wall", "s"].contains(stype));
                counts.into_iter().map(|(stype, count)| (stype.to_owned(), count)).collect::<Vec<_>>()
            };
            assert_eq!(things(&after), things(&before));
            assert_eq!(reached(&after), reached(&before));
            // Adjacent sprites stay adjacent, ground continues, and the border is as wide as before.
            let row =
                |y: usize| (0..after.columns).map(|x| after.at((x, y)).unwrap_or(".")).collect::<String>();
            let rows: Vec<String> = (0..after.rows).map(row).collect();
            assert!(rows.iter().any(|row| row.contains("kk")), "{rows:?}");
            assert!(counts(&after)["s"] >= 6);
            let inner = |cell: Cell| {
                cell.0 > 0 && cell.1 > 0 && cell.0 + 1 < after.columns && cell.1 + 1 < after.rows
            };
            let rim = (0..after.columns).flat_map(|x| (0..after.rows).map(move |y| (x, y)));
            assert!(rim.into_iter().filter(|&cell| !inner(cell)).all(|cell| after.is_wall(cell)));
        }
    }

    #[test]
    fn what_cannot_be_stretched_stays() {
        let full = board("####\n#ab#\n#cd#\n####");
        let sampler = &mut Seed::from_text("stretch").sampler();
        assert_eq!(stretch(full.clone(), (9, 9), sampler), full);
        let small = board(WALLS);
        assert_eq!(stretch(small.clone(), (3, 3), sampler), small);
    }
}
