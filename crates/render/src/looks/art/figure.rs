//! Draws the figures (drawings of nouns) and marks (signs for states) from the table in [`crate::looks::figure`].

use super::Art;
use super::creatures::{ring_of_avatar, teeth};
use crate::looks::colour::{Colour, INK, PAPER, VERMILION};
use crate::looks::figure;
use crate::looks::figure::{Figure, Mood, Part, Tint};
use crate::looks::glyph::Glyph;
use crate::looks::shape::Outline;

/// The size of a figure within the avatar's ring.
const IN_RING: f32 = 0.72;

/// Adds a figure, and the signs that show what the figure means in the rules.
pub(crate) fn draw(art: &mut Art, figure: &Figure) {
    if art.look.glyph == Glyph::Avatar {
        ring_of_avatar(art);
        let first = art.shapes.len();
        figure.parts.iter().for_each(|part| add(art, part));
        art.shrink(first, IN_RING);
        return;
    }
    figure.parts.iter().for_each(|part| add(art, part));
    if let (true, Some(direction)) = (figure.turns, art.facing) {
        art.turn(0, direction);
    }
    signs(art, figure);
}

/// Adds the mark (the sign for a state) with the given index in the table of figures.
pub(crate) fn mark(art: &mut Art, at: u16) {
    figure::mark(at).iter().for_each(|part| add(art, part));
}

fn signs(art: &mut Art, figure: &Figure) {
    use Glyph as G;
    let glyph = art.look.glyph;
    if art.look.mood == Mood::Asleep && art.look.form.has_face() {
        let snore = [[0.05, 0.07], [0.25, 0.07], [0.05, 0.27], [0.25, 0.27]];
        art.stroke(Outline::line(&snore), PAPER, 0.13);
        art.stroke(Outline::line(&snore), INK, 0.055);
    }
    if matches!(glyph, G::Hazard | G::Peril | G::HostileShot | G::Enemy | G::Charger)
        && !figure.is_dangerous
        && !art.look.form.has_face()
    {
        let sign = Outline::polygon(&[[0.14, 0.02], [0.28, 0.28], [0.0, 0.28]]);
        art.solid(sign, VERMILION);
        art.stroke(Outline::line(&[[0.14, 0.11], [0.14, 0.18]]), PAPER, 0.05);
    }
    match glyph {
        G::Exit | G::Treasure | G::Prey | G::Target | G::Socket | G::Peril => art.star(0.83, 0.17, 0.17),
        G::Charger => {
            if let Some(direction) = art.facing {
                let pointer = Outline::polygon(&[[1.0, 0.5], [0.86, 0.37], [0.86, 0.63]]);
                art.solid(pointer.turned(direction), VERMILION);
            }
        }
        _ => {}
    }
}

fn add(art: &mut Art, part: &Part) {
    match part {
        Part::Outline(outline, tint, paint) => {
            let colour = colour(art, *tint);
            match paint {
                None => art.solid(outline.clone(), colour),
                Some(paint) => art.paint(outline.clone(), colour, *paint),
            }
        }
        &Part::Eyes([x, y], apart, radius) if art.look.mood == Mood::Asleep => {
            shut(art, [x - apart / 2.0, y], radius);
            shut(art, [x + apart / 2.0, y], radius);
        }
        &Part::Eyes(at, apart, radius) => art.eyes(at, apart, radius, art.look.mood == Mood::Angry),
        &Part::Eye(at, radius) if art.look.mood == Mood::Asleep => shut(art, at, radius),
        &Part::Eye([x, y], radius) => {
            art.solid(Outline::circle(x, y, radius), PAPER);
            art.fill(Outline::circle(x, y, radius * 0.5), INK);
            if art.look.mood == Mood::Angry {
                let brow = [[x - radius * 1.5, y - radius * 1.6], [x + radius * 1.5, y - radius * 0.9]];
                art.stroke(Outline::line(&brow), INK, radius * 0.7);
            }
        }
        &Part::Mouth([x, y], width) if art.look.mood == Mood::Angry => teeth(art, x, y, width),
        &Part::Mouth([x, y], width) => {
            let half = width / 2.0;
            let drop = if art.look.mood == Mood::Asleep { 0.0 } else { width * 0.35 };
            let smile =
                [[x - half, y], [x - half * 0.5, y + drop], [x + half * 0.5, y + drop], [x + half, y]];
            art.stroke(Outline::line(&smile), INK, 0.04);
        }
    }
}

/// Draws a closed eye.
fn shut(art: &mut Art, [x, y]: [f32; 2], radius: f32) {
    let below = y + radius * 0.5;
    let lid = [[x - radius, y], [x - radius * 0.5, below], [x + radius * 0.5, below], [x + radius, y]];
    art.solid(Outline::circle(x, y, radius), art.main().light());
    art.stroke(Outline::line(&lid), INK, 0.045);
}

fn colour(art: &Art, tint: Tint) -> Colour {
    match tint {
        Tint::Main => art.main(),
        Tint::Shade => art.main().shade(),
        Tint::Light => art.main().light(),
        Tint::Fixed(colour) => colour,
    }
}
