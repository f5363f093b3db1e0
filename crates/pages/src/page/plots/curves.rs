//! Curves over a logarithmic scale, such as win rates by commitment.

use super::canvas::{Anchor, Canvas};
use crate::page::words;

/// The width and height of the plotting area, in pixels.
const PLANE: [f64; 2] = [300.0, 150.0];
/// The width of the left margin, in pixels.
const LEFT: f64 = 46.0;
/// The width of the right margin, in pixels.
const RIGHT: f64 = 24.0;
/// The height of the top margin, in pixels.
const TOP: f64 = 10.0;
/// The height of the bottom margin, in pixels.
const FOOT: f64 = 36.0;

/// A point on a curve: its position on the scale, the position's name, and a fraction with its interval.
pub(crate) struct CurvePoint {
    pub(crate) at: f64,
    pub(crate) name: String,
    pub(crate) share: f64,
    pub(crate) band: [f64; 2],
}

/// Draws a curve of fractions with whiskers, and a horizontal line at one half. `marked` contains the
/// position where the curve crosses that line, with its interval on the scale. Cost: O(points).
pub(crate) fn curve(label: &str, points: &[CurvePoint], marked: Option<(f64, [f64; 2])>) -> String {
    let mut canvas = Canvas::new("curve", LEFT + PLANE[0] + RIGHT, TOP + PLANE[1] + FOOT, label);
    let ends = marked.iter().flat_map(|(at, band)| [*at, band[0], band[1]]);
    let places: Vec<f64> =
        points.iter().map(|point| point.at).chain(ends).map(|at| libm::log(at.max(1e-9))).collect();
    let (least, most) =
        places.iter().fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(*at), high.max(*at)));
    let along = |at: f64| {
        LEFT + 8.0 + (PLANE[0] - 16.0) * (libm::log(at.max(1e-9)) - least) / (most - least).max(1e-9)
    };
    let up = |share: f64| TOP + PLANE[1] * (1.0 - share.clamp(0.0, 1.0));
    for part in [0.0, 0.5, 1.0] {
        let class = if part == 0.5 { "half" } else { "rule" };
        canvas.lines(&[&[[LEFT, up(part)], [LEFT + PLANE[0], up(part)]]], class);
        canvas.text(LEFT - 6.0, up(part) + 4.0, Anchor::End, "soft", &words::whole_percent(part));
    }
    let line: Vec<[f64; 2]> = points.iter().map(|point| [along(point.at), up(point.share)]).collect();
    canvas.open("subject", label);
    canvas.lines(&[&line], "whisker");
    canvas.close();
    // Points at the same position share one name.
    let mut taken = f64::MIN;
    for point in points {
        let (x, [low, high]) = (along(point.at), point.band);
        let band = format!("{:.0}–{:.0}", 100.0 * low, 100.0 * high);
        canvas.open("subject", &format!("{}: {}, {band}", point.name, words::whole_percent(point.share)));
        canvas.lines(&[&[[x, up(low)], [x, up(high)]]], "whisker");
        canvas.dot(x, up(point.share), 4.0, "dot");
        canvas.close();
        if x - taken >= 22.0 {
            canvas.text(x, TOP + PLANE[1] + 16.0, Anchor::Middle, "soft", &point.name);
            taken = x;
        }
    }
    if let Some((at, [low, high])) = marked {
        let y = TOP + PLANE[1] + 26.0;
        canvas.open("mark", &format!("horizon {at:.1}, {low:.1}–{high:.1}"));
        canvas.lines(&[&[[along(low), y], [along(high), y]]], "whisker");
        canvas.dot(along(at), y, 4.0, "dot");
        canvas.close();
    }
    canvas.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stay_within_the_plane() {
        let point = |at: f64, share| CurvePoint {
            at,
            name: format!("{at}"),
            share,
            band: [share - 0.2, share + 0.2],
        };
        let svg = curve(
            "a player",
            &[point(1.0, 0.9), point(20.0, 0.5), point(400.0, 0.0)],
            Some((20.0, [5.0, 90.0])),
        );
        let number =
            |text: &str| -> f64 { text.split('"').next().unwrap_or_default().parse().expect("a number") };
        let found: Vec<f64> = svg.split("cx=\"").skip(1).map(number).collect();
        assert_eq!(found.len(), 4);
        assert!(found.iter().all(|x| (LEFT..=LEFT + PLANE[0]).contains(x)), "{found:?}");
    }

    #[test]
    fn one_point_is_drawn() {
        let svg = curve(
            "a player",
            &[CurvePoint { at: 1.0, name: "1".to_owned(), share: 0.5, band: [0.1, 0.9] }],
            None,
        );
        assert!(!svg.contains("NaN"), "{svg}");
    }
}
