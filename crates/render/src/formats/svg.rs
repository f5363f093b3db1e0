//! Images as SVG. Each tile is defined once, and referenced wherever it is stamped.

use crate::looks::shape::{Outline, Paint, Segment, Shape};
use crate::picture::{Picture, Tile};
use std::fmt::Write;

/// Returns an image as an SVG document. The same image yields identical bytes. Hovering over a sprite shows
/// its name.
pub fn svg(picture: &Picture) -> String {
    let (width, height) = (picture.width(), picture.height());
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n<defs>\n"
    );
    for (at, tile) in picture.tiles().iter().enumerate() {
        text.push_str(&svg_tile(&format!("t{at}"), tile));
    }
    text.push_str("</defs>\n");
    for stamp in picture.stamps() {
        let [x, y, w, h] = [stamp.place.x, stamp.place.y, stamp.place.w, stamp.place.h].map(number);
        let _ = writeln!(
            text,
            "<use href=\"#t{}\" transform=\"translate({x} {y}) scale({w} {h})\"/>",
            stamp.tile
        );
    }
    text.push_str("</svg>\n");
    text
}

/// Returns a tile as an SVG group with the given ID, in a unit square, for pages that stamp the tile many
/// times. Hovering over the tile shows its name.
pub fn svg_tile(id: &str, tile: &Tile) -> String {
    let mut text = format!("<g id=\"{id}\">");
    if let Some(name) = &tile.name {
        let _ = write!(text, "<title>{}</title>", escaped(name));
    }
    for Shape { outline, paint, colour } in &tile.shapes {
        let [red, green, blue] = colour.0;
        let colour = format!("#{red:02x}{green:02x}{blue:02x}");
        let path = path(outline);
        let _ = match paint {
            Paint::Fill => write!(text, "<path d=\"{path}\" fill=\"{colour}\"/>"),
            Paint::Stroke(width) => write!(
                text,
                "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"/>",
                number(*width)
            ),
        };
    }
    text.push_str("</g>\n");
    text
}

fn path(outline: &Outline) -> String {
    let mut text = String::new();
    for segment in &outline.0 {
        let (letter, points): (char, &[[f32; 2]]) = match segment {
            Segment::Move(point) => ('M', &[*point]),
            Segment::Line(point) => ('L', &[*point]),
            Segment::Cubic(one, two, end) => ('C', &[*one, *two, *end]),
            Segment::Close => ('Z', &[]),
        };
        text.push(letter);
        let numbers: Vec<String> = points.iter().flatten().map(|&part| number(part)).collect();
        text.push_str(&numbers.join(" "));
    }
    text
}

/// Formats a value with up to three decimals, without trailing zeros.
fn number(value: f32) -> String {
    let thousandths = (f64::from(value) * 1000.0).round() as i64;
    let (sign, size) = (if thousandths < 0 { "-" } else { "" }, thousandths.unsigned_abs());
    let digits = format!("{sign}{}.{:03}", size / 1000, size % 1000);
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Escapes text for SVG and HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let check = |value: f32, expect: &str| assert_eq!(number(value), expect);
        check(0.0, "0");
        check(-0.0004, "0");
        check(-1.25, "-1.25");
        check(100.0, "100");
        check(0.0456, "0.046");
    }
}
