//! Plots of values over the months, such as abilities. Each value has an interval.

use super::canvas::{Anchor, Canvas};
use super::shortened;

/// The width of the left margin, in pixels.
const LEFT: f64 = 38.0;
/// The height of the top margin, in pixels.
const TOP: f64 = 8.0;
/// The height of the bottom margin, in pixels.
const FOOT: f64 = 24.0;
/// The minimum vertical distance between line names next to the plotting area, in pixels.
const LABEL: f64 = 13.0;
/// The maximum number of characters in a line name next to the plotting area.
const LETTERS: usize = 22;
/// The width reserved for line names next to the plotting area, in pixels.
const NAMES: f64 = 150.0;

/// A value for one month, with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MonthPoint {
    pub(crate) value: f64,
    pub(crate) band: [f64; 2],
    /// For each end of the interval, `true` if the data determine that end. Otherwise, the interval extends to the
    /// edge of the plot.
    pub(crate) is_bounded: [bool; 2],
}

/// A line in a plot over the months.
pub(crate) struct MonthSeries {
    pub(crate) name: String,
    /// The class that sets the line's colour: `hue0` to `hue5`, or `mark`.
    pub(crate) class: String,
    /// The value for each month, or `None` for months without a value.
    pub(crate) points: Vec<Option<MonthPoint>>,
    /// `true` to draw the intervals in addition to the line.
    pub(crate) whiskers: bool,
}

/// A plot with lines over the months.
pub(crate) struct MonthPlot<'a> {
    pub(crate) label: &'a str,
    pub(crate) months: &'a [String],
    /// The plot's lines. Later lines are drawn over earlier lines.
    pub(crate) series: &'a [MonthSeries],
    /// The lower and the upper end of the axis.
    pub(crate) range: [f64; 2],
    /// The width and height of the plotting area, in pixels.
    pub(crate) plane: [f64; 2],
    /// `true` to write the line names next to the plotting area.
    pub(crate) names: bool,
}

/// Draws lines over the months, on an axis in logits with a horizontal line at 0. Cost: O(points).
pub(crate) fn over_months(plot: &MonthPlot<'_>) -> String {
    let MonthPlot { months, series, range: [least, most], plane: [width, height], .. } = *plot;
    let right = if plot.names { NAMES } else { 12.0 };
    let mut canvas = Canvas::new("months", LEFT + width + right, TOP + height + FOOT, plot.label);
    let up = |value: f64| TOP + height * (1.0 - ((value - least) / (most - least).max(1e-9)).clamp(0.0, 1.0));
    let step = tick(most - least);
    let ticks =
        (libm::ceil(least / step) as i64..=libm::floor(most / step) as i64).map(|at| at as f64 * step);
    for at in ticks {
        let class = if at == 0.0 { "half" } else { "rule" };
        canvas.lines(&[&[[LEFT, up(at)], [LEFT + width, up(at)]]], class);
        let name = if step < 1.0 { format!("{at:+.1}") } else { format!("{at:+.0}") };
        let name = if at == 0.0 { "0".to_owned() } else { name.replace('-', "−") };
        canvas.text(LEFT - 6.0, up(at) + 4.0, Anchor::End, "soft", &name);
    }
    let slot = width / months.len().max(1) as f64;
    let centre = |month: usize| LEFT + slot * (month as f64 + 0.5);
    let room = months.iter().map(|name| name.chars().count()).max().unwrap_or(1) as f64 * 6.5 + 8.0;
    let every = libm::ceil(room / slot).max(1.0) as usize;
    for (at, name) in months.iter().enumerate().filter(|(at, _)| at % every == 0) {
        canvas.text(centre(at), TOP + height + 16.0, Anchor::Middle, "soft", name);
    }
    // Lines with intervals are placed side by side within each month.
    let wide = series.iter().filter(|line| line.whiskers).count();
    let dodge = (slot * 0.6 / wide.max(1) as f64).min(9.0);
    let mut place = 0;
    for line in series {
        let shift = match line.whiskers {
            true => {
                place += 1;
                dodge * (place as f64 - 0.5 - wide as f64 / 2.0)
            }
            false => 0.0,
        };
        draw(&mut canvas, plot, line, &|month| centre(month) + shift, &up);
    }
    if plot.names {
        name_lines(&mut canvas, plot, LEFT + width + 8.0, &up);
    }
    canvas.finish()
}

fn draw(
    canvas: &mut Canvas,
    plot: &MonthPlot<'_>,
    line: &MonthSeries,
    along: &dyn Fn(usize) -> f64,
    up: &dyn Fn(f64) -> f64,
) {
    let known = || line.points.iter().enumerate().filter_map(|(at, point)| Some((at, (*point)?)));
    let bounded: Vec<[f64; 2]> = known()
        .filter(|(_, point)| point.is_bounded == [true, true])
        .map(|(at, point)| [along(at), up(point.value)])
        .collect();
    canvas.open(&line.class, &line.name);
    canvas.lines(&[&bounded], "thread");
    canvas.close();
    for (at, point) in known() {
        let MonthPoint { value, band: [low, high], is_bounded } = point;
        let words = match is_bounded {
            [true, true] => format!("{value:+.2}, {low:+.2} to {high:+.2}"),
            [false, _] => format!("below {high:+.2}, with no win"),
            [_, false] => format!("above {low:+.2}, with no loss"),
        };
        canvas.open(&line.class, &format!("{}, {}: {words}", line.name, plot.months[at]));
        let x = along(at);
        let low = if is_bounded[0] { low } else { plot.range[0] };
        let high = if is_bounded[1] { high } else { plot.range[1] };
        if line.whiskers {
            canvas.lines(&[&[[x, up(low)], [x, up(high)]]], "whisker");
        }
        if is_bounded == [true, true] {
            canvas.dot(x, up(value), if line.whiskers { 3.5 } else { 2.0 }, "dot");
        } else if line.whiskers {
            // Only one end of the interval was determined.
            let end = up(if is_bounded[0] { low } else { high });
            canvas.lines(&[&[[x - 4.0, end], [x + 4.0, end]]], "whisker");
        }
        canvas.close();
    }
}

/// Writes the line names next to the ends of the lines, with enough vertical distance between them.
fn name_lines(canvas: &mut Canvas, plot: &MonthPlot<'_>, x: f64, up: &dyn Fn(f64) -> f64) {
    let mut ends: Vec<(f64, &MonthSeries)> = plot
        .series
        .iter()
        .filter_map(|line| {
            let last = line.points.iter().flatten().rfind(|point| point.is_bounded == [true, true]);
            let end = last.map(|point| point.value);
            let end = end.or_else(|| {
                line.whiskers
                    .then(|| line.points.iter().flatten().next_back())
                    .flatten()
                    .map(|one| one.band[1])
            });
            Some((up(end?), line))
        })
        .collect();
    ends.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.name.cmp(&other.1.name)));
    // Names that are too close are moved down first. If they then run past the bottom of the plot, they are
    // moved up again.
    let mut taken = f64::NEG_INFINITY;
    for (y, _) in &mut ends {
        *y = y.max(taken + LABEL);
        taken = *y;
    }
    let mut free = TOP + plot.plane[1] + LABEL / 2.0;
    for (y, _) in ends.iter_mut().rev() {
        *y = y.min(free);
        free = *y - LABEL;
    }
    for (y, line) in ends {
        canvas.open(&line.class, &line.name);
        canvas.text(x, y + 4.0, Anchor::Start, "tint", &shortened(&line.name, LETTERS));
        canvas.close();
    }
}

/// Returns the distance between axis labels, in units of the axis, chosen so that an axis has about five to ten labels.
fn tick(range: f64) -> f64 {
    [0.5, 1.0, 2.0, 5.0, 10.0].into_iter().find(|step| range / step <= 8.0).unwrap_or(20.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stay_within_the_plane() {
        let point =
            |value: f64, is_bounded| Some(MonthPoint { value, band: [value - 1.0, value + 1.0], is_bounded });
        let both = [true, true];
        let series = [
            MonthSeries {
                name: "a<b".to_owned(),
                class: "hue0".to_owned(),
                points: vec![point(0.0, both), None, point(9.0, both)],
                whiskers: true,
            },
            MonthSeries {
                name: "none".to_owned(),
                class: "mark".to_owned(),
                points: vec![None, point(-4.0, [false, true]), None],
                whiskers: true,
            },
        ];
        let months = ["2027-01", "2027-02", "2027-03"].map(str::to_owned);
        let plot = MonthPlot {
            label: "abilities",
            months: &months,
            series: &series,
            range: [-3.0, 3.0],
            plane: [300.0, 120.0],
            names: true,
        };
        let svg = over_months(&plot);
        assert_eq!(svg.matches("<circle").count(), 2);
        for part in ["a&lt;b", "below −", "2027-02", "class=\"hue0\""].map(|part| part.replace('−', "-"))
        {
            assert!(svg.contains(&part), "{part} in {svg}");
        }
        let number =
            |text: &str| -> f64 { text.split('"').next().unwrap_or_default().parse().expect("a number") };
        assert!(svg.split("cy=\"").skip(1).map(number).all(|y| (TOP..=TOP + 120.0).contains(&y)), "{svg}");
        assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
        // Without months, the plotting area is empty.
        assert!(!over_months(&MonthPlot { months: &[], series: &[], ..plot }).contains("NaN"));
    }
}
