//! Images made of tiles that are stamped into rectangles. Both back-ends draw the stamps in the same order.

use crate::looks::art;
use crate::looks::colour::Colour;
use crate::looks::letters;
use crate::looks::look::{Look, Looks};
use crate::looks::shape::{Outline, Paint, Point, Shape};
use engine::SpriteType;
use std::collections::BTreeMap;

/// The width of a character including its gap, as a fraction of the text height.
pub(crate) const ADVANCE: f32 = 0.56;

/// A rectangle in an image. Its coordinates are in pixels, but need not be whole numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The left edge.
    pub x: f32,
    /// The top edge.
    pub y: f32,
    /// The width.
    pub w: f32,
    /// The height.
    pub h: f32,
}

/// The inputs of a tile. Equal keys identify the same tile.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Key {
    Plain(Colour),
    Letter(char, Colour),
    /// The name and look of a sprite type, and the direction of its front in thousandths.
    Sprite(String, Look, Option<[i16; 2]>),
}

/// A reusable drawing: shapes in a unit square.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// The shapes, in drawing order.
    pub shapes: Vec<Shape>,
    /// The name of the sprite type that the tile shows, if any.
    pub name: Option<String>,
}

impl Tile {
    /// Returns `true` if the tile has a single colour and fills the square.
    pub(crate) fn is_plain(&self) -> bool {
        self.name.is_none() && matches!(&self.shapes[..], [only] if only.outline == whole())
    }
}

/// Returns the outline of the unit square.
fn whole() -> Outline {
    Outline::rect(0.0, 0.0, 1.0, 1.0)
}

/// A tile stamped into a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamp {
    /// The index of the tile in [`Picture::tiles`].
    pub tile: usize,
    /// The rectangle.
    pub place: Place,
}

/// An image made of tiles that are stamped over each other.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    width: u32,
    height: u32,
    keys: BTreeMap<Key, usize>,
    tiles: Vec<Tile>,
    stamps: Vec<Stamp>,
}

impl Picture {
    /// Creates an empty image of the given size in pixels.
    pub(crate) fn new(width: u32, height: u32) -> Picture {
        Picture { width, height, ..Picture::default() }
    }

    /// Returns the image's width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the image's height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the distinct tiles, in the order of their first use.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// Returns the key of each tile. Equal keys identify equal tiles, even across images.
    pub(crate) fn keys(&self) -> Vec<&Key> {
        let mut keys: Vec<(usize, &Key)> = self.keys.iter().map(|(key, &at)| (at, key)).collect();
        keys.sort_unstable_by_key(|&(at, _)| at);
        keys.into_iter().map(|(_, key)| key).collect()
    }

    /// Returns the stamps, in drawing order.
    pub fn stamps(&self) -> &[Stamp] {
        &self.stamps
    }

    pub(crate) fn rect(&mut self, place: Place, colour: Colour) {
        let tile = self.tile(Key::Plain(colour), || Tile {
            shapes: vec![Shape { outline: whole(), paint: Paint::Fill, colour }],
            name: None,
        });
        self.stamps.push(Stamp { tile, place });
    }

    /// Adds a sprite's tile. `facing` is a unit vector in the direction that the sprite faces.
    pub(crate) fn sprite(&mut self, place: Place, name: &str, look: Look, facing: Option<Point>) {
        let front = facing.map(|direction| direction.map(|part| (part * 1000.0).round() as i16));
        let facing = front.map(|front| front.map(|part| f32::from(part) / 1000.0));
        let tile = self.tile(Key::Sprite(name.to_owned(), look, front), || Tile {
            shapes: art::tile(look, facing),
            name: Some(name.to_owned()),
        });
        self.stamps.push(Stamp { tile, place });
    }

    /// Adds a line of text with its top left corner at `(x, y)` and a text height of `size` pixels.
    /// [`text_width`] returns the width of the line.
    pub(crate) fn text(&mut self, (x, y): (f32, f32), size: f32, colour: Colour, text: &str) {
        let mut x = x;
        for letter in text.chars() {
            if letter != ' ' {
                let shapes = || letters::shapes(letter, colour);
                let tile = self.tile(Key::Letter(letter, colour), || Tile { shapes: shapes(), name: None });
                self.stamps.push(Stamp { tile, place: Place { x, y, w: size, h: size } });
            }
            x += size * ADVANCE;
        }
    }

    /// Adds a scaled copy of another image, with its top left corner at `(x, y)`. Stamps that lie entirely
    /// outside are omitted.
    pub(crate) fn inset(&mut self, other: &Picture, (x, y): (f32, f32), scale: f32) {
        let mut here = vec![0; other.tiles.len()];
        for (key, &at) in &other.keys {
            here[at] = self.tile(key.clone(), || other.tiles[at].clone());
        }
        let (width, height) = (other.width as f32, other.height as f32);
        for Stamp { tile, place } in &other.stamps {
            let Place { x: left, y: top, w, h } = *place;
            if left < width && top < height && left + w > 0.0 && top + h > 0.0 {
                let place = Place { x: x + left * scale, y: y + top * scale, w: w * scale, h: h * scale };
                self.stamps.push(Stamp { tile: here[*tile], place });
            }
        }
    }

    fn tile(&mut self, key: Key, draw: impl FnOnce() -> Tile) -> usize {
        *self.keys.entry(key).or_insert_with(|| {
            self.tiles.push(draw());
            self.tiles.len() - 1
        })
    }
}

/// Returns a sprite type's tile for legends and palettes. Only signs have a direction there.
pub fn sprite_tile(looks: &Looks, stype: SpriteType) -> Tile {
    Tile {
        shapes: art::tile(looks.look(stype), looks.front(stype)),
        name: Some(looks.game().name(stype).to_owned()),
    }
}

/// Returns the width of a text line in pixels.
pub(crate) fn text_width(text: &str, size: f32) -> f32 {
    text.chars().count() as f32 * size * ADVANCE
}

/// Shortens a text to at most `letters` characters. A shortened text ends with two dots.
pub(crate) fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    let kept: String = text.chars().take(letters.saturating_sub(2)).collect();
    format!("{kept}..")
}
