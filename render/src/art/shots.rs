//! Shots and blades; drawn to the right.

use super::Art;
use crate::colour::{INK, PAPER};
use crate::shape::{Outline, Segment};

/// Barbed at the head and jagged at the tail.
pub(super) fn hostile(art: &mut Art) {
    let main = art.main();
    let tail = [
        [0.02, 0.3],
        [0.3, 0.4],
        [0.5, 0.4],
        [0.42, 0.16],
        [0.97, 0.5],
        [0.42, 0.84],
        [0.5, 0.6],
        [0.3, 0.6],
        [0.02, 0.7],
        [0.14, 0.5],
    ];
    art.solid(Outline::polygon(&tail), main);
    art.fill(Outline::polygon(&[[0.56, 0.36], [0.8, 0.5], [0.56, 0.64]]), PAPER);
}

pub(super) fn bolt(art: &mut Art) {
    let main = art.main();
    for y in [0.34, 0.66] {
        art.stroke(Outline::line(&[[0.06, y], [0.3, y]]), main.shade(), 0.05);
    }
    let body = Outline(vec![
        Segment::Move([0.26, 0.36]),
        Segment::Line([0.62, 0.36]),
        Segment::Cubic([0.82, 0.36], [0.92, 0.46], [0.94, 0.5]),
        Segment::Cubic([0.92, 0.54], [0.82, 0.64], [0.62, 0.64]),
        Segment::Line([0.26, 0.64]),
        Segment::Close,
    ]);
    art.solid(body, main);
    art.fill(Outline::rounded(0.34, 0.42, 0.34, 0.07, 0.03), PAPER);
}

/// The crescent that a blade leaves.
pub(super) fn blade(art: &mut Art) {
    let main = art.main();
    let crescent = Outline(vec![
        Segment::Move([0.24, 0.04]),
        Segment::Cubic([1.14, 0.1], [1.14, 0.9], [0.24, 0.96]),
        Segment::Cubic([0.74, 0.76], [0.74, 0.24], [0.24, 0.04]),
        Segment::Close,
    ]);
    art.solid(crescent, main);
    for (x, y) in [(0.12, 0.34), (0.06, 0.5), (0.12, 0.66)] {
        art.stroke(Outline::line(&[[x, y], [x + 0.24, y]]), main.shade(), 0.05);
    }
}

pub(super) fn bomb(art: &mut Art) {
    let fuse =
        Outline(vec![Segment::Move([0.62, 0.3]), Segment::Cubic([0.64, 0.1], [0.78, 0.08], [0.84, 0.18])]);
    art.stroke(fuse, INK, 0.06);
    art.fill(Outline::star(0.85, 0.18, 6, 0.13, 0.06), super::GOLD);
    art.solid(Outline::circle(0.46, 0.6, 0.34), art.main());
    art.fill(Outline::ellipse(0.35, 0.47, 0.08, 0.06), PAPER);
}
