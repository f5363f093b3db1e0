//! Drawings of tiles that fill their cells: walls, soil, water and spikes.

use super::Art;
use crate::looks::colour::{Colour, GROUND, INK, PAPER};
use crate::looks::shape::{Outline, Segment};

pub(crate) fn bricks(art: &mut Art) {
    let (main, joint) = (art.main(), art.main().shade());
    art.fill(Outline::rect(0.0, 0.0, 1.0, 1.0), joint);
    let courses: [&[(f32, f32)]; 3] = [
        &[(0.0, 0.47), (0.53, 0.47)],
        &[(0.0, 0.21), (0.27, 0.46), (0.79, 0.21)],
        &[(0.0, 0.47), (0.53, 0.47)],
    ];
    for (course, row) in courses.into_iter().zip(0_u8..) {
        let y = 0.03 + f32::from(row) * 0.333;
        for &(x, w) in course {
            art.fill(Outline::rect(x, y, w, 0.273), main);
            art.fill(Outline::rect(x, y, w, 0.07), main.mixed(PAPER, 25));
        }
    }
}

pub(crate) fn breakable(art: &mut Art) {
    bricks(art);
    let crack = [[0.3, 0.0], [0.44, 0.2], [0.34, 0.4], [0.58, 0.56], [0.46, 0.78], [0.62, 1.0]];
    art.stroke(Outline::line(&crack), INK, 0.07);
    art.stroke(Outline::line(&[[0.34, 0.4], [0.12, 0.5]]), INK, 0.06);
    art.stroke(Outline::line(&[[0.58, 0.56], [0.86, 0.46]]), INK, 0.06);
}

pub(crate) fn soil(art: &mut Art) {
    let (main, speck) = (art.main(), art.main().shade());
    art.fill(Outline::rect(0.0, 0.0, 1.0, 1.0), main);
    let specks = [
        (0.18, 0.22),
        (0.55, 0.14),
        (0.84, 0.34),
        (0.36, 0.48),
        (0.68, 0.62),
        (0.14, 0.74),
        (0.46, 0.86),
        (0.9, 0.86),
    ];
    for (x, y) in specks {
        art.fill(Outline::ellipse(x, y, 0.055, 0.04), speck);
    }
}

pub(crate) fn mire(art: &mut Art) {
    let main = art.main();
    art.fill(Outline::rect(0.0, 0.0, 1.0, 1.0), main.mixed(PAPER, 20));
    for y in [0.22, 0.52, 0.82] {
        let wave = Outline(vec![
            Segment::Move([0.06, y]),
            Segment::Cubic([0.2, y - 0.16], [0.34, y - 0.16], [0.5, y]),
            Segment::Cubic([0.66, y + 0.16], [0.8, y + 0.16], [0.94, y]),
        ]);
        art.stroke(wave, main.shade(), 0.06);
    }
}

pub(crate) fn hazard(art: &mut Art) {
    let main = art.main();
    for (x, base, height) in [(0.26, 0.58, 0.5), (0.74, 0.58, 0.5)] {
        spike(art, x, base, height, main.shade());
    }
    for x in [0.18, 0.5, 0.82] {
        spike(art, x, 0.9, 0.58, main);
    }
    art.solid(Outline::rounded(0.03, 0.86, 0.94, 0.11, 0.03), main.shade());
}

fn spike(art: &mut Art, x: f32, base: f32, height: f32, colour: Colour) {
    art.solid(Outline::polygon(&[[x - 0.15, base], [x, base - height], [x + 0.15, base]]), colour);
    art.fill(
        Outline::polygon(&[[x - 0.06, base - 0.06], [x, base - height + 0.12], [x - 0.01, base - 0.06]]),
        PAPER,
    );
}

/// Draws a cover made of three rows of bags.
pub(crate) fn cover(art: &mut Art) {
    let (main, light) = (art.main().mixed(INK, 12), art.main().mixed(PAPER, 35));
    let courses: [&[(f32, f32)]; 3] = [
        &[(0.03, 0.45), (0.52, 0.45)],
        &[(0.03, 0.2), (0.27, 0.46), (0.77, 0.2)],
        &[(0.03, 0.45), (0.52, 0.45)],
    ];
    for (course, row) in courses.into_iter().zip(0_u8..) {
        let y = 0.03 + f32::from(row) * 0.32;
        for &(x, w) in course {
            art.solid(Outline::rounded(x, y, w, 0.3, 0.1), main);
            art.fill(Outline::rounded(x + 0.05, y + 0.06, w - 0.1, 0.07, 0.03), light);
        }
    }
}

pub(crate) fn refuge(art: &mut Art) {
    let main = art.main();
    for (x, y, r) in [(0.27, 0.36, 0.2), (0.7, 0.33, 0.22), (0.25, 0.68, 0.22), (0.73, 0.7, 0.21)] {
        art.solid(Outline::circle(x, y, r), main);
    }
    art.fill(Outline::circle(0.5, 0.52, 0.3), main);
    for (x, y) in [(0.32, 0.36), (0.64, 0.3), (0.5, 0.56), (0.28, 0.7), (0.72, 0.68)] {
        art.fill(Outline::circle(x, y, 0.05), main.light());
    }
}

pub(crate) fn conveyor(art: &mut Art) {
    // The dark band between bright rails stands out from any floor, whatever its colour.
    let main = art.main();
    art.fill(Outline::rect(0.0, 0.0, 1.0, 1.0), main.mixed(INK, 65));
    art.fill(Outline::rect(0.0, 0.0, 1.0, 0.12), main.light());
    art.fill(Outline::rect(0.0, 0.88, 1.0, 0.12), main.light());
    for x in [0.14, 0.44, 0.74] {
        art.stroke(Outline::line(&[[x - 0.06, 0.25], [x + 0.16, 0.5], [x - 0.06, 0.75]]), PAPER, 0.09);
    }
}

pub(crate) fn floor(art: &mut Art) {
    let pale = art.main().mixed(GROUND, 70);
    art.fill(Outline::rect(0.0, 0.0, 1.0, 1.0), pale.mixed(INK, 10));
    art.fill(Outline::rect(0.02, 0.02, 0.96, 0.96), pale);
}

pub(crate) fn spring(art: &mut Art) {
    let pale = art.main().mixed(GROUND, 40);
    art.fill(Outline::rect(0.0, 0.0, 1.0, 1.0), pale.mixed(INK, 20));
    art.fill(Outline::rect(0.02, 0.02, 0.96, 0.96), pale);
    for bar in [[[0.5, 0.36], [0.5, 0.64]], [[0.36, 0.5], [0.64, 0.5]]] {
        art.stroke(Outline::line(&bar), pale.mixed(INK, 40), 0.1);
    }
}
