//! Letters as strokes: a built-in font, so that images need no system fonts.

use super::colour::Colour;
use super::shape::{Outline, Paint, Point, Shape};

/// The strokes of `!` to `~`, one character per line: the character and then its strokes, separated by
/// spaces. A stroke is a list of points of two digits each: a column from 0 to 4, and a row from 0 to 9.
/// Capitals stand on row 7 and reach up to row 1. A single point is a dot.
const STROKES: &str = include_str!("letters.txt");

/// The strokes of any other character.
const UNKNOWN: &str = "0141470701";

/// Returns the shapes of a character, in the left three fifths of a unit square.
pub(crate) fn shapes(letter: char, colour: Colour) -> Vec<Shape> {
    let mut known = STROKES.lines().filter_map(|line| line.strip_prefix(letter)?.strip_prefix(' '));
    let strokes = match letter {
        '·' => "24",
        _ => known.next().unwrap_or(UNKNOWN),
    };
    let shape = |stroke: &str| {
        let points: Vec<Point> = stroke.as_bytes().chunks_exact(2).map(point).collect();
        match points[..] {
            [[x, y]] => Shape { outline: Outline::circle(x, y, 0.06), paint: Paint::Fill, colour },
            _ => Shape { outline: Outline::line(&points), paint: Paint::Stroke(0.085), colour },
        }
    };
    strokes.split(' ').map(shape).collect()
}

fn point(digits: &[u8]) -> Point {
    let [column, row] = [digits[0], digits[1]].map(|digit| f32::from(digit - b'0'));
    [0.06 + 0.105 * column, 0.06 + 0.098 * row]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::looks::colour::INK;
    use crate::looks::shape::Segment;

    #[test]
    fn every_letter_is_drawn_within_its_square() {
        for letter in ' '..='~' {
            for shape in shapes(letter, INK) {
                assert!(!shape.outline.0.is_empty(), "{letter}");
                for segment in &shape.outline.0 {
                    if let Segment::Move(point) | Segment::Line(point) = segment {
                        assert!(point.iter().all(|part| (0.0..=1.0).contains(part)), "{letter} {point:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn no_two_letters_are_alike() {
        let mut strokes: Vec<&str> = STROKES.lines().filter_map(|line| line.get(2..)).collect();
        assert_eq!(strokes.len(), 94);
        strokes.sort_unstable();
        assert!(strokes.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
