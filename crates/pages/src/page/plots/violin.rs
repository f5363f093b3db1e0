//! Violin plots, which show several distributions side by side.

use super::canvas::{Anchor, Canvas};
use crate::page::words;
use statistics::quantile;

/// The width reserved for axis labels, in pixels.
const LEFT: f64 = 44.0;
/// The height of the top margin, in pixels.
const TOP: f64 = 10.0;
/// The height of the plotting area, in pixels.
const PLANE: f64 = 190.0;
/// The width reserved for each violin, in pixels.
const PLACE: f64 = 104.0;
/// The height reserved for the labels below the violins, in pixels.
const FOOT: f64 = 54.0;
/// Half the maximum width of a violin, in pixels.
const HALF: f64 = 46.0;
/// The number of points at which a violin's density is evaluated.
const POINTS: usize = 48;
/// The maximum number of values that are drawn as individual dots. Beyond that, a box from the lower to the upper
/// quartile is drawn instead.
const DOTS: usize = 30;

pub(crate) struct Violin<'a> {
    pub(crate) name: &'a str,
    /// The values in the distribution. Non-finite values are ignored.
    pub(crate) values: &'a [f64],
}

/// Draws violins, each with a line at the median, and with either dots for its values or a box from the lower to the
/// upper quartile. `label` describes the plot. The scale extends from `low` at the bottom to `high` at the top.
///
/// The densities are estimated with Gaussian kernels, using Silverman's bandwidth (Density Estimation, 1986,
/// equation 3.31). All violins have the same maximum width. Cost: O(values).
pub(crate) fn violins(label: &str, groups: &[Violin<'_>], [low, high]: [f64; 2]) -> String {
    let width = LEFT + groups.len() as f64 * PLACE + 8.0;
    let mut canvas = Canvas::new("violins", width, TOP + PLANE + FOOT, label);
    let up = |value: f64| TOP + PLANE * (1.0 - ((value - low) / (high - low)).clamp(0.0, 1.0));
    for part in [0.0, 0.5, 1.0] {
        let value = low + part * (high - low);
        canvas.lines(&[&[[LEFT, up(value)], [width - 8.0, up(value)]]], "rule");
        canvas.text(LEFT - 6.0, up(value) + 4.0, Anchor::End, "soft", &words::short(value));
    }
    for (at, Violin { name, values }) in groups.iter().enumerate() {
        let middle = LEFT + (at as f64 + 0.5) * PLACE;
        let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let foot = TOP + PLANE;
        canvas.text(middle, foot + 17.0, Anchor::Middle, "", name);
        if sorted.is_empty() {
            let place = [middle - HALF, TOP, 2.0 * HALF, PLANE];
            canvas.missing(place, &format!("{name}: no episodes"));
            canvas.text(middle, foot + 33.0, Anchor::Middle, "soft", "no episodes");
            continue;
        }
        let quartiles = [0.25, 0.5, 0.75].map(|part| at_share(&sorted, part));
        let (median, count) =
            (format!("median {}", words::short(quartiles[1])), format!("n = {}", sorted.len()));
        canvas.text(middle, foot + 33.0, Anchor::Middle, "soft", &median);
        canvas.text(middle, foot + 48.0, Anchor::Middle, "soft", &count);
        canvas.open(if at == 0 { "first" } else { "second" }, &format!("{name}: {median}, {count}"));
        canvas.area(&outline(&sorted, [low, high], middle, up), "body");
        if sorted.len() <= DOTS {
            sorted.iter().for_each(|&value| canvas.dot(middle, up(value), 2.2, "point"));
        } else {
            let [lower, _, upper] = quartiles.map(up);
            canvas.rect([middle - 4.0, upper, 8.0, (lower - upper).max(1.0)]);
        }
        canvas.lines(&[&[[middle - 12.0, up(quartiles[1])], [middle + 12.0, up(quartiles[1])]]], "median");
        canvas.close();
    }
    canvas.finish()
}

/// Returns a violin's outline, going up its right side and down its left side.
fn outline(sorted: &[f64], [low, high]: [f64; 2], middle: f64, up: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let (first, last) = (sorted[0], sorted[sorted.len() - 1]);
    let width = bandwidth(sorted).max((high - low) / 60.0);
    let (from, to) = ((first - width).max(low), (last + width).min(high));
    let value = |point: usize| from + (to - from) * point as f64 / (POINTS - 1) as f64;
    let density = |at: f64| -> f64 {
        sorted.iter().map(|one| (at - one) / width).map(|far| libm::exp(-0.5 * far * far)).sum()
    };
    let densities: Vec<f64> = (0..POINTS).map(|point| density(value(point))).collect();
    let most = densities.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let side = |sign: f64, point: usize| [middle + sign * HALF * densities[point] / most, up(value(point))];
    (0..POINTS)
        .map(|point| side(1.0, point))
        .chain((0..POINTS).rev().map(|point| side(-1.0, point)))
        .collect()
}

fn at_share(values: &[f64], share: f64) -> f64 {
    quantile(values, share).expect("there are values, and all are finite")
}

/// Returns the kernel bandwidth according to Silverman's rule of thumb, or 0 if all values are equal.
fn bandwidth(sorted: &[f64]) -> f64 {
    let count = sorted.len() as f64;
    let mean = sorted.iter().sum::<f64>() / count;
    let deviation = (sorted.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / count).sqrt();
    let spread = (at_share(sorted, 0.75) - at_share(sorted, 0.25)) / 1.34;
    let scale = if spread > 0.0 { deviation.min(spread) } else { deviation };
    0.9 * scale * libm::pow(count, -0.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(won: &[f64], lost: &[f64]) -> String {
        let groups = [Violin { name: "won", values: won }, Violin { name: "not won", values: lost }];
        violins("bump rate", &groups, [0.0, 1.0])
    }

    #[test]
    fn spreads_are_described_and_drawn() {
        let many: Vec<f64> = (0..200).map(|at| f64::from(at % 20) / 20.0).collect();
        let svg = drawn(&[0.2, 0.4, f64::NAN], &many);
        for part in ["median 0.30, n = 2", "median 0.47, n = 200", "class=\"first\"", "class=\"second\""] {
            assert!(svg.contains(part), "{part} in {svg}");
        }
        assert_eq!(svg.matches("class=\"point\"").count(), 2);
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let svg = drawn(&[], &[0.5; 3]);
        assert!(
            svg.contains("no episodes") && svg.contains("class=\"none\"") && !svg.contains("NaN"),
            "{svg}"
        );
    }

    #[test]
    fn a_violin_is_symmetric_and_stays_in_its_place() {
        let edge = outline(&[0.0, 0.1, 0.9], [0.0, 1.0], 100.0, |value| 1.0 - value);
        let (right, left) = edge.split_at(POINTS);
        for (one, other) in right.iter().zip(left.iter().rev()) {
            assert!((one[0] + other[0] - 200.0).abs() < 1e-9 && one[1] == other[1]);
            assert!((100.0..=100.0 + HALF).contains(&one[0]) && (0.0..=1.0).contains(&one[1]));
        }
    }
}
