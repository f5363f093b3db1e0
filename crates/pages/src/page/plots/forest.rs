//! Forest plots. Each line shows one fraction with its interval.

use super::Label;
use super::canvas::{Anchor, Canvas};
use crate::page::words;

/// The width reserved for names, in pixels.
const LEFT: f64 = 150.0;
/// The width of the scale from 0 to 1, in pixels.
const PLANE: f64 = 200.0;
/// The width reserved for the figures next to the scale, in pixels.
const RIGHT: f64 = 160.0;
/// The line height, in pixels.
const LINE: f64 = 28.0;
/// The height reserved for the scale's labels, in pixels.
const FOOT: f64 = 24.0;

pub(crate) struct ForestRow {
    pub(crate) label: Label,
    /// The fraction with its interval, or `None` if there are no cases.
    pub(crate) share: Option<(f64, [f64; 2])>,
    pub(crate) of: String,
    /// `true` for a reference player, and `false` for a player under test.
    pub(crate) reference: bool,
}

/// Draws the rows from top to bottom, with a vertical line at one half. `label` describes the plot. Cost: O(rows).
pub(crate) fn forest(label: &str, rows: &[ForestRow]) -> String {
    let foot = rows.len() as f64 * LINE + 4.0;
    let mut canvas = Canvas::new("forest", LEFT + PLANE + RIGHT, foot + FOOT, label);
    let along = |share: f64| LEFT + PLANE * share.clamp(0.0, 1.0);
    for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let class = if part == 0.5 { "half" } else { "rule" };
        canvas.lines(&[&[[along(part), 2.0], [along(part), foot]]], class);
        canvas.text(along(part), foot + 16.0, Anchor::Middle, "soft", &words::whole_percent(part));
    }
    for (at, row) in rows.iter().enumerate() {
        let (top, middle) = (at as f64 * LINE, at as f64 * LINE + LINE / 2.0 + 1.0);
        let name = &row.label.name;
        canvas.label(LEFT - 8.0, top + 19.0, &row.label);
        let beside = along(1.0) + 12.0;
        match row.share.filter(|(share, [low, high])| [share, low, high].iter().all(|end| end.is_finite())) {
            None => canvas.missing([along(0.0), top + 5.0, PLANE, LINE - 8.0], &format!("{name}: no value")),
            Some((share, [low, high])) => {
                let value = words::whole_percent(share);
                let band = format!("{:.0}–{:.0}", 100.0 * low, 100.0 * high);
                canvas.open(
                    if row.reference { "mark" } else { "subject" },
                    &format!("{name}: {value}, {band}"),
                );
                canvas.lines(&[&[[along(low), middle], [along(high), middle]]], "whisker");
                for end in [low, high] {
                    canvas.lines(&[&[[along(end), middle - 4.0], [along(end), middle + 4.0]]], "whisker");
                }
                canvas.dot(along(share), middle, 4.5, "dot");
                canvas.close();
                canvas.text(beside + 36.0, middle + 4.0, Anchor::End, "", &value);
                canvas.text(beside + 44.0, middle + 4.0, Anchor::Start, "soft", &band);
            }
        }
        if !row.of.is_empty() {
            canvas.text(LEFT + PLANE + RIGHT - 2.0, middle + 4.0, Anchor::End, "soft", &row.of);
        }
    }
    canvas.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_shown_within_the_scale() {
        let row = |name: &str, share, reference| ForestRow {
            label: Label { name: name.to_owned(), note: String::new() },
            share,
            of: "3/5".to_owned(),
            reference,
        };
        let rows = [
            row("good", Some((0.6, [0.23, 1.2])), false),
            row("none", None, false),
            row("mark", Some((0.0, [-0.1, 0.43])), true),
        ];
        let svg = forest("win rates", &rows);
        for part in ["60\u{a0}%", "23–120", "class=\"subject\"", "class=\"mark\"", "3/5"] {
            assert!(svg.contains(part), "{part} in {svg}");
        }
        assert_eq!((svg.matches("class=\"none\"").count(), svg.matches("<circle").count()), (1, 2));
        // Intervals that extend beyond the scale are drawn up to its ends.
        assert!(svg.contains("L350 15") && svg.contains("M150 71"), "{svg}");
        assert!(!svg.contains("NaN"));
    }
}
