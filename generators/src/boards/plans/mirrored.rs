//! Plans whose walls are mirror images: rooms and gates on both sides of an axis.

use super::between;
use crate::boards::canvas::{Canvas, Divider};
use base::Sampler;

/// Returns the first middle position of a side of the given length, and the number of middle positions (1 or 2).
fn middle(length: usize) -> (usize, usize) {
    (length.div_ceil(2), 2 - length % 2)
}

/// Adds a divider along a line, with gaps at the given cells.
fn divide(canvas: &mut Canvas, line: &[(usize, usize)], gaps: &[Vec<(usize, usize)>]) {
    let cells = |gap: &Vec<(usize, usize)>| gap.iter().map(|&(x, y)| canvas.grid.at(x, y)).collect();
    let gaps = gaps.iter().map(cells).collect();
    let line = canvas.path(line);
    canvas.dividers.push(Divider { line, gaps });
}

/// Returns the cells of a column that form its middle gate.
fn gate_in_column(x: usize, (y, count): (usize, usize)) -> Vec<(usize, usize)> {
    (y..y + count).map(|y| (x, y)).collect()
}

/// Returns the cells of a row that form its middle gate.
fn gate_in_row((x, count): (usize, usize), y: usize) -> Vec<(usize, usize)> {
    (x..x + count).map(|x| (x, y)).collect()
}

/// Draws a hall between two wings, with a gate to each wing and a niche at one end of the hall.
pub(super) fn wings(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let left = between(sampler, 3, (width - 5) / 2).min(width / 2);
    for x in [left, width + 1 - left] {
        divide(canvas, &[(x, 1), (x, height)], &[gate_in_column(x, middle(height))]);
    }
    let (x, count) = middle(width);
    let deep = between(sampler, 1, 2);
    for side in [x - 1, x + count] {
        canvas.fill((side, height + 1 - deep), (1, deep));
    }
    canvas.mark((x, height + 1 - deep), (count, deep));
    if width + 1 - 2 * left > 7 {
        for side in [x - 2, x + count + 1] {
            canvas.fill((side, 3), (1, 1));
        }
    }
}

/// Draws a room in the middle of the board, with gates on two opposite sides.
pub(super) fn sanctum(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let from_x = between(sampler, 3, width / 4 + 1).min((width - 3) / 2);
    let from_y = between(sampler, 2, 3).min(height / 3 + 1);
    let (to_x, to_y) = (width + 1 - from_x, height + 1 - from_y);
    let line = [(from_x, from_y), (to_x, from_y), (to_x, to_y), (from_x, to_y), (from_x, from_y + 1)];
    let gaps = if sampler.ratio(1, 2) || to_x - from_x < 4 {
        [from_x, to_x].map(|x| gate_in_column(x, middle(height)))
    } else {
        [from_y, to_y].map(|y| gate_in_row(middle(width), y))
    };
    divide(canvas, &line, &gaps);
    canvas.mark((from_x + 1, from_y + 1), (to_x - from_x - 1, to_y - from_y - 1));
}

/// Draws two halves, one behind the other, with a gate between them and a buttress on each side of both halves.
pub(super) fn gatehouse(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let y = between(sampler, height / 2, height / 2 + 1);
    divide(canvas, &[(1, y), (width, y)], &[gate_in_row(middle(width), y)]);
    let long = between(sampler, 1, 2);
    let row = between(sampler, 2, 3);
    for row in [row, height + 1 - row] {
        if row.abs_diff(y) > 1 {
            for x in [3, width + 1 - 2 - long] {
                canvas.fill((x, row), (long, 1));
            }
        }
    }
    canvas.mark((1, 1), (width, y - 1));
}

/// Draws four rooms with gates between neighbours.
pub(super) fn quarters(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let (x, y) = (width.div_ceil(2), height.div_ceil(2));
    let (gate_x, gate_y) =
        (between(sampler, 2, x.saturating_sub(2)), between(sampler, 2, y.saturating_sub(1)));
    let sides = [vec![(x, gate_y)], vec![(x, height + 1 - gate_y)]];
    divide(canvas, &[(x, 1), (x, height)], &sides);
    let floors = [vec![(gate_x, y)], vec![(width + 1 - gate_x, y)]];
    divide(canvas, &[(1, y), (x - 1, y)], &floors[..1]);
    divide(canvas, &[(x + 1, y), (width, y)], &floors[1..]);
    canvas.mark((1, 1), (x - 1, y - 1));
}
