//! Creatures: the player, its hunters, its prey, and bystanders.

use super::{Art, RIM};
use crate::colour::{Colour, INK, PAPER};
use crate::shape::{Outline, Point, Segment};

/// The ring around the avatar: no other tile has it.
const RING: Colour = Colour([0x1f, 0xb8, 0xff]);

fn ring(art: &mut Art) {
    art.fill(Outline::circle(0.5, 0.5, 0.5), RING.shade());
    art.fill(Outline::circle(0.5, 0.5, 0.485), RING);
    art.fill(Outline::circle(0.5, 0.5, 0.4), RING.mixed(PAPER, 75));
}

/// A figure with a head, seen from the front; a pointer on the ring shows its facing.
pub(super) fn avatar(art: &mut Art, facing: Option<Point>) {
    ring(art);
    if let Some(direction) = facing {
        let pointer = Outline::polygon(&[[0.99, 0.5], [0.84, 0.36], [0.84, 0.64]]);
        art.solid(pointer.turned(direction), RING);
    }
    let body = Outline(vec![
        Segment::Move([0.27, 0.83]),
        Segment::Cubic([0.27, 0.62], [0.36, 0.52], [0.5, 0.52]),
        Segment::Cubic([0.64, 0.52], [0.73, 0.62], [0.73, 0.83]),
        Segment::Close,
    ]);
    art.solid(body, art.main());
    let skin = Colour([0xff, 0xe0, 0xbd]);
    art.solid(Outline::circle(0.5, 0.35, 0.19), skin);
    // A cap in the figure's own colour.
    let cap = Outline(vec![
        Segment::Move([0.31, 0.33]),
        Segment::Cubic([0.31, 0.08], [0.69, 0.08], [0.69, 0.33]),
        Segment::Close,
    ]);
    art.solid(cap, art.main());
    for x in [0.43, 0.57] {
        art.fill(Outline::circle(x, 0.4, 0.03), INK);
    }
    let smile =
        Outline(vec![Segment::Move([0.43, 0.46]), Segment::Cubic([0.46, 0.5], [0.54, 0.5], [0.57, 0.46])]);
    art.stroke(smile, INK, 0.025);
}

/// A pointed hull that shows its heading; upwards if it has none.
pub(super) fn craft(art: &mut Art, facing: Option<Point>) {
    ring(art);
    let first = art.shapes.len();
    art.solid(Outline::polygon(&[[0.3, 0.4], [0.08, 0.5], [0.3, 0.6]]), Colour([0xff, 0xb0, 0x2e]));
    art.solid(Outline::polygon(&[[0.93, 0.5], [0.22, 0.2], [0.34, 0.5], [0.22, 0.8]]), art.main());
    art.solid(Outline::ellipse(0.55, 0.5, 0.12, 0.08), PAPER);
    if facing.is_none() {
        for shape in &mut art.shapes[first..] {
            let outline = std::mem::take(&mut shape.outline);
            shape.outline = outline.turned([0.0, -1.0]);
        }
    }
}

/// The mark of the place where the player died.
pub(super) fn fallen(art: &mut Art) {
    ring(art);
    art.solid(Outline::rounded(0.43, 0.18, 0.14, 0.66, 0.03), art.main());
    art.solid(Outline::rounded(0.26, 0.32, 0.48, 0.14, 0.03), art.main());
    art.fill(Outline::rect(0.45, 0.34, 0.1, 0.1), art.main());
}

/// Four bodies, all with points, angry eyes and teeth.
pub(super) fn enemy(art: &mut Art) {
    let main = art.main();
    match art.look.variant {
        0 => {
            art.solid(Outline::star(0.5, 0.51, 10, 0.48, 0.34), main);
            art.eyes([0.5, 0.45], 0.27, 0.105, true);
            teeth(art, 0.5, 0.66, 0.3);
        }
        1 => {
            let legs = [[0.05, 0.25], [0.02, 0.55], [0.08, 0.86]];
            for [x, y] in legs {
                for mirror in [false, true] {
                    let leg = Outline::line(&[[0.5, 0.55], [0.2, y - 0.1], [x, y]]);
                    art.stroke(if mirror { leg.mirrored() } else { leg }, INK, 0.065);
                }
            }
            art.solid(Outline::ellipse(0.5, 0.56, 0.3, 0.36), main);
            art.eyes([0.5, 0.46], 0.27, 0.105, true);
            teeth(art, 0.5, 0.68, 0.28);
        }
        2 => {
            let wing = Outline::polygon(&[
                [0.5, 0.5],
                [0.3, 0.28],
                [0.02, 0.14],
                [0.03, 0.66],
                [0.15, 0.56],
                [0.21, 0.74],
                [0.31, 0.6],
                [0.4, 0.76],
            ]);
            art.solid(wing.clone(), main.shade());
            art.solid(wing.mirrored(), main.shade());
            for ear in [[[0.3, 0.36], [0.33, 0.1], [0.48, 0.3]], [[0.7, 0.36], [0.67, 0.1], [0.52, 0.3]]] {
                art.solid(Outline::polygon(&ear), main);
            }
            art.solid(Outline::circle(0.5, 0.52, 0.27), main);
            art.eyes([0.5, 0.46], 0.25, 0.1, true);
            teeth(art, 0.5, 0.65, 0.24);
        }
        _ => {
            for horn in [[[0.24, 0.34], [0.1, 0.04], [0.44, 0.2]], [[0.76, 0.34], [0.9, 0.04], [0.56, 0.2]]] {
                art.solid(Outline::polygon(&horn), PAPER);
            }
            let robe = Outline(vec![
                Segment::Move([0.14, 0.94]),
                Segment::Line([0.14, 0.5]),
                Segment::Cubic([0.14, 0.02], [0.86, 0.02], [0.86, 0.5]),
                Segment::Line([0.86, 0.94]),
                Segment::Line([0.74, 0.8]),
                Segment::Line([0.62, 0.94]),
                Segment::Line([0.5, 0.8]),
                Segment::Line([0.38, 0.94]),
                Segment::Line([0.26, 0.8]),
                Segment::Close,
            ]);
            art.solid(robe, main);
            art.eyes([0.5, 0.42], 0.3, 0.11, true);
            teeth(art, 0.5, 0.63, 0.32);
        }
    }
}

/// A row of pointed teeth below the line at `y`.
fn teeth(art: &mut Art, x: f32, y: f32, width: f32) {
    let (left, step, drop) = (x - width / 2.0, width / 6.0, width * 0.34);
    let mut points = vec![[left, y], [left + width, y]];
    for at in (0..6_u8).rev() {
        let down = if at % 2 == 1 { drop } else { 0.0 };
        points.push([left + step * f32::from(at), y + down]);
    }
    art.fill(Outline::rounded(left - 0.02, y - 0.03, width + 0.04, drop + 0.06, 0.03), INK);
    art.fill(Outline::polygon(&points), PAPER);
}

/// Seen from above, so that it can point anywhere: a snout ahead, eyes beside it, points at the sides.
pub(super) fn charger(art: &mut Art) {
    let main = art.main();
    match art.look.variant {
        0 => art.solid(
            Outline::polygon(&[
                [0.98, 0.5],
                [0.72, 0.22],
                [0.56, 0.26],
                [0.46, 0.06],
                [0.36, 0.26],
                [0.24, 0.1],
                [0.18, 0.3],
                [0.03, 0.22],
                [0.1, 0.5],
                [0.03, 0.78],
                [0.18, 0.7],
                [0.24, 0.9],
                [0.36, 0.74],
                [0.46, 0.94],
                [0.56, 0.74],
                [0.72, 0.78],
            ]),
            main,
        ),
        1 => {
            for side in [-1.0_f32, 1.0] {
                let y = |away: f32| 0.5 + side * away;
                for x in [0.2, 0.4, 0.58] {
                    art.stroke(Outline::line(&[[x, y(0.2)], [x - 0.08, y(0.44)]]), INK, 0.07);
                }
                art.solid(
                    Outline::polygon(&[[0.66, y(0.26)], [0.92, y(0.3)], [0.99, y(0.08)], [0.84, y(0.16)]]),
                    main.shade(),
                );
            }
            art.solid(Outline::ellipse(0.43, 0.5, 0.4, 0.31), main);
            for x in [0.18, 0.32] {
                art.stroke(Outline::line(&[[x, 0.32], [x - 0.03, 0.5], [x, 0.68]]), main.shade(), 0.05);
            }
        }
        _ => {
            art.solid(Outline::polygon(&[[0.3, 0.5], [0.02, 0.16], [0.1, 0.5], [0.02, 0.84]]), main.shade());
            art.solid(Outline::polygon(&[[0.62, 0.3], [0.36, 0.06], [0.36, 0.3]]), main.shade());
            art.solid(Outline::polygon(&[[0.62, 0.7], [0.36, 0.94], [0.36, 0.7]]), main.shade());
            let body = Outline(vec![
                Segment::Move([0.98, 0.5]),
                Segment::Cubic([0.8, 0.18], [0.36, 0.16], [0.12, 0.5]),
                Segment::Cubic([0.36, 0.84], [0.8, 0.82], [0.98, 0.5]),
                Segment::Close,
            ]);
            art.solid(body, main);
        }
    }
    for side in [-1.0_f32, 1.0] {
        let y = 0.5 + side * 0.14;
        art.solid(Outline::circle(0.62, y, 0.1), PAPER);
        art.fill(Outline::circle(0.66, y - side * 0.02, 0.05), INK);
        art.stroke(Outline::line(&[[0.53, y + side * 0.14], [0.74, y + side * 0.02]]), INK, 0.06);
    }
}

/// Wide eyes, an open mouth, and the star of winning.
pub(super) fn prey(art: &mut Art) {
    let main = art.main();
    for ear in [[[0.16, 0.46], [0.14, 0.14], [0.4, 0.3]], [[0.84, 0.46], [0.86, 0.14], [0.6, 0.3]]] {
        art.solid(Outline::polygon(&ear), main);
    }
    art.solid(Outline::circle(0.5, 0.56, 0.36), main);
    art.eyes([0.5, 0.5], 0.32, 0.13, false);
    art.solid(Outline::ellipse(0.5, 0.76, 0.06, 0.07), INK);
    art.star(0.8, 0.8, 0.2);
}

/// A smile and no points anywhere.
pub(super) fn friend(art: &mut Art) {
    let main = art.main();
    match art.look.variant {
        0 => {
            for x in [0.26, 0.74] {
                art.solid(Outline::circle(x, 0.24, 0.14), main);
            }
        }
        1 => {
            for x in [0.36, 0.64] {
                art.solid(Outline::ellipse(x, 0.22, 0.09, 0.2), main);
            }
        }
        _ => art.stroke(Outline::line(&[[0.5, 0.3], [0.5, 0.06], [0.62, 0.08]]), INK, 0.06),
    }
    art.solid(Outline::circle(0.5, 0.57, 0.37), main);
    for x in [0.37, 0.63] {
        art.fill(Outline::circle(x, 0.5, 0.055), INK);
    }
    let smile =
        Outline(vec![Segment::Move([0.32, 0.64]), Segment::Cubic([0.38, 0.82], [0.62, 0.82], [0.68, 0.64])]);
    art.stroke(smile, INK, RIM * 1.3);
}
