//! Letters as strokes: a built-in font, so that pictures need none of the system's.

use crate::colour::Colour;
use crate::shape::{Outline, Paint, Point, Shape};

/// The strokes of `!` to `~`, separated by blanks. A stroke is a list of points, two digits each: column 0 to 4, row
/// 0 to 9; capitals stand on row 7 and reach up to row 1. A single point is a dot.
const STROKES: [&str; 94] = [
    "2125 27",
    "1113 3133",
    "1117 3137 0343 0545",
    "423111020314344546371706 2028",
    "4107 0111120201 3646473736",
    "4713122132330506172745",
    "2123",
    "30222638",
    "10222618",
    "2226 0345 4305",
    "2226 0444",
    "2718",
    "1434",
    "27",
    "4107",
    "113142463717060211 1533",
    "122127 1737",
    "02113142430747",
    "0211314243344546371706 1434",
    "37310545",
    "410104344546371706",
    "4231110206173746453404",
    "014127",
    "14030211314243341405061737464534",
    "0617374642311102031444",
    "24 27",
    "24 2718",
    "420446",
    "0343 0545",
    "024406",
    "02113142432425 27",
    "4717060211314245252343",
    "0703214347 0545",
    "07013142433404 3445463707",
    "4231110206173746",
    "01214345270701",
    "41010747 0434",
    "410107 0434",
    "42311102061737464424",
    "0107 4147 0444",
    "2127 1131 1737",
    "4146371706",
    "0107 410447",
    "010747",
    "0701244147",
    "07014741",
    "113142463717060211",
    "07013142433404",
    "113142463717060211 2547",
    "07013142433404 2447",
    "423111020314344546371706",
    "0141 2127",
    "010617374641",
    "012741",
    "0117243741",
    "0147 4107",
    "012441 2427",
    "01410747",
    "30101838",
    "0147",
    "10303818",
    "032143",
    "0848",
    "1122",
    "13334447 451506173746",
    "0107 0413334446371706",
    "4433130406173746",
    "4147 4433130406173746",
    "05454433130406173746",
    "41312227 1343",
    "4433130406173746 4348391908",
    "0107 0413334447",
    "132327 1737 21",
    "2333382919 31",
    "0107 430547",
    "112127 1737",
    "0307 04132427 24334447",
    "0307 0413334447",
    "133344463717060413",
    "0309 0413334446371706",
    "4349 4433130406173746",
    "0307 04133344",
    "4313041535463707",
    "21263747 0343",
    "0306173746 4347",
    "032743",
    "0317243743",
    "0347 4307",
    "0326 4318",
    "03430747",
    "30212314252738",
    "2028",
    "10212334252718",
    "0413243544",
];

/// The strokes for any other letter.
const UNKNOWN: &str = "0141470701";

/// Returns the shapes of a letter in the left three fifths of a unit square.
pub(crate) fn shapes(letter: char, colour: Colour) -> Vec<Shape> {
    let known = (letter as usize).checked_sub('!' as usize).and_then(|at| STROKES.get(at));
    let strokes = match letter {
        '·' => "24",
        _ => known.unwrap_or(&UNKNOWN),
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
    use crate::colour::INK;
    use crate::shape::Segment;

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
        let mut strokes = STROKES.to_vec();
        strokes.sort_unstable();
        assert!(strokes.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
