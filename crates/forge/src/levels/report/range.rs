//! Expressive range: the places of levels in pairs of measures (G. Smith and J. Whitehead, "Analyzing the Expressive Range of
//! a Level Generator", 2010).

use crate::survey::SurveyedLevel;
use serde::Serialize;

/// The pairs of measures that are told, chosen before any level was made: across and up.
const PAIRS: [(&str, &str); 6] = [
    ("openness", "ticks"),
    ("cover", "pressure"),
    ("ticks", "branching"),
    ("ticks", "pushes"),
    ("mechanics", "skill"),
    ("goal things", "enemy pressure"),
];

/// Cells of an axis.
pub const BINS: usize = 10;

/// The levels of a set in a pair of measures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Range {
    /// Across.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// The levels that have both measures: across and up.
    pub levels: Vec<[f64; 2]>,
    /// The game's own levels that have both.
    pub examples: Vec<[f64; 2]>,
    /// The number of levels in each cell: [`BINS`] rows from the bottom, of [`BINS`] cells.
    pub cells: Vec<Vec<u64>>,
    /// Cells with a level.
    pub occupied: u64,
}

/// A measure, and the part of it that is shown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// Its name.
    pub measure: String,
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

impl Axis {
    /// Shares go from 0 to 1 (differences of them from −1, if one is negative), counts from 0 to a round number that no value is
    /// above.
    fn of(measure: &str, values: impl Iterator<Item = f64>) -> Axis {
        let (least, greatest) = values
            .fold((0.0, 0.0), |(least, greatest): (f64, f64), value| (least.min(value), greatest.max(value)));
        let high =
            if greatest <= 1.0 && !["ticks", "pushes"].contains(&measure) { 1.0 } else { above(greatest) };
        Axis { measure: measure.to_owned(), low: if least < 0.0 { -1.0 } else { 0.0 }, high }
    }

    /// The cell of a value.
    fn bin(&self, value: f64) -> usize {
        let share = (value - self.low) / (self.high - self.low);
        ((share * BINS as f64).max(0.0) as usize).min(BINS - 1)
    }
}

/// The least of 10, 20, 50, 100, … that is not below a value.
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
    /// The pairs of [`PAIRS`] that the levels have, and that are not all 0.
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
