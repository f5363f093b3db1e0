//! Drawings of items to be taken, pushed, pressed or kept safe.

use super::Art;
use crate::looks::colour::{Colour, INK, PAPER};
use crate::looks::shape::Outline;

/// Draws a star in the item's own colour. The star is flat, has a round middle, or has many points.
pub(crate) fn treasure(art: &mut Art) {
    let main = art.main();
    let (points, inner) = match art.look.variant {
        0 => (5, 0.21),
        1 => (6, 0.27),
        _ => (8, 0.3),
    };
    art.fill(Outline::star(0.5, 0.52, points, 0.5, inner + 0.06), super::GOLD);
    art.solid(Outline::star(0.5, 0.52, points, 0.43, inner), main);
    art.fill(Outline::circle(0.44, 0.45, 0.05), PAPER);
}

pub(crate) fn target(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::circle(0.5, 0.5, 0.45), main);
    art.fill(Outline::circle(0.5, 0.5, 0.34), PAPER);
    art.fill(Outline::circle(0.5, 0.5, 0.29), main);
    art.star(0.5, 0.5, 0.24);
}

/// Draws a target among spikes.
pub(crate) fn peril(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::star(0.5, 0.5, 12, 0.49, 0.36), main);
    art.fill(Outline::circle(0.5, 0.5, 0.31), PAPER);
    art.fill(Outline::circle(0.5, 0.5, 0.27), main);
    art.star(0.5, 0.51, 0.24);
}

pub(crate) fn raft(art: &mut Art) {
    let main = art.main();
    for y in [0.12, 0.38, 0.64] {
        art.solid(Outline::rounded(0.03, y, 0.94, 0.24, 0.1), main);
        art.stroke(Outline::line(&[[0.2, y + 0.12], [0.62, y + 0.12]]), main.shade(), 0.03);
    }
}

pub(crate) fn ward(art: &mut Art) {
    let main = art.main();
    let shield = Outline::path(
        "M.5,.04 C.62,.14,.78,.16,.9,.15 C.92,.56,.8,.8,.5,.96 C.2,.8,.08,.56,.1,.15 \
         C.22,.16,.38,.14,.5,.04 Z",
    );
    art.solid(shield, main);
    let heart = Outline::path(
        "M.5,.72 C.16,.5,.24,.24,.4,.28 C.46,.3,.5,.36,.5,.4 C.5,.36,.54,.3,.6,.28 C.76,.24,.84,.5,.5,.72 Z",
    );
    art.solid(heart, PAPER);
}

pub(crate) fn boulder(art: &mut Art) {
    let main = art.main();
    let rock = Outline::path("M.3,.08 L.66,.05 L.92,.3 L.96,.66 L.74,.93 L.34,.96 L.06,.74 L.06,.36 Z");
    art.solid(rock, main);
    art.fill(
        Outline::polygon(&[[0.32, 0.14], [0.62, 0.11], [0.7, 0.26], [0.42, 0.38], [0.16, 0.38]]),
        main.light(),
    );
    art.stroke(Outline::line(&[[0.88, 0.36], [0.7, 0.48], [0.74, 0.7], [0.6, 0.86]]), main.shade(), 0.05);
}

/// Draws a crate with planks from corner to corner.
pub(crate) fn crossed_crate(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::rounded(0.07, 0.07, 0.86, 0.86, 0.05), main);
    art.fill(Outline::rect(0.19, 0.19, 0.62, 0.62), main.shade());
    match art.look.variant {
        0 => {
            for bar in [[[0.24, 0.24], [0.76, 0.76]], [[0.76, 0.24], [0.24, 0.76]]] {
                art.stroke(Outline::line(&bar), main, 0.13);
            }
        }
        1 => {
            for x in [0.29, 0.5, 0.71] {
                art.stroke(Outline::line(&[[x, 0.22], [x, 0.78]]), main, 0.1);
            }
        }
        _ => art.fill(Outline::circle(0.5, 0.5, 0.22), main),
    }
    art.stroke(Outline::rect(0.19, 0.19, 0.62, 0.62), INK, 0.03);
}

pub(crate) fn key(art: &mut Art) {
    let main = art.main();
    let shaft = Outline::path(
        "M.48,.44 L.97,.44 L.97,.72 L.86,.72 L.86,.56 L.78,.56 L.78,.67 L.68,.67 L.68,.56 L.48,.56 Z",
    );
    art.solid(shaft, main);
    art.solid(art.emblem(0.29, 0.5, 0.25), main);
    art.solid(art.emblem(0.29, 0.5, 0.1), PAPER);
}

pub(crate) fn switch(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::rounded(0.08, 0.62, 0.84, 0.3, 0.08), Colour([0x8a, 0x90, 0x9c]));
    let button = Outline::path("M.24,.62 C.26,.2,.74,.2,.76,.62 Z");
    art.solid(button, main);
    art.fill(Outline::ellipse(0.42, 0.42, 0.06, 0.05), PAPER);
}

pub(crate) fn token(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::circle(0.5, 0.5, 0.36), main);
    art.stroke(Outline::circle(0.5, 0.5, 0.26), main.shade(), 0.05);
    match art.look.variant {
        0 => art.fill(Outline::rounded(0.45, 0.34, 0.1, 0.32, 0.04), main.shade()),
        1 => art.fill(Outline::rect(0.39, 0.39, 0.22, 0.22), main.shade()),
        _ => art.fill(Outline::star(0.5, 0.52, 3, 0.18, 0.09), main.shade()),
    }
    art.fill(Outline::ellipse(0.36, 0.32, 0.06, 0.04), PAPER);
}

/// Draws a cut stone with one of four outlines.
pub(crate) fn gem(art: &mut Art) {
    let main = art.main();
    let (cut, facet) = match art.look.variant {
        0 => ("M.28,.16 L.72,.16 L.93,.4 L.5,.92 L.07,.4 Z", "M.28,.16 L.37,.4 L.5,.92 L.63,.4 L.72,.16"),
        1 => (
            "M.34,.1 L.66,.1 L.86,.3 L.86,.7 L.66,.9 L.34,.9 L.14,.7 L.14,.3 Z",
            "M.34,.1 L.34,.3 L.34,.7 L.66,.7 L.66,.3 L.34,.3",
        ),
        2 => ("M.5,.06 L.82,.5 L.5,.94 L.18,.5 Z", "M.18,.5 L.5,.42 L.82,.5 L.5,.58 L.18,.5"),
        _ => ("M.5,.1 L.93,.86 L.07,.86 Z", "M.5,.1 L.5,.58 L.93,.86 L.5,.58 L.07,.86"),
    };
    art.fill(Outline::path(cut), main);
    art.stroke(Outline::path(facet), main.shade(), 0.035);
    art.stroke(Outline::path(cut), INK, 0.05);
    art.fill(Outline::star(0.34, 0.32, 4, 0.11, 0.04), PAPER);
}

/// Draws a crate with an arrow.
pub(crate) fn pointer(art: &mut Art) {
    let main = art.main();
    art.solid(Outline::rounded(0.07, 0.07, 0.86, 0.86, 0.05), main);
    let arrow = [[0.2, 0.4], [0.5, 0.4], [0.5, 0.24], [0.82, 0.5], [0.5, 0.76], [0.5, 0.6], [0.2, 0.6]];
    art.fill(Outline::polygon(&arrow), PAPER);
    art.stroke(Outline::polygon(&arrow), INK, 0.03);
}

pub(crate) fn sign(art: &mut Art) {
    let main = art.main();
    let arrow = [[0.08, 0.38], [0.5, 0.38], [0.5, 0.16], [0.92, 0.5], [0.5, 0.84], [0.5, 0.62], [0.08, 0.62]];
    art.solid(Outline::polygon(&arrow), main);
}

pub(crate) fn neutral(art: &mut Art) {
    let main = art.main();
    let pebble =
        Outline::path("M.18,.62 C.2,.3,.6,.22,.74,.36 C.94,.54,.86,.8,.5,.8 C.28,.8,.18,.76,.18,.62 Z");
    art.solid(pebble, main);
    art.fill(Outline::ellipse(0.42, 0.46, 0.1, 0.05), main.light());
}
