//! A contact sheet, which combines several images into one, each with a caption.

use crate::error::RenderError;
use crate::looks::colour::{Colour, GREEN, GROUND, INK, ORANGE, PAPER, PURPLE, SKY, VERMILION, YELLOW};
use crate::looks::figure::Form;
use crate::looks::glyph::Glyph;
use crate::looks::look::Look;
use crate::picture::{ADVANCE, Picture, Place, shortened};
use crate::style::MAX_PIXELS;

/// The number of pixels between the images, and around them.
const GAP: u32 = 16;
/// The text height of a caption, in pixels.
const LETTER: u32 = 15;
/// The line height of a caption, in pixels.
const LEADING: u32 = 19;

const LINES: usize = 4;

/// Arranges images in rows of `columns` images. Each image is shrunk, but never enlarged, to fit a square of `side`
/// pixels, and its caption is placed below. The first line of a caption is shortened to fit. The text after a line
/// feed is broken into up to three more lines. A row is as high as its tallest image plus its longest caption.
///
/// # Errors
///
/// Returns an error if the sheet would have more than [`MAX_PIXELS`] pixels.
pub fn sheet(entries: &[(Picture, String)], columns: usize, side: u32) -> Result<Picture, RenderError> {
    let columns = columns.clamp(1, entries.len().max(1));
    let scale = |picture: &Picture| {
        let longest = picture.width().max(picture.height()).max(1);
        (side as f32 / longest as f32).min(1.0)
    };
    let shrunk = |length: u32, scale: f32| (length as f32 * scale) as u32;
    let letters = (side as f32 / (LETTER as f32 * ADVANCE)) as usize;
    let row_height = |row: &[(Picture, String)]| {
        let heights = row.iter().map(|(picture, _)| shrunk(picture.height(), scale(picture)));
        let lines = row.iter().map(|(_, caption)| broken(caption, letters).len() as u32);
        heights.max().unwrap_or(0) + lines.max().unwrap_or(1) * LEADING - LEADING + LETTER + GAP + GAP / 2
    };
    let width = columns as u64 * (u64::from(side) + u64::from(GAP)) + u64::from(GAP);
    let height = entries.chunks(columns).map(row_height).sum::<u32>() + GAP;
    let pixels = width * u64::from(height);
    if pixels > MAX_PIXELS {
        return Err(RenderError::TooLarge { pixels });
    }
    let width = width as u32;
    let mut sheet = Picture::new(width, height);
    sheet.rect(Place { x: 0.0, y: 0.0, w: width as f32, h: height as f32 }, PAPER);
    let mut top = GAP;
    for row in entries.chunks(columns) {
        for ((picture, caption), at) in row.iter().zip(0u32..) {
            let (left, scale) = (GAP + at * (side + GAP), scale(picture));
            let inset = (side - shrunk(picture.width(), scale)) / 2;
            sheet.inset(picture, ((left + inset) as f32, top as f32), scale);
            let mut foot = top + shrunk(picture.height(), scale) + GAP / 2;
            for line in broken(caption, letters) {
                sheet.text((left as f32, foot as f32), LETTER as f32, INK, &line);
                foot += LEADING;
            }
        }
        top += row_height(row);
    }
    Ok(sheet)
}

/// Returns the lines of a caption (at least one). Words that are too long are shortened to the length of a line. If
/// there are too many lines, the last line is shortened as well.
fn broken(caption: &str, letters: usize) -> Vec<String> {
    let (first, rest) = caption.split_once('\n').unwrap_or((caption, ""));
    let mut lines = vec![first.to_owned()];
    let mut full = true;
    for word in rest.split_whitespace() {
        let many = lines.len();
        let last = lines.last_mut().expect("the caption has a line");
        let fits = last.chars().count() + 1 + word.chars().count() <= letters;
        if !full && (fits || many == LINES) {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(word.to_owned());
            full = false;
        }
    }
    lines.iter().map(|line| shortened(line, letters)).collect()
}

/// Returns every glyph (symbol of a kind of sprite) with its meaning, in rows of `columns` glyphs, as a legend for all
/// boards.
pub fn gallery(columns: usize) -> Picture {
    let entries: Vec<_> = Glyph::ALL.iter().map(|&glyph| (Look::plain(glyph), glyph.meaning())).collect();
    shelves(&entries, columns, 290)
}

/// Returns every figure (drawing of a noun) with its name, in rows of `columns` figures, drawn in colours that games
/// use.
pub fn figures(columns: usize) -> Picture {
    const COLOURS: [Colour; 6] = [ORANGE, SKY, GREEN, YELLOW, VERMILION, PURPLE];
    let look = |(form, at): (Form, usize)| {
        let plain = Look::plain(Glyph::Neutral);
        (Look { form, colour: COLOURS[at % COLOURS.len()], ..plain }, form.name())
    };
    let entries: Vec<_> = Form::figures().zip(0..).map(look).collect();
    shelves(&entries, columns, 150)
}

/// Returns tiles with their captions, `step` pixels apart.
fn shelves(entries: &[(Look, &str)], columns: usize, step: u32) -> Picture {
    const SIDE: u32 = 44;
    let columns = columns.max(1) as u32;
    let rows = (entries.len() as u32).div_ceil(columns);
    let (width, height) = (columns * step, rows * (SIDE + GAP) + GAP);
    let mut shelves = Picture::new(width, height);
    shelves.rect(Place { x: 0.0, y: 0.0, w: width as f32, h: height as f32 }, GROUND);
    for (&(look, words), at) in entries.iter().zip(0u32..) {
        let (x, y) = ((at % columns * step + GAP) as f32, (at / columns * (SIDE + GAP) + GAP) as f32);
        let place = Place { x, y, w: SIDE as f32, h: SIDE as f32 };
        shelves.sprite(place, look.form.name(), look, None);
        let left = x + (SIDE + GAP / 2) as f32;
        shelves.text((left, y + 15.0), 13.0, INK, words);
    }
    shelves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(caption: &str, expect: &[&str]) {
        assert_eq!(broken(caption, 10), expect);
    }

    #[test]
    fn captions_are_broken_after_their_first_line() {
        check("", &[""]);
        check("one two three", &[shortened("one two three", 10).as_str()]);
        check("One\ntwo three four", &["One", "two three", "four"]);
        let many = shortened("eeee ffff gggg", 10);
        check("One\naaaa bbbb cccc dddd eeee ffff gggg", &["One", "aaaa bbbb", "cccc dddd", many.as_str()]);
    }
}
