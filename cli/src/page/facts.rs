//! Figures on a page: the answers to a question, each with its interval.

use super::words;
use report::{Quantiles, Share};
use serde::Serialize;

/// A question with its answers.
#[derive(Serialize)]
pub(crate) struct Section {
    pub(crate) title: &'static str,
    pub(crate) note: String,
    pub(crate) facts: Vec<Fact>,
    pub(crate) quantiles: Vec<Five>,
    pub(crate) fits: Vec<Beside>,
}

/// A figure.
#[derive(Serialize)]
pub(crate) struct Fact {
    name: String,
    value: String,
    /// An SVG; empty if there is nothing to draw.
    bar: String,
    /// Its interval.
    band: String,
    /// The number of cases.
    of: String,
}

/// The quantiles of a measure.
#[derive(Serialize)]
pub(crate) struct Five {
    name: String,
    five: [String; 5],
    count: u64,
}

/// The range of a measure, here and in the game's own levels.
#[derive(Serialize)]
pub(crate) struct Beside {
    pub(crate) measure: String,
    pub(crate) levels: String,
    pub(crate) examples: String,
    pub(crate) within: String,
    pub(crate) of: String,
}

impl Fact {
    /// A share, such as the share of levels won.
    pub(crate) fn share(name: impl Into<String>, share: &Share) -> Fact {
        let bar = if share.of == 0 { String::new() } else { bar(share.share(), share.interval) };
        let (value, band, of) = (words::percent(share), words::band(share), words::counted(share));
        Fact { name: name.into(), value, bar, band, of }
    }

    /// A value without an interval.
    pub(crate) fn plain(name: impl Into<String>, value: String) -> Fact {
        Fact { name: name.into(), value, bar: String::new(), band: String::new(), of: String::new() }
    }

    /// A mean that may be negative.
    pub(crate) fn signed(name: impl Into<String>, mean: f64, interval: [f64; 2]) -> Fact {
        Fact { band: words::signed_band(interval), ..Fact::plain(name, words::signed(mean)) }
    }

    /// A mean from 0 to 1.
    pub(crate) fn mean(name: impl Into<String>, mean: f64, interval: [f64; 2]) -> Fact {
        let bar = bar(mean, interval);
        Fact { bar, band: words::mean_band(interval), ..Fact::plain(name, words::mean(mean)) }
    }

    /// Sets the number of cases.
    #[must_use]
    pub(crate) fn of(self, of: String) -> Fact {
        Fact { of, ..self }
    }

    /// Sets its interval.
    #[must_use]
    pub(crate) fn within(self, band: String) -> Fact {
        Fact { band, ..self }
    }
}

/// Quantiles in a line; none if there are no values.
pub(crate) fn five(name: impl Into<String>, quantiles: Option<&Quantiles>) -> Option<Five> {
    let found = quantiles?;
    Some(Five { name: name.into(), five: words::five(found), count: found.count })
}

/// A question whose answers are only figures.
pub(crate) fn section(title: &'static str, note: impl Into<String>, facts: Vec<Fact>) -> Section {
    Section { title, note: note.into(), facts, quantiles: Vec::new(), fits: Vec::new() }
}

/// A share from 0 to 1 as a bar, with its interval as a line.
fn bar(share: f64, [low, high]: [f64; 2]) -> String {
    const LENGTH: f64 = 90.0;
    let at = |share: f64| number(LENGTH * share.clamp(0.0, 1.0));
    let (end, low, high) = (at(share), at(low), at(high));
    format!(
        "<svg class=\"bar\" width=\"{LENGTH}\" height=\"12\" viewBox=\"0 0 {LENGTH} 12\" aria-hidden=\"true\">\
         <rect width=\"{LENGTH}\" height=\"12\" class=\"track\"/><rect width=\"{end}\" height=\"12\" class=\"fill\"/>\
         <path d=\"M{low} 6H{high}M{low} 3V9M{high} 3V9\" class=\"whisker\"/></svg>"
    )
}

/// Formats a number with one decimal, in pixels.
pub(crate) fn number(value: f64) -> String {
    let tenths = (value * 10.0).round() as i64;
    if tenths % 10 == 0 { format!("{}", tenths / 10) } else { format!("{:.1}", tenths as f64 / 10.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_stay_within_their_track() {
        let text = bar(0.5, [-0.1, 1.2]);
        assert!(text.contains("<rect width=\"45\"") && text.contains("M0 6H90"), "{text}");
    }
}
