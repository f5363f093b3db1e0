//! Open layouts: short walls and pillars.

use super::mirror::Mirror;
use crate::levels::grid::{Grid, WAYS};
use base::Sampler;

/// Draws straight and bent walls of two to four cells that do not touch each other or the border.
pub(super) fn pieces(grid: Grid, ring: bool, sampler: &mut Sampler, wall: &mut [bool]) {
    let mirror = Mirror::draw(sampler);
    let margin = if ring { 2 } else { 1 };
    if grid.columns <= 2 * margin || grid.rows <= 2 * margin {
        return;
    }
    let wanted = grid.len() / 14;
    let mut made = 0;
    for _ in 0..60 {
        if made >= wanted {
            return;
        }
        let (x, y) = (
            sampler.between(margin, grid.columns - margin - 1),
            sampler.between(margin, grid.rows - margin - 1),
        );
        let mut cell = grid.at(x, y);
        let mut piece = vec![cell];
        let mut way = *sampler.choose(&WAYS);
        for _ in 0..sampler.between(1, 3) {
            if sampler.ratio(1, 3) {
                way = *sampler.choose(&WAYS);
            }
            let Some(next) = grid.shift(cell, way) else { break };
            let inside = (margin..grid.columns - margin).contains(&grid.x(next))
                && (margin..grid.rows - margin).contains(&grid.y(next));
            if inside && !piece.contains(&next) {
                piece.push(next);
                cell = next;
            }
        }
        let reflected: Vec<usize> = piece.iter().map(|&cell| mirror.of(grid, cell)).collect();
        piece.extend(reflected);
        piece.sort_unstable();
        piece.dedup();
        let apart = |cell: &usize| {
            grid.around(*cell).into_iter().flatten().all(|next| !wall[next] || grid.on_border(next))
        };
        if piece.iter().all(apart) {
            made += piece.len();
            for cell in piece {
                wall[cell] = true;
            }
        }
    }
}

/// Draws single blocks two or three cells apart, and omits some of them.
pub(super) fn pillars(grid: Grid, ring: bool, sampler: &mut Sampler, wall: &mut [bool]) {
    let margin = if ring { 2 } else { 1 };
    let (across, down) = (sampler.between(2, 3), sampler.between(2, 3));
    let keep = sampler.between(6, 10);
    let mirror = Mirror::draw(sampler);
    let centre = |size: usize, gap: usize| {
        // Both sides share the remaining width.
        let inner = size.saturating_sub(2 * margin);
        margin + (inner.saturating_sub(1) % gap) / 2
    };
    let (from_x, from_y) = (centre(grid.columns, across), centre(grid.rows, down));
    for y in (from_y..grid.rows.saturating_sub(margin)).step_by(down) {
        for x in (from_x..grid.columns.saturating_sub(margin)).step_by(across) {
            let cell = grid.at(x, y);
            if sampler.ratio(keep, 10) {
                wall[cell] = true;
                let other = mirror.of(grid, cell);
                let alone = grid.around(other).into_iter().flatten();
                wall[other] |=
                    alone.into_iter().all(|next| !wall[next] && !grid.on_border(next) || next == cell);
            }
        }
    }
}
