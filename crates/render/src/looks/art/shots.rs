//! Drawings of shots and blades that point to the right.

use super::Art;
use crate::looks::colour::{INK, PAPER};
use crate::looks::shape::Outline;

/// Draws a shot with a barbed head and a jagged tail.
pub(crate) fn hostile(art: &mut Art) {
    let main = art.main();
    let tail =
        Outline::path("M.02,.3 L.3,.4 L.5,.4 L.42,.16 L.97,.5 L.42,.84 L.5,.6 L.3,.6 L.02,.7 L.14,.5 Z");
    art.solid(tail, main);
    art.fill(Outline::polygon(&[[0.56, 0.36], [0.8, 0.5], [0.56, 0.64]]), PAPER);
}

pub(crate) fn bolt(art: &mut Art) {
    let main = art.main();
    for y in [0.34, 0.66] {
        art.stroke(Outline::line(&[[0.06, y], [0.3, y]]), main.shade(), 0.05);
    }
    let body = Outline::path("M.26,.36 L.62,.36 C.82,.36,.92,.46,.94,.5 C.92,.54,.82,.64,.62,.64 L.26,.64 Z");
    art.solid(body, main);
    art.fill(Outline::rounded(0.34, 0.42, 0.34, 0.07, 0.03), PAPER);
}

pub(crate) fn blade(art: &mut Art) {
    let main = art.main();
    let crescent = Outline::path("M.24,.04 C1.14,.1,1.14,.9,.24,.96 C.74,.76,.74,.24,.24,.04 Z");
    art.solid(crescent, main);
    for (x, y) in [(0.12, 0.34), (0.06, 0.5), (0.12, 0.66)] {
        art.stroke(Outline::line(&[[x, y], [x + 0.24, y]]), main.shade(), 0.05);
    }
}

pub(crate) fn bomb(art: &mut Art) {
    let fuse = Outline::path("M.62,.3 C.64,.1,.78,.08,.84,.18");
    art.stroke(fuse, INK, 0.06);
    art.fill(Outline::star(0.85, 0.18, 6, 0.13, 0.06), super::GOLD);
    art.solid(Outline::circle(0.46, 0.6, 0.34), art.main());
    art.fill(Outline::ellipse(0.35, 0.47, 0.08, 0.06), PAPER);
}
