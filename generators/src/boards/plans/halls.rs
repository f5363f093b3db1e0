//! Plans for halls: open ground with partitions.

use super::between;
use crate::boards::canvas::Canvas;
use base::Sampler;

/// Draws a hall with long partitions of unequal lengths, at least two cells apart.
pub(super) fn aisles(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let mut y = between(sampler, 3, 4);
    let side = sampler.below(2);
    let mut bar = 0;
    while y < height {
        let from = if (bar + side).is_multiple_of(3) { 1 } else { between(sampler, 2, 4) };
        let to = if (bar + side) % 3 == 1 { width } else { width - between(sampler, 1, 3) };
        let line = canvas.path(&[(from, y), (to, y)]);
        let gaps = usize::from(line.len() > 5 && sampler.ratio(2, 3));
        canvas.divide(line, gaps, sampler);
        y += between(sampler, 3, 4);
        bar += 1;
    }
    let end = if side == 0 { width - 2 } else { 1 };
    canvas.mark((end, 1), (3, height));
}

/// Draws two wide avenues that cross between four blocks of different sizes. One block is hollow.
pub(super) fn cross(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let wide = if height < 7 { 2 } else { between(sampler, 2, 3) };
    let x = between(sampler, width / 3, (width * 2 / 3).saturating_sub(wide).max(width / 3)).max(3);
    let y = between(sampler, height / 3, (height * 2 / 3).saturating_sub(wide).max(height / 3)).max(3);
    let hollow = sampler.below(4);
    for corner in 0..4 {
        let (east, south) = (corner & 1 != 0, corner & 2 != 0);
        // The sides that face the avenues vary, and some blocks leave a lane along the border.
        let (left, right) = if east { (x + wide, width) } else { (1, x - 1) };
        let (top, bottom) = if south { (y + wide, height) } else { (1, y - 1) };
        if right < left || bottom < top {
            continue;
        }
        let size = (right + 1 - left, bottom + 1 - top);
        if corner == hollow && size.0 >= 3 && size.1 >= 2 {
            let wall_y = if south { top } else { bottom };
            let wall_x = if east { left } else { right };
            let end = if east { right } else { left };
            let far = if south { bottom } else { top };
            let line = canvas.path(&[(end, wall_y), (wall_x, wall_y), (wall_x, far)]);
            canvas.divide(line, 1, sampler);
            canvas.mark((left, top), size);
            continue;
        }
        let (cut_x, cut_y) =
            (sampler.below(3).min(size.0.saturating_sub(2)), sampler.below(2).min(size.1 - 1));
        let from_x = if east { left + cut_x } else { left };
        let from_y = if south { top + cut_y } else { top };
        canvas.fill((from_x, from_y), (size.0 - cut_x, size.1 - cut_y));
        if size.0 > 4 && size.1 > 2 && sampler.ratio(1, 2) {
            // A bay in the block, two cells wide.
            let bay_y = if south { from_y } else { bottom - cut_y };
            canvas.clear((left + 1 + sampler.below(size.0 - 3), bay_y), (2, 1));
        }
    }
    canvas.mark((x, y), (wide, wide));
}

/// Draws two banks with a river that winds from one side of the board to the other.
pub(super) fn banks(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let mut x = between(sampler, width * 2 / 5, width * 3 / 5);
    let mut corners = vec![(x, 1)];
    let mut y = 1;
    while y < height {
        y = (y + between(sampler, 2, 3)).min(height);
        corners.push((x, y));
        if y < height {
            let next = if sampler.ratio(1, 2) {
                x + between(sampler, 1, 2)
            } else {
                x.saturating_sub(between(sampler, 1, 2))
            };
            x = next.min(width.saturating_sub(3)).max(4.min(width - 1));
            corners.push((x, y));
        }
    }
    let line = canvas.path(&corners);
    let gaps = between(sampler, 1, 2);
    canvas.divide(line, gaps, sampler);
    canvas.mark((width - 2, 2), (3, height - 2));
    for side in [2, width.saturating_sub(3).max(2)] {
        if sampler.ratio(2, 3) {
            let y = between(sampler, 2, height.saturating_sub(2));
            let size = *sampler.choose(&[(2, 1), (1, 2), (2, 2)]);
            canvas.fill((side.min(width - 1), y), size);
        }
    }
}

/// Draws two or three walls of unequal lengths from alternating sides, each with a hook at its end.
pub(super) fn staggered(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let mut x = between(sampler, 3, 4);
    let mut from_top = sampler.ratio(1, 2);
    while x + 2 <= width {
        let long = between(sampler, height / 2, (height * 3 / 4).max(height / 2));
        let end = if from_top { long } else { height + 1 - long };
        let start = if from_top { 1 } else { height };
        let hook = if sampler.ratio(1, 2) { (x + 1).min(width) } else { x - 1 };
        let corners = match sampler.ratio(2, 3) {
            true => vec![(x, start), (x, end), (hook, end)],
            false => vec![(x, start), (x, end)],
        };
        let line = canvas.path(&corners);
        let gaps = usize::from(sampler.ratio(1, 2));
        canvas.divide(line, gaps, sampler);
        from_top = !from_top;
        x += between(sampler, 3, 5);
    }
    canvas.mark((width - 2, if from_top { height / 2 } else { 1 }), (3, height / 2 + 1));
}

/// Draws two or three terraces. The border between two terraces contains a step, and its gates are far from those of
/// the next border.
pub(super) fn terraces(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let borders = if width >= 12 { 2 } else { 1 };
    let step = (width + 1) / (borders + 1);
    for border in 1..=borders {
        let x = (border * step + sampler.below(3)).saturating_sub(1).min(width - 2).max(3);
        let jog = between(sampler, 2, (height - 1).max(2));
        let next = if sampler.ratio(1, 2) { (x + between(sampler, 1, 2)).min(width - 1) } else { x - 1 };
        let line = canvas.path(&[(x, 1), (x, jog), (next, jog), (next, height)]);
        let gaps = between(sampler, 1, 2);
        canvas.divide(line, gaps, sampler);
    }
    canvas.mark((width - 2, 1), (3, height));
}

/// Draws chambers of unequal sizes on two sides of a hall, each with a door.
pub(super) fn chambers(canvas: &mut Canvas, sampler: &mut Sampler) {
    let (width, height) = (canvas.width(), canvas.height());
    let top = if height >= 7 { 3 } else { 0 };
    let bottom = height - 2;
    let mut rows: Vec<(usize, usize, usize)> = vec![(bottom, bottom + 1, height)];
    if top > 0 && bottom > top + 2 {
        rows.push((top, 1, top - 1));
    }
    for (wall, from, to) in rows {
        let mut left = 1;
        while left + 2 <= width {
            let mut right = left + between(sampler, 2, 4);
            if right + 3 > width {
                right = width;
            }
            let is_open = sampler.ratio(1, 4);
            if !is_open {
                let line = canvas.path(&[(left, wall), (right, wall)]);
                canvas.divide(line, 1, sampler);
                canvas.mark((left, from), (right + 1 - left, to + 1 - from));
            }
            if right < width {
                canvas.fill((right + 1, from.min(wall)), (1, to.max(wall) + 1 - from.min(wall)));
            }
            left = right + 2;
        }
    }
}
