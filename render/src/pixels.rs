//! Pictures as pixels.

use crate::colour::{Colour, PAPER};
use crate::error::RenderError;
use crate::picture::{Key, Picture, Stamp, Tile};
use crate::shape::{Outline, Paint, Segment, Shape};
use std::collections::BTreeMap;
use tiny_skia::{
    FillRule, IntSize, LineCap, LineJoin, Path, PathBuilder, Pixmap, PixmapPaint, Stroke, Transform,
};

/// An image without transparency.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Row-major.
    pub pixels: Vec<Colour>,
}

/// Draws pictures, and keeps the pixels of tiles for the next ones. The same picture gives the same pixels, on every
/// machine and whatever was drawn before.
#[derive(Debug, Default)]
pub struct Painter {
    /// The tiles met so far, numbered.
    numbers: BTreeMap<Key, usize>,
    /// By number of the tile, width and height.
    tiles: BTreeMap<(usize, u32, u32), Pixmap>,
}

impl Painter {
    /// A painter who has drawn nothing yet.
    pub fn new() -> Painter {
        Painter::default()
    }

    /// Draws a picture. Sprites are moved to whole pixels. Cost: O(pixels of the stamps), and more for tiles that are
    /// drawn for the first time.
    ///
    /// # Errors
    /// If the picture is empty or too large for the memory.
    pub fn paint(&mut self, picture: &Picture) -> Result<Image, RenderError> {
        let (width, height) = (picture.width(), picture.height());
        let too_large = || RenderError::TooLarge { pixels: u64::from(width) * u64::from(height) };
        let mut canvas = Pixmap::new(width, height).ok_or_else(too_large)?;
        let [red, green, blue] = PAPER.0;
        canvas.fill(tiny_skia::Color::from_rgba8(red, green, blue, 255));
        let mut numbers = Vec::with_capacity(picture.tiles().len());
        for key in picture.keys() {
            let next = self.numbers.len();
            numbers.push(*self.numbers.entry(key.clone()).or_insert(next));
        }
        for stamp in picture.stamps() {
            let Some((x, y, w, h)) = snapped(stamp, width, height) else { continue };
            let key = (numbers[stamp.tile], w, h);
            let tile = self.tiles.entry(key).or_insert_with(|| tile(&picture.tiles()[stamp.tile], w, h));
            let paint = PixmapPaint::default();
            canvas.draw_pixmap(x, y, tile.as_ref(), &paint, Transform::identity(), None);
        }
        let pixels = canvas.pixels().iter().map(|pixel| Colour([pixel.red(), pixel.green(), pixel.blue()]));
        Ok(Image { width, height, pixels: pixels.collect() })
    }
}

/// The whole pixels that a stamp covers; None if it covers none of the picture.
fn snapped(stamp: &Stamp, width: u32, height: u32) -> Option<(i32, i32, u32, u32)> {
    let place = stamp.place;
    let span = |from: f32, size: f32, limit: u32| {
        let (start, end) = (from.round() as i64, (from + size).round() as i64);
        let seen = start < i64::from(limit) && end > 0 && end > start;
        // Larger than the picture: what is off it would only cost memory.
        let end = end.min(start.max(0) + 4 * i64::from(limit));
        seen.then_some((i32::try_from(start).ok()?, u32::try_from(end - start).ok()?))
    };
    let ((x, w), (y, h)) = (span(place.x, place.w, width)?, span(place.y, place.h, height)?);
    Some((x, y, w, h))
}

fn tile(tile: &Tile, width: u32, height: u32) -> Pixmap {
    let size = IntSize::from_wh(width, height).expect("a seen stamp has a size");
    let mut pixmap =
        Pixmap::new(size.width(), size.height()).expect("a stamp is not much larger than its picture");
    let scale = Transform::from_scale(width as f32, height as f32);
    for Shape { outline, paint, colour } in &tile.shapes {
        let Some(path) = path(outline) else { continue };
        let [red, green, blue] = colour.0;
        let mut ink = tiny_skia::Paint::default();
        ink.set_color_rgba8(red, green, blue, 255);
        match *paint {
            Paint::Fill => pixmap.fill_path(&path, &ink, FillRule::Winding, scale, None),
            Paint::Stroke(width) => {
                let stroke = Stroke {
                    width,
                    line_cap: LineCap::Round,
                    line_join: LineJoin::Round,
                    ..Stroke::default()
                };
                pixmap.stroke_path(&path, &ink, &stroke, scale, None);
            }
        }
    }
    pixmap
}

fn path(outline: &Outline) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for segment in &outline.0 {
        match *segment {
            Segment::Move([x, y]) => builder.move_to(x, y),
            Segment::Line([x, y]) => builder.line_to(x, y),
            Segment::Cubic([ax, ay], [bx, by], [x, y]) => builder.cubic_to(ax, ay, bx, by, x, y),
            Segment::Close => builder.close(),
        }
    }
    builder.finish()
}
