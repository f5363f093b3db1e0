//! Stacked bars. Each line shows one amount, divided into parts.

use super::Label;
use super::canvas::{Anchor, Canvas};

/// The width reserved for names, in pixels.
const LEFT: f64 = 150.0;
/// The width of the longest bar, in pixels.
const PLANE: f64 = 300.0;
/// The width reserved for the figures next to the bars, in pixels.
const RIGHT: f64 = 70.0;
/// The line height, in pixels.
const LINE: f64 = 24.0;
/// The height of the key above the lines, in pixels.
const HEAD: f64 = 24.0;

/// An amount divided into parts.
pub(crate) struct BarRow {
    pub(crate) label: Label,
    /// The nonnegative sizes of the parts.
    pub(crate) parts: Vec<f64>,
    /// The amount as text, shown next to the bar.
    pub(crate) amount: String,
}

/// Draws the rows from top to bottom, scaled to the largest amount. `label` describes the plot, and `key` lists the
/// names of the parts. Cost: O(rows).
pub(crate) fn bars(label: &str, key: &[&str], rows: &[BarRow]) -> String {
    let mut canvas = Canvas::new("bars", LEFT + PLANE + RIGHT, HEAD + rows.len() as f64 * LINE + 4.0, label);
    let total = |row: &BarRow| row.parts.iter().sum::<f64>();
    let most = rows.iter().map(total).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let width = (PLANE + RIGHT) / key.len().max(1) as f64;
    for (at, name) in key.iter().enumerate() {
        let left = LEFT + at as f64 * width;
        canvas.open(&format!("hue{at}"), "");
        canvas.area(&boxed([left, 4.0, 10.0, 10.0]), "fill");
        canvas.close();
        canvas.text(left + 15.0, 13.0, Anchor::Start, "soft", name);
    }
    for (at, row) in rows.iter().enumerate() {
        let top = HEAD + at as f64 * LINE;
        canvas.label(LEFT - 8.0, top + 15.0, &row.label);
        let mut left = LEFT;
        for ((part, name), hue) in row.parts.iter().zip(key).zip(0..) {
            let length = PLANE * part / most;
            if length > 0.0 {
                canvas.open(&format!("hue{hue}"), &format!("{}, {name}", row.label.name));
                canvas.area(&boxed([left, top + 3.0, length, LINE - 8.0]), "fill");
                canvas.close();
            }
            left += length;
        }
        canvas.text(left + 8.0, top + 15.0, Anchor::Start, "", &row.amount);
    }
    canvas.finish()
}

/// Returns a rectangle's corners.
fn boxed([x, y, w, h]: [f64; 4]) -> [[f64; 2]; 4] {
    [[x, y], [x + w, y], [x + w, y + h], [x, y + h]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_share_a_scale() {
        let row = |name: &str, parts: &[f64]| BarRow {
            label: Label { name: name.to_owned(), note: String::new() },
            parts: parts.to_vec(),
            amount: format!("{name} in all"),
        };
        let svg = bars("costs", &["kept", "lost"], &[row("look", &[1.0, 3.0]), row("skill", &[2.0, 0.0])]);
        // One bar is half as long as the longest bar, and the other is the longest bar itself.
        assert!(svg.contains("L300 ") && svg.contains("L450 "), "{svg}");
        assert!(svg.contains("skill in all") && svg.contains("<title>look, lost</title>"), "{svg}");
        assert_eq!(svg.matches("class=\"fill\"").count(), 5, "the key, and each part that is not 0");
        assert!(!bars("nothing", &["kept"], &[row("look", &[0.0])]).contains("NaN"));
    }
}
