//! A picture: tiles, and the places where they are stamped. Both back-ends draw it, in the same order.

use crate::looks::art;
use crate::looks::colour::Colour;
use crate::looks::letters;
use crate::looks::look::{Look, Looks};
use crate::looks::shape::{Outline, Paint, Point, Shape};
use engine::SpriteType;
use std::collections::BTreeMap;

/// The width of a letter with its gap, in letter heights.
pub(crate) const ADVANCE: f32 = 0.56;

/// A rectangle in pixels of the picture, not necessarily whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Left edge.
    pub x: f32,
    /// Top edge.
    pub y: f32,
    /// Width.
    pub w: f32,
    /// Height.
    pub h: f32,
}

/// The inputs of a tile: equal keys are one tile.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Key {
    Plain(Colour),
    Letter(char, Colour),
    /// The name and look of a sprite type, and its front in thousandths.
    Sprite(String, Look, Option<[i16; 2]>),
}

/// Shapes in a unit square.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// In drawing order.
    pub shapes: Vec<Shape>,
    /// The sprite type that it shows, if it shows one.
    pub name: Option<String>,
}

impl Tile {
    /// Returns `true` if it has a single colour and fills the square.
    pub(crate) fn is_plain(&self) -> bool {
        self.name.is_none() && matches!(&self.shapes[..], [only] if only.outline == whole())
    }
}

/// The edge of the unit square.
fn whole() -> Outline {
    Outline::rect(0.0, 0.0, 1.0, 1.0)
}

/// A tile at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamp {
    /// Index into [`Picture::tiles`].
    pub tile: usize,
    /// Its place.
    pub place: Place,
}

/// Tiles stamped one over the other.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    width: u32,
    height: u32,
    keys: BTreeMap<Key, usize>,
    tiles: Vec<Tile>,
    stamps: Vec<Stamp>,
}

impl Picture {
    /// An empty picture of this size in pixels.
    pub(crate) fn new(width: u32, height: u32) -> Picture {
        Picture { width, height, ..Picture::default() }
    }

    /// Returns the width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the tiles, each once, in the order of their first use.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// Returns the key of each tile. Equal keys are equal tiles, in other pictures too.
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

    /// Adds a sprite's tile; `facing` is the direction of its front, of unit length.
    pub(crate) fn sprite(&mut self, place: Place, name: &str, look: Look, facing: Option<Point>) {
        let front = facing.map(|direction| direction.map(|part| (part * 1000.0).round() as i16));
        let facing = front.map(|front| front.map(|part| f32::from(part) / 1000.0));
        let tile = self.tile(Key::Sprite(name.to_owned(), look, front), || Tile {
            shapes: art::tile(look, facing),
            name: Some(name.to_owned()),
        });
        self.stamps.push(Stamp { tile, place });
    }

    /// Adds a line of text with its top left corner at `(x, y)` and letters `size` pixels high; [`text_width`]
    /// returns its width.
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

    /// Adds another picture, scaled, with its top left corner at `(x, y)`. Stamps wholly outside of it are left out.
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

/// Returns the tile of a sprite type, facing nowhere unless it is a sign: for legends and palettes.
pub fn sprite_tile(looks: &Looks, stype: SpriteType) -> Tile {
    Tile {
        shapes: art::tile(looks.look(stype), looks.front(stype)),
        name: Some(looks.game().name(stype).to_owned()),
    }
}

/// Returns the width of a line of text, in pixels.
pub(crate) fn text_width(text: &str, size: f32) -> f32 {
    text.chars().count() as f32 * size * ADVANCE
}

/// Cuts a text to at most `letters` letters, the last two of them dots if it is cut.
pub(crate) fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    let kept: String = text.chars().take(letters.saturating_sub(2)).collect();
    format!("{kept}..")
}
