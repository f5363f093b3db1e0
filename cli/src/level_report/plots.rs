//! Expressive ranges as heat maps: SVG inside a page.

use crate::page::facts::number;
use crate::page::words;
use forge::levels::report::{Axis, BINS, Range};
use std::fmt::Write;

/// Pixels of a heat map's plane.
const PLANE: f64 = 240.0;
/// Where the plane begins: room for the marks of the axes.
const LEFT: f64 = 58.0;
const TOP: f64 = 10.0;
/// The whole.
const WIDTH: f64 = LEFT + PLANE + 14.0;
const HEIGHT: f64 = TOP + PLANE + 44.0;

/// The darkest cell, and the lightest one that is not empty.
const DARK: [f64; 3] = [24.0, 92.0, 122.0];
const LIGHT: [f64; 3] = [214.0, 232.0, 238.0];

/// Where the levels lie in a pair of measures: the darker a cell, the more levels; the game's own levels as diamonds.
pub(super) fn heat_map(range: &Range) -> String {
    let mut svg = format!(
        "<svg class=\"heat\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
         aria-label=\"{} by {}\">\n",
        range.x.measure, range.y.measure
    );
    let most = range.cells.iter().flatten().max().copied().unwrap_or_default().max(1);
    let side = PLANE / BINS as f64;
    for (up, row) in range.cells.iter().enumerate() {
        for (across, &count) in row.iter().enumerate() {
            let (x, y) = (LEFT + across as f64 * side, TOP + PLANE - (up + 1) as f64 * side);
            let colour = if count == 0 { "#fbfaf8".to_owned() } else { shade(count, most) };
            let _ = write!(
                svg,
                "<rect x=\"{}\" y=\"{}\" width=\"{side}\" height=\"{side}\" fill=\"{colour}\" class=\"cell\">",
                number(x),
                number(y)
            );
            if count > 0 {
                let _ = write!(svg, "<title>{count} {}</title>", if count == 1 { "level" } else { "levels" });
            }
            svg.push_str("</rect>\n");
        }
    }
    for point in &range.examples {
        let (x, y) = (LEFT + along(&range.x, point[0]), TOP + PLANE - along(&range.y, point[1]));
        let (x, y) = (number(x), number(y));
        let _ = writeln!(
            svg,
            "<path d=\"M0 -6L6 0L0 6L-6 0Z\" transform=\"translate({x} {y})\" class=\"own\"><title>one of the game's own levels</title></path>"
        );
    }
    marks(&mut svg, range);
    svg.push_str("</svg>\n");
    svg
}

/// The ends and the middle of the axes, and their names.
fn marks(svg: &mut String, Range { x, y, .. }: &Range) {
    for part in [0.0, 0.5, 1.0] {
        let value = |axis: &Axis| words::short(axis.low + part * (axis.high - axis.low));
        let (across, up) = (LEFT + part * PLANE, TOP + PLANE * (1.0 - part));
        let foot = TOP + PLANE + 16.0;
        let anchor = if part == 0.0 {
            "start"
        } else if part == 1.0 {
            "end"
        } else {
            "middle"
        };
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{foot}\" text-anchor=\"{anchor}\">{}</text>",
            number(across),
            value(x)
        );
        let drop = if part == 1.0 {
            10.0
        } else if part == 0.0 {
            0.0
        } else {
            4.0
        };
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            LEFT - 6.0,
            number(up + drop),
            value(y)
        );
    }
    let (middle, foot) = (LEFT + PLANE / 2.0, TOP + PLANE + 36.0);
    let _ = writeln!(
        svg,
        "<text x=\"{middle}\" y=\"{foot}\" text-anchor=\"middle\" class=\"axis\">{}</text>",
        x.measure
    );
    let (side, height) = (14.0, TOP + PLANE / 2.0);
    let _ = writeln!(
        svg,
        "<text transform=\"translate({side} {height}) rotate(-90)\" text-anchor=\"middle\" class=\"axis\">{}</text>",
        y.measure
    );
}

/// Pixels from the lower end of an axis.
fn along(axis: &Axis, value: f64) -> f64 {
    PLANE * ((value - axis.low) / (axis.high - axis.low)).clamp(0.0, 1.0)
}

fn shade(count: u64, most: u64) -> String {
    let part = if most == 1 { 1.0 } else { (count - 1) as f64 / (most - 1) as f64 };
    let mixed = [0, 1, 2].map(|at: usize| (LIGHT[at] + part * (DARK[at] - LIGHT[at])) as u8);
    let [red, green, blue] = if most == 1 { [120, 168, 186] } else { mixed };
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_maps_are_well_formed_and_show_every_cell_and_example() {
        let axis = |measure: &str, high| Axis { measure: measure.to_owned(), low: 0.0, high };
        let mut cells = vec![vec![0; BINS]; BINS];
        (cells[0][0], cells[9][9]) = (1, 5);
        let range = Range {
            x: axis("openness", 1.0),
            y: axis("ticks", 50.0),
            levels: vec![[0.0, 0.0]; 6],
            examples: vec![[0.5, 25.0], [2.0, 25.0]],
            cells,
            occupied: 2,
        };
        let svg = heat_map(&range);
        assert_eq!(svg.matches("<rect").count(), BINS * BINS);
        assert_eq!((svg.matches("class=\"own\"").count(), svg.matches("5 levels").count()), (2, 1));
        // What lies outside is drawn at the edge.
        assert!(svg.contains("translate(178 130)") && svg.contains("translate(298 130)"), "{svg}");
        assert_eq!(
            svg.matches("<svg").count() + svg.matches("<rect").count(),
            svg.matches("</svg>").count() + svg.matches("</rect>").count()
        );
    }
}
