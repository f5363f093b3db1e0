//! An image of a game's state: the board, with an optional caption and legend.

use crate::caption;
use crate::error::RenderError;
use crate::legend;
use crate::looks::colour::{GRID, GROUND, INK, PAPER};
use crate::looks::figure::Form;
use crate::looks::glyph::Glyph;
use crate::looks::look::{Look, Looks};
use crate::looks::shape::Point;
use crate::looks::shape::unit;
use crate::picture::{Picture, Place, text_width};
use crate::style::{MAX_CELL, MAX_PIXELS, MIN_CELL, Style};
use engine::{SpriteRecord, SpriteType, State};
use std::collections::{BTreeMap, BTreeSet};

/// The minimum width of an image with a caption or a legend, in pixels.
const MIN_WIDTH: u32 = 260;

/// The scale of a sprite drawn over a different sprite in the same rectangle. Both sprites stay visible at this
/// scale.
const OVER: f32 = 0.78;
/// The scale of a sprite that shares its rectangle with an avatar.
const BESIDE: f32 = 0.46;

/// The text height of a sprite count, as a fraction of the sprite's height.
const COUNT: f32 = 0.3;

/// The minimum ratio of the longer to the shorter side at which a sprite is drawn as a plate.
const LONG: f32 = 1.3;

/// Draws a state. Cost: O(sprites log sprites + cells).
///
/// # Errors
///
/// Returns an error if the cell size is out of range, or the image would be too large.
pub fn picture(looks: &Looks, state: &State, style: &Style) -> Result<Picture, RenderError> {
    let (columns, rows) = state.size();
    let size = (columns.cast_unsigned(), rows.cast_unsigned());
    let (mut picture, height) = framed(looks, size, style, |picture, left| {
        sprites(picture, looks, state, left, style.cell);
    })?;
    if style.caption {
        caption::draw(&mut picture, looks, state, style, height);
    }
    Ok(picture)
}

/// Creates an image of a board, to which `draw` adds the sprites. `draw` receives the left edge of the board. Adds
/// the legend, and leaves space above it for a caption, if the style requires them. Also returns the height of the
/// board, below which the caption is placed.
pub(crate) fn framed(
    looks: &Looks,
    (columns, rows): (u32, u32),
    style: &Style,
    draw: impl FnOnce(&mut Picture, u32),
) -> Result<(Picture, u32), RenderError> {
    let Style { cell, .. } = *style;
    if !(MIN_CELL..=MAX_CELL).contains(&cell) {
        return Err(RenderError::Cell { cell });
    }
    let (own, height) = (columns * cell, rows * cell);
    let width = if style.caption || style.legend { own.max(MIN_WIDTH) } else { own };
    let (strip, keys) = (caption::height(looks, style), legend::height(looks, style, width));
    let whole = u64::from(width) * u64::from(height + strip + keys);
    if whole > MAX_PIXELS {
        return Err(RenderError::TooLarge { pixels: whole });
    }
    let mut picture = Picture::new(width, height + strip + keys);
    let left = (width - own) / 2;
    ground(&mut picture, left, own, height, cell);
    draw(&mut picture, left);
    // The margins cover the parts of sprites that extend beyond the board.
    for (x, w) in [(0, left), (left + own, width - own - left)] {
        if w > 0 {
            picture.rect(Place { x: x as f32, y: 0.0, w: w as f32, h: height as f32 }, INK);
        }
    }
    if keys > 0 {
        legend::draw(&mut picture, looks, style, height + strip);
    }
    Ok((picture, height))
}

fn ground(picture: &mut Picture, left: u32, width: u32, height: u32, cell: u32) {
    let (x, w, h, step) = (left as f32, width as f32, height as f32, cell as f32);
    picture.rect(Place { x, y: 0.0, w, h }, GROUND);
    let line = (step / 32.0).max(1.0);
    for at in 1..width / cell {
        picture.rect(Place { x: x + at as f32 * step - line / 2.0, y: 0.0, w: line, h }, GRID);
    }
    for at in 1..height / cell {
        picture.rect(Place { x, y: at as f32 * step - line / 2.0, w, h: line }, GRID);
    }
}

fn sprites(picture: &mut Picture, looks: &Looks, state: &State, left: u32, cell: u32) {
    let game = looks.game();
    let mut records = game.records(state);
    let mut place_in_order = vec![usize::MAX; game.sprite_types().count()];
    for (at, stype) in game.drawing_order().into_iter().enumerate() {
        place_in_order[usize::from(stype)] = at;
    }
    // The sort is stable, so sprites of one type stay in order of creation.
    records.sort_by_key(|record| place_in_order[usize::from(record.stype)]);
    records.retain(|record| looks.is_visible(SpriteType(record.stype)));
    let scale = f64::from(cell) / f64::from(state.block().max(1));
    let rect = |record: &SpriteRecord| [record.rect.x, record.rect.y, record.rect.w, record.rect.h];
    let avatars: BTreeSet<[i32; 4]> =
        records.iter().filter(|record| is_avatar(looks, record)).map(rect).collect();
    if let Some(floor) = looks.floor() {
        let grounds = records.iter().filter(|record| looks.look(SpriteType(record.stype)).form.is_ground());
        let covered: BTreeSet<[i32; 4]> = grounds.map(rect).collect();
        let ((columns, rows), block, side) = (state.size(), state.block(), cell as f32);
        for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
            if !covered.contains(&[x * block, y * block, block, block]) {
                let (x, y) = (left as f32 + x as f32 * side, y as f32 * side);
                picture.sprite(Place { x, y, w: side, h: side }, game.name(floor), looks.look(floor), None);
            }
        }
    }
    let mut below: BTreeSet<[i32; 4]> = BTreeSet::new();
    // Sprites in an avatar's rectangle are drawn last, in the corners of that rectangle.
    let mut company: BTreeMap<[i32; 4], usize> = BTreeMap::new();
    let shares = |record: &SpriteRecord| {
        let ground = looks.look(SpriteType(record.stype)).form.is_ground();
        !ground && !is_avatar(looks, record) && avatars.contains(&rect(record))
    };
    records.sort_by_key(shares);
    let mut heaps: BTreeMap<([i32; 4], u16), (Place, usize)> = BTreeMap::new();
    for record in records {
        let stype = SpriteType(record.stype);
        let look = looks.look(stype);
        let drawn = record.rect;
        let mut place = Place {
            x: (f64::from(left) + f64::from(drawn.x) * scale) as f32,
            y: (f64::from(drawn.y) * scale) as f32,
            w: (f64::from(drawn.w) * scale) as f32,
            h: (f64::from(drawn.h) * scale) as f32,
        };
        if shares(&record) {
            let at = company.entry(rect(&record)).or_default();
            place = corner(place, *at);
            *at += 1;
        } else if !look.form.is_ground() && !below.insert(rect(&record)) && !is_avatar(looks, &record) {
            place = over(place);
        }
        let dead = record.flags & DISABLED != 0;
        let fallen = Look { glyph: Glyph::Fallen, form: Form::Glyph(Glyph::Fallen), mark: None, ..look };
        let look = if dead { fallen } else { look };
        let ground = look.form.is_ground();
        let place = if ground { place } else { plated(picture, place, look) };
        picture.sprite(place, game.name(stype), look, facing(&record, look.glyph));
        if !ground {
            heaps.entry((rect(&record), record.stype)).or_insert((place, 0)).1 += 1;
        }
    }
    heaps.into_values().filter(|(_, many)| *many > 1).for_each(|(place, many)| count(picture, place, many));
}

/// Writes the number of sprites of the same type in a rectangle into its top left corner. Without the number, they
/// would look like a single sprite.
fn count(picture: &mut Picture, place: Place, many: usize) {
    let (text, size) = (many.to_string(), place.h * COUNT);
    let plate = Place { w: text_width(&text, size) + size * 0.2, h: size * 1.2, ..place };
    picture.rect(plate, PAPER);
    picture.text((place.x + size * 0.15, place.y + size * 0.1), size, INK, &text);
}

fn is_avatar(looks: &Looks, record: &SpriteRecord) -> bool {
    matches!(looks.look(SpriteType(record.stype)).glyph, Glyph::Avatar | Glyph::Craft)
}

/// Returns the rectangle for the nth sprite that shares an avatar's rectangle. The avatar keeps its size.
fn corner(place: Place, nth: usize) -> Place {
    let (w, h) = (place.w * BESIDE, place.h * BESIDE);
    let (right, top) = (matches!(nth % 4, 1 | 2), nth % 4 > 1);
    let (x, y) = (if right { place.w - w } else { 0.0 }, if top { 0.0 } else { place.h - h });
    Place { x: place.x + x, y: place.y + y, w, h }
}

/// Returns the rectangle of a sprite drawn over a different sprite.
pub(crate) fn over(place: Place) -> Place {
    let (dx, dy) = (place.w * (1.0 - OVER) / 2.0, place.h * (1.0 - OVER) / 2.0);
    Place { x: place.x + dx, y: place.y + dy, w: place.w * OVER, h: place.h * OVER }
}

/// Draws a plate with the type's symbol (glyph) in the middle, for a sprite that is much wider than it is high, or vice
/// versa. A stretched symbol would be unrecognisable. Returns the symbol's rectangle.
fn plated(picture: &mut Picture, place: Place, look: Look) -> Place {
    let Place { x, y, w, h } = place;
    let side = w.min(h);
    if w.max(h) <= side * LONG {
        return place;
    }
    let rim = side / 20.0;
    picture.rect(place, INK);
    picture.rect(Place { x: x + rim, y: y + rim, w: w - 2.0 * rim, h: h - 2.0 * rim }, look.colour.light());
    Place { x: x + (w - side) / 2.0, y: y + (h - side) / 2.0, w: side, h: side }
}

/// The flag in [`SpriteRecord::flags`] for a killed avatar.
const DISABLED: u16 = 1;

/// Returns the direction that a sprite's front faces: its orientation or, for crafts without an orientation, its
/// rotation. Returns `None` for glyphs without a front, and for sprites without a direction.
fn facing(record: &SpriteRecord, glyph: Glyph) -> Option<Point> {
    if !glyph.turns() && glyph != Glyph::Avatar {
        return None;
    }
    if let Some(front) = unit(record.orientation) {
        return Some(front);
    }
    let rotation = record.rotation;
    (glyph == Glyph::Craft && rotation != 0.0)
        .then(|| [libm::cos(rotation) as f32, libm::sin(rotation) as f32])
}
