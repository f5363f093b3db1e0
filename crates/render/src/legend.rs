//! The legend of a board: each sprite type that players can see, with its tile.

use crate::looks::colour::{GROUND, INK};
use crate::looks::look::{Look, Looks};
use crate::picture::{ADVANCE, Picture, Place, shortened, text_width};
use crate::style::Style;
use engine::SpriteType;

/// The gap between the edge, the entries and their parts, in pixels.
const GAP: u32 = 8;
/// The text height of a name, and of the meaning below it, in pixels.
const NAME: f32 = 15.0;
const MEANING: f32 = 11.0;

struct Entry<'a> {
    stype: SpriteType,
    look: Look,
    name: &'a str,
    meaning: &'a str,
}

struct Layout {
    columns: u32,
    /// The width of a column in pixels: the distance between the left edges of adjacent entries.
    step: u32,
    side: u32,
}

fn entries(looks: &Looks) -> Vec<Entry<'_>> {
    let entry = |stype| {
        let (name, meaning) = (looks.game().name(stype), looks.meaning(stype));
        Entry { stype, look: looks.look(stype), name, meaning }
    };
    let mut entries: Vec<Entry<'_>> = looks.shown().map(entry).collect();
    entries.sort_by_key(|entry| (entry.look.glyph, entry.stype));
    entries
}

fn layout(entries: &[Entry<'_>], style: &Style, width: u32) -> Layout {
    let side = style.cell.clamp(32, 40);
    let text =
        |entry: &Entry<'_>| text_width(entry.name, NAME).max(text_width(entry.meaning, MEANING)) as u32;
    let widest = entries.iter().map(text).max().unwrap_or(0);
    let columns = ((width - GAP.min(width)) / (side + widest + 3 * GAP)).max(1);
    Layout { columns, step: width / columns, side }
}

pub(crate) fn height(looks: &Looks, style: &Style, width: u32) -> u32 {
    let entries = entries(looks);
    let Layout { columns, side, .. } = layout(&entries, style, width);
    let rows = (entries.len() as u32).div_ceil(columns);
    if style.legend && rows > 0 { rows * (side + GAP) + GAP } else { 0 }
}

pub(crate) fn draw(picture: &mut Picture, looks: &Looks, style: &Style, top: u32) {
    let width = picture.width();
    let entries = entries(looks);
    let Layout { columns, step, side } = layout(&entries, style, width);
    let h = height(looks, style, width) as f32;
    picture.rect(Place { x: 0.0, y: top as f32, w: width as f32, h }, GROUND);
    for (entry, at) in entries.iter().zip(0u32..) {
        let (x, y) = ((at % columns * step + GAP) as f32, (top + GAP + at / columns * (side + GAP)) as f32);
        picture.sprite(
            Place { x, y, w: side as f32, h: side as f32 },
            entry.name,
            entry.look,
            looks.front(entry.stype),
        );
        let left = x + (side + GAP) as f32;
        let room = step.saturating_sub(side + 2 * GAP) as f32;
        let fitting = |text, size: f32| shortened(text, (room / (size * ADVANCE)) as usize);
        picture.text((left, y + 2.0), NAME, INK, &fitting(entry.name, NAME));
        let meaning = fitting(entry.meaning, MEANING);
        picture.text((left, y + 4.0 + NAME), MEANING, INK.mixed(GROUND, 35), &meaning);
    }
}
