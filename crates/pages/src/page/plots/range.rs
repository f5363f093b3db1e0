//! Expressive range plots, which count the points in each cell of a plane.

use super::canvas::{Anchor, Canvas};
use super::step;
use crate::page::words;
use forge::levels::report::{Axis, BINS, Range};

/// The width and height of the plotting area, in pixels.
const PLANE: f64 = 240.0;
/// The width of the margin for vertical axis labels, in pixels.
const LEFT: f64 = 58.0;
/// The height of the top margin, in pixels.
const TOP: f64 = 10.0;

/// Plots the levels of a set by two measures. Cells with more levels are darker. The game's own levels are drawn as
/// diamonds. Cost: O(cells).
pub(crate) fn range(range: &Range) -> String {
    let Range { x, y, cells, examples, .. } = range;
    let label = format!("{} by {}", x.measure, y.measure);
    let mut canvas = Canvas::new("heat", LEFT + PLANE + 14.0, TOP + PLANE + 44.0, &label);
    let most = cells.iter().flatten().max().copied().unwrap_or_default().max(1);
    let side = PLANE / BINS as f64;
    for (up, row) in cells.iter().enumerate() {
        for (across, &count) in row.iter().enumerate() {
            let place = [LEFT + across as f64 * side, TOP + PLANE - (up + 1) as f64 * side, side, side];
            let (class, title) = match count {
                0 => ("cell".to_owned(), String::new()),
                _ => (format!("cell q{}", step(count as f64, 0.0, most as f64)), words::many(count, "level")),
            };
            canvas.open(&class, &title);
            canvas.rect(place);
            canvas.close();
        }
    }
    let along =
        |axis: &Axis, value: f64| PLANE * ((value - axis.low) / (axis.high - axis.low)).clamp(0.0, 1.0);
    for point in examples {
        let (x, y) = (LEFT + along(x, point[0]), TOP + PLANE - along(y, point[1]));
        canvas.open("own", "one of the game's own levels");
        canvas.area(&[[x, y - 6.0], [x + 6.0, y], [x, y + 6.0], [x - 6.0, y]], "");
        canvas.close();
    }
    // Labels are written at the ends and in the middle of each axis, together with the names of the measures.
    for (part, anchor, drop) in
        [(0.0, Anchor::Start, 0.0), (0.5, Anchor::Middle, 4.0), (1.0, Anchor::End, 10.0)]
    {
        let value = |axis: &Axis| words::short(axis.low + part * (axis.high - axis.low));
        canvas.text(LEFT + part * PLANE, TOP + PLANE + 16.0, anchor, "", &value(x));
        canvas.text(LEFT - 6.0, TOP + PLANE * (1.0 - part) + drop, Anchor::End, "", &value(y));
    }
    canvas.text(LEFT + PLANE / 2.0, TOP + PLANE + 36.0, Anchor::Middle, "axis", &x.measure);
    canvas.upright(14.0, TOP + PLANE / 2.0, "axis", &y.measure);
    canvas.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_and_example_is_drawn() {
        let axis = |measure: &str, high| Axis { measure: measure.to_owned(), low: 0.0, high };
        let mut cells = vec![vec![0; BINS]; BINS];
        (cells[0][0], cells[9][9]) = (1, 5);
        let svg = range(&Range {
            x: axis("openness", 1.0),
            y: axis("ticks", 50.0),
            levels: vec![[0.0, 0.0]; 6],
            examples: vec![[0.5, 25.0], [2.0, 25.0]],
            cells,
            occupied: 2,
        });
        assert_eq!(svg.matches("<rect").count(), BINS * BINS);
        assert_eq!((svg.matches("class=\"own\"").count(), svg.matches("5 levels").count()), (2, 1));
        // An example outside the range is drawn at the edge of the plot.
        assert!(svg.contains("M178 124") && svg.contains("M298 124"), "{svg}");
        assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
    }
}
