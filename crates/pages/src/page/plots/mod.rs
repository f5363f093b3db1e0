//! SVG plots inside a page. Plots are pure functions of plain numbers, so the same numbers give identical
//! bytes.
//!
//! Colours are classes with a light and a dark variant in `plots.css`. `q0` to `q10` form a sequential scale of a
//! single hue. Its steps differ only in lightness, so the scale is readable with every kind of colour vision. `d0` to
//! `d10` form a diverging scale from blue through neutral to orange, for values that may be negative. Every value is
//! also written as text. Missing values are grey and hatched, and never use a colour from a scale.

mod bars;
mod canvas;
mod curves;
mod forest;
mod heat_map;
mod matrix;
mod months;
mod range;
mod violin;

pub(crate) use bars::{BarRow, bars};
pub(crate) use curves::{CurvePoint, curve};
pub(crate) use forest::{ForestRow, forest};
pub(crate) use heat_map::{HeatMap, group_width, heat_map};
pub(crate) use matrix::matrix;
pub(crate) use months::{MonthPlot, MonthPoint, MonthSeries, over_months};
pub(crate) use range::range;
pub(crate) use violin::{Violin, violins};

/// A row label in a plot. The label has two lines, and the second line may be empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Label {
    pub(crate) name: String,
    /// A note that distinguishes the row from other rows with the same name.
    pub(crate) note: String,
}

/// Returns the step of a value on a scale from 0 to 10. Values up to `low` are at step 0, and values from
/// `high` upwards are at step 10.
fn step(value: f64, low: f64, high: f64) -> usize {
    let part = if high > low { (value - low) / (high - low) } else { 0.5 };
    (part.clamp(0.0, 1.0) * 10.0).round() as usize
}

/// Shortens a text to at most `letters` characters by omitting its middle. The middle is omitted because
/// model names usually differ in their first or last characters.
fn shortened(text: &str, letters: usize) -> String {
    let all: Vec<char> = text.chars().collect();
    if all.len() <= letters {
        return text.to_owned();
    }
    let (head, tail) = (letters / 2, letters - letters / 2 - 1);
    let part = |letters: &[char]| letters.iter().collect::<String>();
    format!("{}…{}", part(&all[..head]), part(&all[all.len() - tail..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_stay_on_the_scale() {
        let check = |value: f64, expect: usize| assert_eq!(step(value, 0.0, 2.0), expect);
        check(-1.0, 0);
        check(0.0, 0);
        check(1.0, 5);
        check(2.0, 10);
        check(7.0, 10);
        assert_eq!(step(3.0, 3.0, 3.0), 5, "a scale without length");
    }

    #[test]
    fn long_names_keep_both_ends() {
        assert_eq!(shortened("random", 8), "random");
        assert_eq!(shortened("large-model-thinking", 9), "larg…king");
    }
}
