//! Rasterisation of images.

use crate::error::RenderError;
use crate::looks::colour::{Colour, PAPER};
use crate::looks::shape::{Outline, Paint, Segment, Shape};
use crate::picture::{Key, Picture, Stamp, Tile};
use std::collections::BTreeMap;
use tiny_skia::{FillRule, IntSize, LineCap, LineJoin, Path, PathBuilder, Pixmap, Stroke, Transform};

/// The maximum number of pixels in a tile drawn in detail.
const MAX_TILE: u64 = 1 << 22;

/// An image without transparency.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// The pixels, row by row.
    pub pixels: Vec<Colour>,
}

/// A rasteriser that caches the pixels of tiles. The same [`Picture`] yields the same pixels on every
/// machine, regardless of what was drawn before.
#[derive(Debug, Default)]
pub struct Painter {
    /// The number assigned to each tile seen so far.
    numbers: BTreeMap<Key, usize>,
    /// The pixels of tiles, by the tile's number, width and height.
    tiles: BTreeMap<(usize, u32, u32), Pixmap>,
}

impl Painter {
    /// Creates a painter with an empty cache.
    pub fn new() -> Painter {
        Painter::default()
    }

    /// Rasterises an image. Sprites are aligned to whole pixels. Cost: O(pixels of the stamps), plus the cost
    /// of drawing tiles that are not in the cache.
    ///
    /// # Errors
    ///
    /// Returns an error if the image is empty.
    pub fn paint(&mut self, picture: &Picture) -> Result<Image, RenderError> {
        let (width, height) = (picture.width(), picture.height());
        if width == 0 || height == 0 {
            return Err(RenderError::Empty);
        }
        let mut numbers = Vec::with_capacity(picture.tiles().len());
        for key in picture.keys() {
            let next = self.numbers.len();
            numbers.push(*self.numbers.entry(key.clone()).or_insert(next));
        }
        let mut image = Image { width, height, pixels: vec![PAPER; width as usize * height as usize] };
        for stamp in picture.stamps() {
            let Some((x, y, w, h)) = snapped(stamp, width, height) else { continue };
            let drawn = &picture.tiles()[stamp.tile];
            // The tile has a single colour, or is so large that its details would be invisible.
            if drawn.is_plain() || u64::from(w) * u64::from(h) > MAX_TILE {
                let colour = drawn.shapes.first().map_or(PAPER, |shape| shape.colour);
                image.fill((x, y), (w, h), colour);
                continue;
            }
            let key = (numbers[stamp.tile], w, h);
            let tile = self.tiles.entry(key).or_insert_with(|| tile(drawn, w, h));
            image.blend(tile, x, y);
        }
        Ok(image)
    }
}

impl Image {
    /// Fills a rectangle, clipped to the image.
    fn fill(&mut self, (x, y): (i32, i32), (w, h): (u32, u32), colour: Colour) {
        let span = |from: i32, size: u32, limit: u32| {
            let (start, limit) = (i64::from(from), i64::from(limit));
            start.clamp(0, limit) as usize..(start + i64::from(size)).clamp(0, limit) as usize
        };
        let (columns, rows) = (span(x, w, self.width), span(y, h, self.height));
        for row in self.pixels.chunks_mut(self.width as usize).take(rows.end).skip(rows.start) {
            row[columns.clone()].fill(colour);
        }
    }

    /// Blends a tile over the image, with the tile's top left corner at `(x, y)`.
    fn blend(&mut self, tile: &Pixmap, x: i32, y: i32) {
        let (width, height) = (self.width as usize, self.height as usize);
        // Parts to the left of or above the image are skipped.
        let [skipped_columns, skipped_rows] = [x, y].map(|at| at.min(0).unsigned_abs() as usize);
        let (left, top) = (x.max(0) as usize, y.max(0) as usize);
        let sources = tile.pixels().chunks(tile.width() as usize).skip(skipped_rows);
        let targets = self.pixels.chunks_mut(width).take(height).skip(top);
        for (source, target) in sources.zip(targets) {
            let source = source.iter().skip(skipped_columns);
            for (pixel, below) in source.zip(target.iter_mut().skip(left)) {
                let through = 255 - u16::from(pixel.alpha());
                let own = [pixel.red(), pixel.green(), pixel.blue()];
                // The tile's colours are premultiplied by its alpha.
                let mix = |at: usize| {
                    own[at].saturating_add(((u16::from(below.0[at]) * through + 127) / 255) as u8)
                };
                *below = if through == 0 { Colour(own) } else { Colour(std::array::from_fn(mix)) };
            }
        }
    }
}

/// Returns the whole pixels that a stamp covers, or `None` if the stamp lies outside the image.
fn snapped(stamp: &Stamp, width: u32, height: u32) -> Option<(i32, i32, u32, u32)> {
    let place = stamp.place;
    let span = |from: f32, size: f32, limit: u32| {
        let (start, end) = (from.round() as i64, (from + size).round() as i64);
        let seen = start < i64::from(limit) && end > 0 && end > start;
        seen.then_some((i32::try_from(start).ok()?, u32::try_from(end - start).ok()?))
    };
    let ((x, w), (y, h)) = (span(place.x, place.w, width)?, span(place.y, place.h, height)?);
    Some((x, y, w, h))
}

fn tile(tile: &Tile, width: u32, height: u32) -> Pixmap {
    let size = IntSize::from_wh(width, height).expect("a seen stamp has a size");
    let mut pixmap =
        Pixmap::new(size.width(), size.height()).expect("a stamp is not much larger than its image");
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
