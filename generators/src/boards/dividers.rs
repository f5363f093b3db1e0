//! The material of a board's dividing lines: walls with gaps, or the game's own barriers.

use super::canvas::{Canvas, Divider};
use super::draft::Draft;
use super::idiom::Idiom;
use super::kit::{Kit, Piece};
use base::Sampler;

/// Pieces still to be placed, with the number of each.
pub(crate) type Stock = Vec<(Piece, usize)>;

/// Places a plan's walls and dividers. A gap contains a barrier or stays open. A river has at most one gap.
pub(crate) fn lay<'k>(
    kit: &'k Kit<'k>,
    canvas: &Canvas,
    stock: &mut Stock,
    sampler: &mut Sampler,
) -> Draft<'k> {
    let base = kit.palette.base;
    let wall = kit.palette.wall.unwrap_or(base);
    let cells = canvas.wall.iter().map(|&is_wall| if is_wall { wall } else { base }).collect();
    let mut draft = Draft { kit, grid: canvas.grid, cells };
    lay_ponds(&mut draft, stock, sampler);
    let mut order: Vec<&Divider> = canvas.dividers.iter().collect();
    sampler.shuffle(&mut order);
    let mut has_row = false;
    for divider in order {
        match material(divider, stock, has_row, sampler) {
            Some(at) if stock[at].0.idiom == Idiom::Obstacle => {
                let symbol = stock[at].0.symbol;
                lay_wall(&mut draft, divider, symbol, stock, sampler);
            }
            Some(at) => {
                has_row = true;
                lay_row(&mut draft, divider, &mut stock[at], sampler);
            }
            None if kit.palette.wall.is_some() => lay_wall(&mut draft, divider, wall, stock, sampler),
            None => {}
        }
    }
    draft
}

/// Replaces some wall blocks that are not on the border with ponds, if the game has a suitable type.
fn lay_ponds(draft: &mut Draft<'_>, stock: &Stock, sampler: &mut Sampler) {
    let Some((piece, _)) = stock.iter().find(|(piece, _)| piece.idiom == Idiom::Obstacle) else { return };
    let blocks = draft.grid.regions(|cell| draft.is_wall(cell));
    for block in blocks.into_iter().filter(|block| !block.iter().any(|&cell| draft.grid.on_border(cell))) {
        if sampler.ratio(1, 2) {
            block.into_iter().for_each(|cell| draft.cells[cell] = piece.symbol);
        }
    }
}

/// Draws the index of the piece that forms a divider; `None` for walls.
fn material(divider: &Divider, stock: &Stock, has_row: bool, sampler: &mut Sampler) -> Option<usize> {
    let weight = |(piece, _): &(Piece, usize)| {
        let long = divider.line.len();
        let most = if piece.asked { piece.counts.1 } else { piece.counts.1.max(14) };
        match piece.idiom {
            Idiom::Obstacle => 6,
            _ if has_row || long > most || long < 3 => 0,
            Idiom::Crossing => 9,
            Idiom::Ground => 3,
            Idiom::Barrier if piece.counts.1 >= long => 2,
            _ => 0,
        }
    };
    let weights: Vec<u32> = stock.iter().map(weight).chain([4]).collect();
    sampler.weighted(&weights).filter(|&at| at < stock.len())
}

/// Places a divider as a row of pieces.
fn lay_row(
    draft: &mut Draft<'_>,
    divider: &Divider,
    (piece, left): &mut (Piece, usize),
    sampler: &mut Sampler,
) {
    let open = sampler.ratio(1, 2) && piece.idiom != Idiom::Ground;
    let gap = divider.gaps.first().filter(|_| open);
    for &cell in &divider.line {
        if gap.is_none_or(|gap| !gap.contains(&cell)) {
            draft.cells[cell] = piece.symbol;
            *left = left.saturating_sub(1);
        }
    }
}

/// Places a divider as a wall, with barriers in some of its gaps.
fn lay_wall(draft: &mut Draft<'_>, divider: &Divider, wall: u8, stock: &mut Stock, sampler: &mut Sampler) {
    let in_gap = |cell: &usize| divider.gaps.iter().any(|gap| gap.contains(cell));
    for cell in divider.line.iter().filter(|cell| !in_gap(cell)) {
        draft.cells[*cell] = wall;
    }
    for gap in &divider.gaps {
        let weight = |(piece, left): &(Piece, usize)| match piece.idiom {
            _ if *left < gap.len() => 0,
            Idiom::Barrier | Idiom::Road => 9,
            Idiom::Ground => 2,
            _ => 0,
        };
        let weights: Vec<u32> = stock.iter().map(weight).chain([3]).collect();
        let Some(at) = sampler.weighted(&weights).filter(|&at| at < stock.len()) else { continue };
        stock[at].1 -= gap.len();
        gap.iter().for_each(|&cell| draft.cells[cell] = stock[at].0.symbol);
    }
}
