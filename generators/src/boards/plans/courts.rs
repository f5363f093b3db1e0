//! Plans for courts: open ground around a landmark, which is the plan's main feature.

use super::between;
use crate::boards::canvas::Canvas;
use base::Sampler;

/// The sizes of pillars, as columns and rows.
const PILLARS: [(usize, usize); 5] = [(1, 2), (2, 1), (2, 2), (3, 1), (1, 3)];
/// The shapes of islands, each given as rectangles with offsets: an angle, a step, a bar, a block, a hook and a T.
const SHAPES: [&[(usize, usize, usize, usize)]; 6] = [
    &[(0, 0, 1, 2), (0, 1, 3, 1)],
    &[(0, 0, 2, 1), (1, 1, 2, 1)],
    &[(0, 0, 3, 1)],
    &[(0, 0, 2, 2)],
    &[(0, 0, 1, 3), (0, 0, 2, 1)],
    &[(0, 0, 3, 1), (1, 1, 1, 1)],
];

/// Draws a court with rows of pillars, each row offset from the last. One quarter of the court stays open.
pub(super) fn courtyard(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let (across, down) = *sampler.choose(&PILLARS);
    let (step_x, step_y) = (across + between(sampler, 2, 3), down + 2);
    let (left, top) = (between(sampler, 2, 3), between(sampler, 2, 3));
    let shift = sampler.below(step_x);
    let open = (sampler.below(2), sampler.below(2));
    let mut row = 0;
    let mut y = 1 + top;
    while y + down <= height {
        let mut x = 1 + left + if row % 2 == 1 { shift } else { 0 };
        while x + across <= width {
            let quarter = (usize::from(x * 2 > width), usize::from(y * 2 > height));
            if quarter != open {
                canvas.fill((x, y), (across, down));
            }
            x += step_x;
        }
        y += step_y;
        row += 1;
    }
    let at = |side: usize, size: usize| if side == 0 { 2 } else { size / 2 + 1 };
    canvas.mark((at(open.0, width), at(open.1, height)), (width / 2, height / 2));
}

/// Draws a path around an off-centre block that has a niche in one of its sides.
pub(super) fn ring(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let across = between(sampler, width / 3, width.saturating_sub(4)).max(3);
    let down = between(sampler, height / 3, height.saturating_sub(4)).max(2);
    let x = between(sampler, 3, width.saturating_sub(across + 1));
    let y = between(sampler, 3, height.saturating_sub(down + 1));
    canvas.fill((x, y), (across, down));
    let deep = (down - 1).clamp(1, 2);
    let niche = (x + sampler.below(across.saturating_sub(2).max(1)), y);
    canvas.clear(niche, (2, deep));
    canvas.mark(niche, (2, deep));
    if across > 4 && sampler.ratio(1, 2) {
        // A notch at the far end keeps the block from being a plain rectangle.
        canvas.clear((x + across - 2, y + down - 1), (2, 1));
    }
}

/// Draws a court inside a moat that can be crossed at one or two points.
pub(super) fn moat(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let across = between(sampler, 4, width.saturating_sub(4));
    let down = between(sampler, 3, height.saturating_sub(2).min(5));
    let x = between(sampler, 2, width.saturating_sub(across));
    let y = if down + 2 > height { 1 } else { between(sampler, 1, height - down) };
    let (right, bottom) = ((x + across - 1).min(width), (y + down - 1).min(height));
    // A moat next to the border needs no line on that side.
    let mut corners = vec![(x, y), (right, y), (right, bottom), (x, bottom), (x, y)];
    if y == 1 {
        corners = vec![(x, y), (x, bottom), (right, bottom), (right, y)];
    }
    let mut line = canvas.path(&corners);
    if line.len() > 1 && line.first() == line.last() {
        line.pop();
    }
    let gaps = between(sampler, 1, 2);
    canvas.divide(line, gaps, sampler);
    let inside = if y == 1 { (x + 1, y) } else { (x + 1, y + 1) };
    canvas.mark(inside, (across - 2, bottom.saturating_sub(inside.1)));
}

/// Draws a keep in a corner of the board. The keep's wall has a jog, and a short matching wall stands outside.
pub(super) fn keep(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let x = between(sampler, 4, (width * 3 / 5).max(4));
    let y = between(sampler, 3, (height * 3 / 5).max(3));
    let jog = between(sampler, 2, x - 2);
    let lower = (y + 1).min(height - 1);
    let corners = match sampler.below(3) {
        0 => vec![(x, 1), (x, y), (1, y)],
        1 => vec![(x, 1), (x, y), (jog, y), (jog, lower), (1, lower)],
        _ => vec![
            (x, 1),
            (x, y.saturating_sub(1).max(2)),
            (x - 1, y.saturating_sub(1).max(2)),
            (x - 1, y),
            (1, y),
        ],
    };
    let line = canvas.path(&corners);
    let gaps = between(sampler, 1, 2);
    canvas.divide(line, gaps, sampler);
    canvas.mark((1, 1), (x - 1, y - 1));
    let (from_x, from_y) = (x + 3, y + 2);
    if from_x < width && from_y < height {
        let long = between(sampler, 2, 4);
        match sampler.below(3) {
            0 => canvas.fill((from_x, from_y), (long.min(width - from_x), 1)),
            1 => canvas.fill((from_x, from_y - 1), (1, long.min(height - from_y))),
            _ => {
                canvas.fill((from_x, from_y), (2, 1));
                canvas.fill((from_x, from_y - 1), (1, 2));
            }
        }
    }
}

/// Draws blocks of one or two shapes, scattered over open ground, with room to walk around each.
pub(super) fn islands(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let shapes = [*sampler.choose(&SHAPES), *sampler.choose(&SHAPES)];
    let wanted = (width * height / 16).clamp(3, 7);
    let mut placed: Vec<(usize, usize)> = Vec::new();
    for _ in 0..60 {
        if placed.len() >= wanted {
            break;
        }
        let (x, y) =
            (between(sampler, 2, width.saturating_sub(3)), between(sampler, 2, height.saturating_sub(2)));
        let is_near =
            |&(other_x, other_y): &(usize, usize)| x.abs_diff(other_x) < 5 && y.abs_diff(other_y) < 4;
        if placed.iter().any(is_near) {
            continue;
        }
        let flip = sampler.ratio(1, 2);
        for &(dx, dy, across, down) in shapes[placed.len() % 2] {
            let dx = if flip { 3 - dx - across } else { dx };
            canvas.fill((x + dx, y + dy), (across, down));
        }
        placed.push((x, y));
    }
    if let Some(&(x, y)) = placed.first() {
        canvas.mark((x.saturating_sub(1).max(1), y.saturating_sub(1).max(1)), (5, 4));
    }
}

/// Draws a wall around three sides of a court. One arm is shorter than the other, and there is a gap at the back.
pub(super) fn cloister(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let across = between(sampler, 5, width.saturating_sub(3));
    let x = between(sampler, 2, width.saturating_sub(across));
    let y = between(sampler, 2, 3);
    let right = (x + across - 1).min(width - 1);
    let left_arm = between(sampler, (y + 1).min(height - 1), height - 1);
    let right_arm = between(sampler, (y + 1).min(height - 1), height - 1);
    let line = canvas.path(&[(x, left_arm), (x, y), (right, y), (right, right_arm)]);
    let gaps = between(sampler, 1, 2);
    canvas.divide(line, gaps, sampler);
    canvas.mark((x + 1, y + 1), (right.saturating_sub(x + 1), left_arm.min(right_arm).saturating_sub(y)));
    if across >= 8 && height - y >= 5 {
        let middle = x + across / 2 - sampler.below(2);
        canvas.fill((middle, y + 2), (2, 1 + sampler.below(2)));
    }
}
