//! Two groups of games, line by line.

use super::row::{GameRow, NO_LEVEL, NO_WIN};
use engine::Seed;
use serde::{Deserialize, Serialize};
use statistics::{bootstrap_difference, quantile};

/// Resamples of an interval.
const RESAMPLES: usize = 4000;

/// How a figure is to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// A share of games, from 0 to 1: 100 points are all of them.
    Share,
    /// A mean of values with a natural scale of length 1: 100 points are 1.
    Scale,
    /// A mean of counts: 100 points are as many as the others have in the mean.
    Count,
}

/// A line of the comparison: what it is called, how it is read, and its value for a game, or why it has none.
struct Question {
    name: &'static str,
    unit: Unit,
    of: fn(&GameRow) -> Result<f64, &'static str>,
}

/// How many lines there are.
pub const LINES: usize = 7;

const QUESTIONS: [Question; LINES] = [
    Question {
        name: "skill pays",
        unit: Unit::Share,
        of: |row| row.edge.as_ref().map(|edge| yes(edge.pays)).ok_or(NO_LEVEL),
    },
    Question { name: "all rules used", unit: Unit::Share, of: |row| Ok(yes(row.executed == row.rules)) },
    Question { name: "no dead sprites", unit: Unit::Share, of: |row| Ok(yes(row.there == row.types)) },
    Question { name: "rules", unit: Unit::Count, of: |row| Ok(row.rules as f64) },
    Question { name: "ladder in order", unit: Unit::Scale, of: |row| row.order.ok_or(NO_LEVEL) },
    Question {
        name: "mechanics in winning play",
        unit: Unit::Count,
        of: |row| row.mechanics.map(|count| count as f64).ok_or(NO_WIN),
    },
    Question { name: "drama", unit: Unit::Scale, of: |row| row.drama.ok_or(NO_WIN) },
];

fn yes(answer: bool) -> f64 {
    f64::from(u8::from(answer))
}

/// A group of games in one line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// The mean, or the share; none of no games.
    pub mean: Option<f64>,
    /// The middle value; none of no games.
    pub median: Option<f64>,
    /// Games with a value.
    pub games: u64,
    /// Games without one, and why.
    pub left_out: Vec<(String, u64)>,
}

impl Group {
    fn of(values: &[f64], rows: &[GameRow], question: &Question) -> Group {
        let mut left_out: Vec<(String, u64)> = Vec::new();
        for reason in rows.iter().filter_map(|row| (question.of)(row).err()) {
            match left_out.iter_mut().find(|(known, _)| known == reason) {
                Some((_, count)) => *count += 1,
                None => left_out.push((reason.to_owned(), 1)),
            }
        }
        let mean = (!values.is_empty()).then(|| mean(values));
        Group { mean, median: quantile(values, 0.5), games: values.len() as u64, left_out }
    }
}

/// A line of the comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// What it is about.
    pub name: String,
    /// How its figures are to be read.
    pub unit: Unit,
    /// The one group.
    pub ours: Group,
    /// The other.
    pub theirs: Group,
    /// Ours minus theirs; none unless both have a figure.
    pub difference: Option<f64>,
    /// Its interval, 95 %: of the means of games drawn anew from each group.
    pub interval: Option<[f64; 2]>,
    /// The difference in points; see [`Unit`].
    pub points: Option<f64>,
    /// Whether the interval includes or exceeds 0: whether ours are at least level.
    pub level: Option<bool>,
}

impl Line {
    fn of(question: &Question, ours: &[GameRow], theirs: &[GameRow], seed: Seed) -> Line {
        let values = |rows: &[GameRow]| -> Vec<f64> {
            rows.iter().filter_map(|row| (question.of)(row).ok()).collect()
        };
        let (a, b) = (values(ours), values(theirs));
        let difference = (!a.is_empty() && !b.is_empty()).then(|| mean(&a) - mean(&b));
        let interval = bootstrap_difference(&a, &b, RESAMPLES, 0.95, *seed.as_bytes());
        let scale = match question.unit {
            Unit::Share | Unit::Scale => 1.0,
            Unit::Count => mean(&b),
        };
        Line {
            name: question.name.to_owned(),
            unit: question.unit,
            ours: Group::of(&a, ours, question),
            theirs: Group::of(&b, theirs, question),
            difference,
            interval: interval.map(|interval| [interval.low, interval.high]),
            points: difference.filter(|_| scale > 0.0).map(|difference| 100.0 * difference / scale),
            level: interval.map(|interval| interval.high >= 0.0),
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Two groups of games, line by line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    /// In the order of telling; [`LINES`] of them.
    pub lines: Vec<Line>,
}

impl Comparison {
    /// Compares two groups. The same rows and seed give the same figures.
    pub fn of(ours: &[GameRow], theirs: &[GameRow], seed: Seed) -> Comparison {
        let line = |(at, question)| Line::of(question, ours, theirs, seed.child("line", at));
        Comparison { lines: (0..).zip(&QUESTIONS).map(line).collect() }
    }

    /// On how many lines ours are at least level.
    pub fn level(&self) -> usize {
        self.lines.iter().filter(|line| line.level == Some(true)).count()
    }
}
