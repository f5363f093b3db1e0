//! The drawing of every glyph: shapes in a unit square.
//!
//! - Harmful sprites have sharp points, teeth or angry eyes.
//! - Winning sprites have a star.
//! - Permanent obstacles fill their cells.
//! - The avatar stands in a bright ring.
//!
//! Colour is only a secondary cue.

pub(crate) mod creatures;
mod figure;
pub(crate) mod ground;
pub(crate) mod passages;
pub(crate) mod shots;
pub(crate) mod things;

use super::colour::{Colour, INK, PAPER};
use super::figure::Form;
use super::look::Look;
use super::shape::{Outline, Paint, Point, Shape};

const GOLD: Colour = Colour([0xff, 0xd2, 0x3f]);
/// The default width of an outline, in tiles.
const RIM: f32 = 0.045;

/// Returns the tile for a [`Look`], with its front in the direction of the unit vector `facing`. `facing` has no effect
/// on looks without a front.
pub(crate) fn tile(look: Look, facing: Option<Point>) -> Vec<Shape> {
    let mut art = Art { look, facing, shapes: Vec::new() };
    match look.form {
        Form::Figure(_) => look.form.figure().into_iter().for_each(|drawn| figure::draw(&mut art, drawn)),
        Form::Glyph(glyph) => {
            glyph.draw(&mut art);
            if let (true, Some(direction)) = (glyph.turns(), facing) {
                art.turn(0, direction);
            }
        }
    }
    if let Some(mark) = look.mark {
        figure::mark(&mut art, mark);
    }
    art.pips();
    art.shapes
}

/// A tile under construction.
pub(crate) struct Art {
    look: Look,
    /// The direction of the tile's front, as a unit vector; `None` for a tile without a direction.
    facing: Option<Point>,
    shapes: Vec<Shape>,
}

impl Art {
    fn main(&self) -> Colour {
        self.look.colour
    }

    fn fill(&mut self, outline: Outline, colour: Colour) {
        self.shapes.push(Shape { outline, paint: Paint::Fill, colour });
    }

    fn stroke(&mut self, outline: Outline, colour: Colour, width: f32) {
        self.paint(outline, colour, Paint::Stroke(width));
    }

    fn paint(&mut self, outline: Outline, colour: Colour, paint: Paint) {
        self.shapes.push(Shape { outline, paint, colour });
    }

    /// Fills an outline, and adds a dark rim that is visible on any ground.
    fn solid(&mut self, outline: Outline, colour: Colour) {
        self.fill(outline.clone(), colour);
        self.stroke(outline, INK, RIM);
    }

    /// Draws the gold star of winning sprites. The star is white if the tile itself is gold.
    fn star(&mut self, x: f32, y: f32, radius: f32) {
        let colour = if self.main().distance(GOLD) < 12_000 { PAPER } else { GOLD };
        self.solid(Outline::star(x, y, 5, radius, radius * 0.45), colour);
    }

    /// Draws white eyes with pupils, `apart` from each other. `frown` lowers the inner ends of the brows.
    fn eyes(&mut self, [x, y]: Point, apart: f32, radius: f32, frown: bool) {
        for side in [-1.0_f32, 1.0] {
            let at = x + side * apart / 2.0;
            self.solid(Outline::circle(at, y, radius), PAPER);
            self.fill(Outline::circle(at - side * radius * 0.25, y + radius * 0.2, radius * 0.5), INK);
            if frown {
                let brow = [
                    [at - side * radius * 1.1, y - radius * 0.45],
                    [at + side * radius * 1.2, y - radius * 1.45],
                ];
                self.stroke(Outline::line(&brow), INK, radius * 0.7);
            }
        }
    }

    /// Returns the round, square or pointed emblem shared by a key and the gate that it opens.
    fn emblem(&self, x: f32, y: f32, radius: f32) -> Outline {
        match self.look.variant {
            0 => Outline::circle(x, y, radius),
            1 => Outline::rect(x - radius, y - radius, 2.0 * radius, 2.0 * radius),
            2 => Outline::star(x, y, 3, radius * 1.4, radius * 0.7),
            _ => Outline::star(x, y, 2, radius * 1.4, radius * 1.1),
        }
    }

    /// Rotates the shapes from index `first` onwards.
    fn turn(&mut self, first: usize, direction: Point) {
        for shape in &mut self.shapes[first..] {
            let outline = std::mem::take(&mut shape.outline);
            shape.outline = outline.turned(direction);
        }
    }

    /// Shrinks the shapes from index `first` onwards towards the middle.
    fn shrink(&mut self, first: usize, factor: f32) {
        for shape in &mut self.shapes[first..] {
            let outline = std::mem::take(&mut shape.outline);
            shape.outline = outline.mapped(|[x, y]| [0.5 + (x - 0.5) * factor, 0.5 + (y - 0.5) * factor]);
        }
    }

    /// Draws dots at the bottom of the tile to distinguish types with the same form and colour.
    fn pips(&mut self) {
        let count = self.look.pips;
        // Grounds lie under other sprites, so they have smaller dots at the top.
        if self.look.form.is_ground() {
            for at in 0..count {
                let x = 0.14 + 0.18 * f32::from(at);
                self.fill(Outline::circle(x, 0.14, 0.07), self.main().shade());
                self.fill(Outline::circle(x, 0.14, 0.04), PAPER);
            }
            return;
        }
        for at in 0..count {
            let x = 0.5 + 0.2 * (f32::from(at) - f32::from(count - 1) / 2.0);
            self.solid(Outline::circle(x, 0.88, 0.075), PAPER);
        }
    }
}
