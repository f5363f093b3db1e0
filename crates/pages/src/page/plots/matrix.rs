//! Correlation matrices, which show each pair of measures once.

use super::canvas::{Anchor, Canvas};
use super::step;

/// The width reserved for row names, in pixels.
const LEFT: f64 = 128.0;
/// The width and height of a cell, in pixels.
const CELL: [f64; 2] = [74.0, 46.0];
/// The height reserved for column names below the cells, in pixels.
const FOOT: f64 = 24.0;

/// Draws the part of the matrix below the diagonal. `label` describes the matrix. For each pair of measures
/// in `names`, `cells` contains the coefficient from -1 to 1 and the text below it, or `None` for a missing
/// value. Cost: O(cells).
pub(crate) fn matrix(label: &str, names: &[&str], cells: &[Vec<Option<(f64, String)>>]) -> String {
    let count = names.len();
    let sides = count.saturating_sub(1) as f64;
    let mut canvas = Canvas::new("matrix", LEFT + sides * CELL[0] + 8.0, sides * CELL[1] + FOOT, label);
    for row in 1..count {
        let top = (row - 1) as f64 * CELL[1];
        canvas.text(LEFT - 8.0, top + CELL[1] / 2.0 + 4.0, Anchor::End, "", names[row]);
        for column in 0..row {
            let left = LEFT + column as f64 * CELL[0];
            let place = [left + 0.5, top + 0.5, CELL[0] - 1.0, CELL[1] - 1.0];
            let pair = format!("{} and {}", names[row], names[column]);
            match cells[row][column].as_ref().filter(|(value, _)| value.is_finite()) {
                None => canvas.missing(place, &format!("{pair}: no value")),
                Some((value, note)) => {
                    canvas.open(
                        &format!("d{}", step(*value, -1.0, 1.0)),
                        &format!("{pair}: {value:+.3}, {note}"),
                    );
                    canvas.rect(place);
                    let middle = left + CELL[0] / 2.0;
                    canvas.text(middle, top + 20.0, Anchor::Middle, "", &format!("{value:+.2}"));
                    canvas.text(middle, top + 36.0, Anchor::Middle, "small", note);
                    canvas.close();
                }
            }
        }
    }
    for (column, name) in names.iter().take(count.saturating_sub(1)).enumerate() {
        let middle = LEFT + (column as f64 + 0.5) * CELL[0];
        canvas.text(middle, sides * CELL[1] + 15.0, Anchor::Middle, "", name);
    }
    canvas.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pair_is_reported_once() {
        let names = ["win", "steps", "distance"];
        let cell = |value: f64| Some((value, "p < 0.001".to_owned()));
        let cells = [vec![], vec![cell(-0.28)], vec![None, cell(f64::NAN)]];
        let svg = matrix("correlations", &names, &cells);
        assert!(
            svg.contains(">-0.28<") && svg.contains("class=\"d4\"") && svg.contains("p &lt; 0.001"),
            "{svg}"
        );
        assert_eq!(svg.matches("class=\"none\"").count(), 2);
        assert!(!svg.contains("NaN"));
    }
}
