//! Drawings of passages: doors, gates, portals, nests and sockets.

use super::Art;
use crate::looks::colour::{INK, PAPER};
use crate::looks::shape::{Outline, Segment};

/// Draws an arched door in a frame, with the star that marks a win.
pub(crate) fn exit(art: &mut Art) {
    let main = art.main();
    art.solid(arch(0.1, 0.03, 0.8), main.shade());
    art.solid(arch(0.2, 0.14, 0.6), main);
    art.star(0.5, 0.5, 0.27);
    art.solid(Outline::circle(0.72, 0.76, 0.05), PAPER);
}

/// Returns the outline of a door: a half circle on a rectangle that stands on the ground.
fn arch(x: f32, y: f32, width: f32) -> Outline {
    let (right, spring, foot) = (x + width, y + width * 0.55, 0.97);
    Outline(vec![
        Segment::Move([x, foot]),
        Segment::Line([x, spring]),
        Segment::Cubic([x, y - 0.02], [right, y - 0.02], [right, spring]),
        Segment::Line([right, foot]),
        Segment::Close,
    ])
}

pub(crate) fn gate(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::rounded(0.04, 0.04, 0.92, 0.92, 0.06), main.shade());
    for x in [0.12, 0.33, 0.54, 0.75] {
        art.solid(Outline::rect(x, 0.1, 0.13, 0.8), main);
    }
    art.solid(Outline::rounded(0.04, 0.18, 0.92, 0.1, 0.02), main);
    art.solid(Outline::rounded(0.26, 0.4, 0.48, 0.46, 0.08), super::GOLD);
    art.fill(art.emblem(0.5, 0.61, 0.11), INK);
}

/// Draws a spiral of three turns.
pub(crate) fn portal(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::circle(0.5, 0.5, 0.46), main.shade());
    let point = |at: u8| {
        let turn = f32::from(at) * 0.35;
        let radius = 0.03 + 0.0072 * f32::from(at);
        [0.5 + radius * libm::cosf(turn), 0.5 + radius * libm::sinf(turn)]
    };
    art.stroke(Outline::line(&(0..52).map(point).collect::<Vec<_>>()), main.light(), 0.085);
}

pub(crate) fn portal_exit(art: &mut Art) {
    let main = art.main();
    art.stroke(Outline::circle(0.5, 0.5, 0.4), INK, 0.16);
    art.stroke(Outline::circle(0.5, 0.5, 0.4), main, 0.08);
    let arrow = Outline::path("M.44,.3 L.56,.3 L.56,.48 L.68,.48 L.5,.7 L.32,.48 L.44,.48 Z");
    art.solid(arrow, main);
}

/// Draws a mound with a dark opening, and eyes in the opening.
pub(crate) fn nest(art: &mut Art) {
    let main = art.main();
    let mound = Outline::path("M.03,.95 C.06,.2,.3,.05,.5,.05 C.7,.05,.94,.2,.97,.95 Z");
    art.solid(mound, main);
    let mouth = Outline::path("M.2,.95 C.2,.2,.8,.2,.8,.95 Z");
    art.fill(mouth, INK);
    for x in [0.31, 0.49, 0.67] {
        art.fill(Outline::polygon(&[[x - 0.07, 0.47], [x + 0.09, 0.47], [x + 0.01, 0.6]]), PAPER);
    }
    art.eyes([0.5, 0.74], 0.24, 0.085, true);
}

pub(crate) fn maker(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::rounded(0.06, 0.06, 0.88, 0.88, 0.18), main);
    art.solid(Outline::circle(0.5, 0.5, 0.32), main.light());
    for bar in [[[0.5, 0.32], [0.5, 0.68]], [[0.32, 0.5], [0.68, 0.5]]] {
        art.stroke(Outline::line(&bar), INK, 0.12);
    }
}

/// Draws a hole in the ground. It is dark at the top, where the rim casts its shadow.
pub(crate) fn socket(art: &mut Art) {
    slot(art);
    art.star(0.5, 0.54, 0.28);
}

pub(crate) fn slot(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::rounded(0.07, 0.07, 0.86, 0.86, 0.1), main.shade());
    art.fill(Outline::rounded(0.14, 0.2, 0.72, 0.66, 0.06), main.mixed(INK, 15));
}
