//! Drawings of creatures: the player, its chasers, its prey, and bystanders.

use super::{Art, RIM};
use crate::looks::colour::{Colour, INK, PAPER};
use crate::looks::shape::Outline;

/// The colour of the ring around the avatar, which no other tile uses.
const RING: Colour = Colour([0x1f, 0xb8, 0xff]);

fn ring(art: &mut Art) {
    art.fill(Outline::circle(0.5, 0.5, 0.5), RING.shade());
    art.fill(Outline::circle(0.5, 0.5, 0.485), RING);
    art.fill(Outline::circle(0.5, 0.5, 0.4), RING.mixed(PAPER, 75));
}

/// Draws the ring around the avatar, with a pointer in the direction of the avatar's orientation.
pub(super) fn ring_of_avatar(art: &mut Art) {
    ring(art);
    if let Some(direction) = art.facing {
        let pointer = Outline::polygon(&[[0.99, 0.5], [0.84, 0.36], [0.84, 0.64]]);
        art.solid(pointer.turned(direction), RING);
    }
}

/// Draws a figure with a head, seen from the front. A pointer on the ring shows the orientation.
pub(crate) fn avatar(art: &mut Art) {
    ring_of_avatar(art);
    let body = Outline::path("M.27,.83 C.27,.62,.36,.52,.5,.52 C.64,.52,.73,.62,.73,.83 Z");
    art.solid(body, art.main());
    let skin = Colour([0xff, 0xe0, 0xbd]);
    art.solid(Outline::circle(0.5, 0.35, 0.19), skin);
    // The figure wears a cap in its own colour.
    let cap = Outline::path("M.31,.33 C.31,.08,.69,.08,.69,.33 Z");
    art.solid(cap, art.main());
    for x in [0.43, 0.57] {
        art.fill(Outline::circle(x, 0.4, 0.03), INK);
    }
    let smile = Outline::path("M.43,.46 C.46,.5,.54,.5,.57,.46");
    art.stroke(smile, INK, 0.025);
}

/// Draws a pointed hull that shows its heading, or points upwards if it has no heading.
pub(crate) fn craft(art: &mut Art) {
    ring(art);
    let first = art.shapes.len();
    art.solid(Outline::polygon(&[[0.3, 0.4], [0.08, 0.5], [0.3, 0.6]]), Colour([0xff, 0xb0, 0x2e]));
    art.solid(Outline::polygon(&[[0.93, 0.5], [0.22, 0.2], [0.34, 0.5], [0.22, 0.8]]), art.main());
    art.solid(Outline::ellipse(0.55, 0.5, 0.12, 0.08), PAPER);
    if art.facing.is_none() {
        art.turn(first, [0.0, -1.0]);
    }
}

/// Draws the sign that shows where the player died.
pub(crate) fn fallen(art: &mut Art) {
    ring(art);
    art.solid(Outline::rounded(0.43, 0.18, 0.14, 0.66, 0.03), art.main());
    art.solid(Outline::rounded(0.26, 0.32, 0.48, 0.14, 0.03), art.main());
    art.fill(Outline::rect(0.45, 0.34, 0.1, 0.1), art.main());
}

/// Draws one of four bodies, each with sharp points, angry eyes and teeth.
pub(crate) fn enemy(art: &mut Art) {
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
            let wing = Outline::path("M.5,.5 L.3,.28 L.02,.14 L.03,.66 L.15,.56 L.21,.74 L.31,.6 L.4,.76 Z");
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
            let robe = Outline::path(
                "M.14,.94 L.14,.5 C.14,.02,.86,.02,.86,.5 L.86,.94 L.74,.8 L.62,.94 L.5,.8 L.38,.94 L.26,.8 Z",
            );
            art.solid(robe, main);
            art.eyes([0.5, 0.42], 0.3, 0.11, true);
            teeth(art, 0.5, 0.63, 0.32);
        }
    }
}

/// Draws a row of pointed teeth below the line at `y`.
pub(super) fn teeth(art: &mut Art, x: f32, y: f32, width: f32) {
    let (left, step, drop) = (x - width / 2.0, width / 6.0, width * 0.34);
    let mut points = vec![[left, y], [left + width, y]];
    for at in (0..6_u8).rev() {
        let down = if at % 2 == 1 { drop } else { 0.0 };
        points.push([left + step * f32::from(at), y + down]);
    }
    art.fill(Outline::rounded(left - 0.02, y - 0.03, width + 0.04, drop + 0.06, 0.03), INK);
    art.fill(Outline::polygon(&points), PAPER);
}

/// Draws a charger seen from above, so that it can point in any direction. The charger has a snout in
/// front, eyes beside the snout, and sharp points at the sides.
pub(crate) fn charger(art: &mut Art) {
    let main = art.main();
    match art.look.variant {
        0 => art.solid(
            Outline::path(
                "M.98,.5 L.72,.22 L.56,.26 L.46,.06 L.36,.26 L.24,.1 L.18,.3 L.03,.22 L.1,.5 L.03,.78 \
                 L.18,.7 L.24,.9 L.36,.74 L.46,.94 L.56,.74 L.72,.78 Z",
            ),
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
            let body = Outline::path("M.98,.5 C.8,.18,.36,.16,.12,.5 C.36,.84,.8,.82,.98,.5 Z");
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

/// Draws a creature with wide eyes, an open mouth, and the star that marks a win.
pub(crate) fn prey(art: &mut Art) {
    let main = art.main();
    for ear in [[[0.16, 0.46], [0.14, 0.14], [0.4, 0.3]], [[0.84, 0.46], [0.86, 0.14], [0.6, 0.3]]] {
        art.solid(Outline::polygon(&ear), main);
    }
    art.solid(Outline::circle(0.5, 0.56, 0.36), main);
    art.eyes([0.5, 0.5], 0.32, 0.13, false);
    art.solid(Outline::ellipse(0.5, 0.76, 0.06, 0.07), INK);
    art.star(0.8, 0.8, 0.2);
}

/// Draws a creature with a smile and no sharp points.
pub(crate) fn friend(art: &mut Art) {
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
    let smile = Outline::path("M.32,.64 C.38,.82,.62,.82,.68,.64");
    art.stroke(smile, INK, RIM * 1.3);
}
