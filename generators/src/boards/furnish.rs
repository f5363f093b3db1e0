//! The placement of pieces on a board. A type's [`Idiom`] is the kind of position that suits its sprites.

use super::canvas::{Canvas, far_from};
use super::dividers::{Stock, lay};
use super::draft::Draft;
use super::formations::{arrange, patch};
use super::idiom::Idiom;
use super::kit::{Kit, Piece};
use super::plans::draw_plan;
use crate::levels::grid::{FAR, WAYS};
use base::{Sampler, Seed};

/// The order in which pieces are placed. In general, pieces that are harder to place come first.
const ORDER: [Idiom; 13] = [
    Idiom::Crossing,
    Idiom::Exit,
    Idiom::Heavy,
    Idiom::Spot,
    Idiom::Source,
    Idiom::Patrol,
    Idiom::Ground,
    Idiom::Thing,
    Idiom::Hunter,
    Idiom::Stray,
    Idiom::Barrier,
    Idiom::Road,
    Idiom::Hazard,
];

/// The maximum size of the largest empty rectangle in a composition, as a fraction of the area within the border.
const EMPTY: f64 = 0.32;
/// The maximum number of fragments in a composition; see [`Draft::fragments`].
const FRAGMENTS: usize = 3;

/// Composes a board: a plan, the material of its dividers, the avatar, and all pieces. Returns `None` if there is no
/// room for everything, or if the board is unsound, too empty or too fragmented.
pub(crate) fn compose<'k>(kit: &'k Kit<'k>, seed: Seed) -> Option<Draft<'k>> {
    let sampler = &mut seed.child("board", 0).sampler();
    let size = kit.brief.size.unwrap_or_else(|| size(kit.brief.demand, sampler));
    let (_, canvas) = draw_plan(size, seed)?;
    let mut stock = kit.draw(sampler);
    let mut draft = lay(kit, &canvas, &mut stock, sampler);
    let hero = place_hero(&mut draft, &canvas, sampler)?;
    for idiom in ORDER {
        for (piece, count) in stock.iter().filter(|(piece, _)| piece.idiom == idiom) {
            place(&mut draft, &canvas, hero, piece, *count, sampler);
        }
    }
    top_up(&mut draft, &stock, sampler);
    let is_composed = draft.emptiness() <= EMPTY && draft.fragments() <= FRAGMENTS;
    Some(draft).filter(|draft| is_composed && draft.is_sound())
}

/// Draws the number of columns and rows for a position in the course, from 0 to 4. Later levels get larger boards.
fn size(demand: u8, sampler: &mut Sampler) -> (usize, usize) {
    let more = usize::from(demand) / 2;
    (sampler.between(10 + more, 13 + more), sampler.between(8, 9 + more))
}

/// Places the avatar where there is enough room, preferably next to a wall and neither in a gap nor at the plan's main
/// feature.
fn place_hero(draft: &mut Draft<'_>, canvas: &Canvas, sampler: &mut Sampler) -> Option<usize> {
    let zones = draft.grid.regions(|cell| draft.is_free(cell));
    let zones: Vec<&Vec<usize>> = zones.iter().filter(|zone| zone.len() >= 6).collect();
    let sizes: Vec<u32> = zones.iter().map(|zone| zone.len() as u32).collect();
    let zone = zones[sampler.weighted(&sizes)?];
    let weight = |&cell: &usize| {
        let walls = draft.walls_beside(cell).into_iter().filter(|&wall| wall).count() as u32;
        match draft.is_gap(cell) || canvas.marks.contains(&cell) {
            true => 1,
            false => 2 + 4 * walls,
        }
    };
    let weights: Vec<u32> = zone.iter().map(weight).collect();
    let cell = zone[sampler.weighted(&weights)?];
    let heroes = &draft.kit.palette.avatars;
    draft.cells[cell] = heroes[sampler.below(heroes.len())].1;
    Some(cell)
}

/// Places `count` copies of a piece.
fn place(
    draft: &mut Draft<'_>,
    canvas: &Canvas,
    hero: usize,
    piece: &Piece,
    count: usize,
    sampler: &mut Sampler,
) {
    match piece.idiom {
        Idiom::Ground | Idiom::Hazard | Idiom::Crossing => place_patches(draft, piece, count, sampler),
        Idiom::Barrier | Idiom::Road => {
            // Barriers for which no gap is left stand in a row, and no more of them are placed than necessary.
            let missing = piece.counts.0.saturating_sub(draft.count(piece.symbol)).min(count);
            let weights = weights(draft, canvas, hero, piece);
            let cells = arrange(draft.grid, missing, &weights, sampler);
            cells.into_iter().for_each(|cell| draft.cells[cell] = piece.symbol);
        }
        Idiom::Thing | Idiom::Stray => {
            // A large group may be split into two groups.
            let first = if count >= 4 && sampler.ratio(1, 2) { count / 2 } else { count };
            for part in [first, count - first].into_iter().filter(|&part| part > 0) {
                let weights = weights(draft, canvas, hero, piece);
                let cells = arrange(draft.grid, part, &weights, sampler);
                cells.into_iter().for_each(|cell| draft.cells[cell] = piece.symbol);
            }
        }
        _ => {
            for _ in 0..count {
                let weights = weights(draft, canvas, hero, piece);
                let Some(cell) = sampler.weighted(&weights) else { return };
                draft.cells[cell] = piece.symbol;
            }
        }
    }
}

/// Returns the weight of each cell for a piece. The weights depend on the kind of position that suits the piece, on the
/// plan's main feature, and on the side of the dividers to which the piece belongs.
fn weights(draft: &Draft<'_>, canvas: &Canvas, hero: usize, piece: &Piece) -> Vec<u32> {
    let near = draft.near();
    let far = far_from(draft.grid, hero, |cell| !draft.is_solid(cell));
    let is_opener = draft.kit.is_opener(piece.stype);
    let is_aim = draft.kit.is_aim(piece.stype) || piece.idiom == Idiom::Exit;
    let weight = |cell: usize| {
        if !draft.is_free(cell) {
            return 0;
        }
        let is_near = near[cell] != FAR;
        let side = match (is_opener, is_aim) {
            (true, _) if is_near => 12,
            (true, _) => 1,
            (false, true) if !is_near => 8,
            (false, true) if far.contains(&cell) => 6,
            _ => 3,
        };
        let mark = if is_aim && canvas.marks.contains(&cell) { 3 } else { 1 };
        let gap = if draft.is_gap(cell) && !matches!(piece.idiom, Idiom::Barrier | Idiom::Road | Idiom::Thing)
        {
            0
        } else {
            1
        };
        let crowd = beside_rival(draft, piece, cell);
        draft.fit(piece, cell) * side * mark * gap * crowd
    };
    (0..draft.grid.len()).map(weight).collect()
}

/// Returns 0 if a pushed piece would be next to its target and a single push would therefore suffice. Otherwise returns
/// 1.
fn beside_rival(draft: &Draft<'_>, piece: &Piece, cell: usize) -> u32 {
    let is_pair = |one: Idiom, other: Idiom| {
        matches!((one, other), (Idiom::Heavy, Idiom::Spot | Idiom::Heavy) | (Idiom::Spot, Idiom::Heavy))
    };
    let rival = |&next: &usize| {
        let other = draft.kit.piece(draft.cells[next]);
        other.is_some_and(|other| is_pair(piece.idiom, other.idiom))
    };
    u32::from(!draft.grid.beside(cell).any(|next| rival(&next)))
}

/// Places one or two patches or bands that do not cut off the avatar's cell.
fn place_patches(draft: &mut Draft<'_>, piece: &Piece, count: usize, sampler: &mut Sampler) {
    let parts = if count >= 8 && sampler.ratio(2, 3) { 2 } else { 1 };
    let is_hard = matches!(piece.idiom, Idiom::Hazard | Idiom::Crossing);
    for part in 0..parts {
        let part = (count + part) / parts;
        let free = |cell: usize| draft.is_free(cell) && draft.fit(piece, cell) > 0 && !draft.is_gap(cell);
        let cells = patch(draft.grid, part, free, sampler);
        for cell in cells {
            let cuts = || draft.grid.is_cut(cell, |next| draft.is_open(next) || next == cell);
            if !is_hard || !cuts() {
                draft.cells[cell] = piece.symbol;
            }
        }
    }
}

/// Places more copies of the pieces whose number is still below the minimum.
fn top_up(draft: &mut Draft<'_>, stock: &Stock, sampler: &mut Sampler) {
    for (piece, _) in stock {
        while draft.count(piece.symbol) < piece.counts.0 {
            // If pieces of the kind stand in rows or patches, a new piece should be next to another one.
            let grows = matches!(piece.idiom, Idiom::Ground | Idiom::Crossing | Idiom::Hazard);
            let weight = |cell: usize| {
                let own = WAYS.into_iter().filter_map(|way| draft.grid.shift(cell, way));
                let own = own.filter(|&next| draft.cells[next] == piece.symbol).count() as u32;
                let fit = if draft.is_free(cell) { draft.fit(piece, cell) } else { 0 };
                if grows { fit * (1 + 20 * own) } else { fit }
            };
            let weights: Vec<u32> = (0..draft.grid.len()).map(weight).collect();
            let Some(cell) = sampler.weighted(&weights) else { return };
            draft.cells[cell] = piece.symbol;
        }
    }
}
