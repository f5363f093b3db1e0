//! Expressive range: the distribution of levels over pairs of measures (G. Smith and J. Whitehead, "Analyzing the
//! Expressive Range of a Level Generator", 2010).

use crate::survey::SurveyedLevel;
use serde::Serialize;

/// The pairs of measures to plot, as (x, y). The pairs were chosen before any level was generated.
const PAIRS: [(&str, &str); 6] = [
    ("openness", "ticks"),
    ("cover", "pressure"),
    ("ticks", "branching"),
    ("ticks", "pushes"),
    ("mechanics", "skill"),
    ("goal things", "enemy pressure"),
];

/// The number of cells per axis.
pub const BINS: usize = 10;

/// The positions of a set's levels along a pair of measures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Range {
    /// The measure on the horizontal axis.
    pub x: Axis,
    /// The measure on the vertical axis.
    pub y: Axis,
    /// The (x, y) values of the levels that have both measures.
    pub levels: Vec<[f64; 2]>,
    /// The (x, y) values of the game's own levels, as far as they have both measures.
    pub examples: Vec<[f64; 2]>,
    /// The number of levels in each cell, as [`BINS`] rows from bottom to top with [`BINS`] cells each.
    pub cells: Vec<Vec<u64>>,
    /// The number of cells with at least one level.
    pub occupied: u64,
}

/// A measure, and its displayed range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// The measure's name.
    pub measure: String,
    /// The lower end of the range.
    pub low: f64,
    /// The upper end of the range.
    pub high: f64,
}

impl Axis {
    /// Chooses the range of an axis. Fractions range from 0 to 1, or from −1 if a difference is negative. Counts range
    /// from 0 to a round number that no value exceeds.
    fn of(measure: &str, values: impl Iterator<Item = f64>) -> Axis {
        let (least, greatest) = values
            .fold((0.0, 0.0), |(least, greatest): (f64, f64), value| (least.min(value), greatest.max(value)));
        let high =
            if greatest <= 1.0 && !["ticks", "pushes"].contains(&measure) { 1.0 } else { above(greatest) };
        Axis { measure: measure.to_owned(), low: if least < 0.0 { -1.0 } else { 0.0 }, high }
    }

    /// Returns the cell of a value.
    fn bin(&self, value: f64) -> usize {
        let share = (value - self.low) / (self.high - self.low);
        ((share * BINS as f64).max(0.0) as usize).min(BINS - 1)
    }
}

/// Returns the smallest number of the series 10, 20, 50, 100, … that is not less than a value.
fn above(value: f64) -> f64 {
    let mut ten = 10.0;
    while ten * 10.0 <= value {
        ten *= 10.0;
    }
    [1.0, 2.0, 5.0, 10.0]
        .map(|times| times * ten)
        .into_iter()
        .find(|round| *round >= value)
        .unwrap_or(ten * 10.0)
}

impl Range {
    /// Returns the pairs of [`PAIRS`] for which the levels have both measures and not all values are 0.
    pub(super) fn all(levels: &[SurveyedLevel], examples: &[SurveyedLevel]) -> Vec<Range> {
        PAIRS.iter().filter_map(|&(x, y)| Range::of(x, y, levels, examples)).collect()
    }

    fn of(x: &str, y: &str, levels: &[SurveyedLevel], examples: &[SurveyedLevel]) -> Option<Range> {
        let points = |of: &[SurveyedLevel]| -> Vec<[f64; 2]> {
            of.iter().filter_map(|level| Some([level.measure(x)?, level.measure(y)?])).collect()
        };
        let (levels, examples) = (points(levels), points(examples));
        let all = || levels.iter().chain(&examples);
        if levels.is_empty() || all().all(|point| point[1] == 0.0 && y == "pushes") {
            return None;
        }
        let (x, y) = (Axis::of(x, all().map(|point| point[0])), Axis::of(y, all().map(|point| point[1])));
        let mut cells = vec![vec![0; BINS]; BINS];
        for [across, up] in &levels {
            cells[y.bin(*up)][x.bin(*across)] += 1;
        }
        let occupied = cells.iter().flatten().filter(|count| **count > 0).count() as u64;
        Some(Range { x, y, levels, examples, cells, occupied })
    }
}
