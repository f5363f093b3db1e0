//! The comparison of two groups of games, line by line.

use super::row::{GameRow, NO_LEVEL, NO_WIN};
use base::Seed;
use report::{Table, TableCell};
use statistics::{bootstrap_difference, quantile};

/// The number of resamples per interval.
const RESAMPLES: usize = 4000;

/// A figure's unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unit {
    /// A fraction of games, from 0 to 1. A difference of 1 corresponds to 100 points.
    Share,
    /// A mean of values between 0 and 1. A difference of the whole range corresponds to 100 points.
    Scale,
    /// A mean of counts. A difference as large as the other group's mean corresponds to 100 points.
    Count,
}

/// A line of the comparison: its name, its unit, and a function that returns a game's value or the reason why the game
/// has none.
struct Question {
    name: &'static str,
    unit: Unit,
    of: fn(&GameRow) -> Result<f64, &'static str>,
}

/// The number of lines.
const LINES: usize = 7;

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

/// One group's figures in a line of the comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The mean, or the fraction; `None` if no game has a value.
    pub mean: Option<f64>,
    /// The median; `None` if no game has a value.
    pub median: Option<f64>,
    /// The number of games with a value.
    pub games: u64,
    /// The number of games without a value, by reason.
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

/// One line of the comparison: a measure of the games in both groups.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The name of the measure.
    pub name: &'static str,
    unit: Unit,
    /// The measure's values for the first group of games.
    pub ours: Group,
    /// The measure's values for the second group of games.
    pub theirs: Group,
    /// The mean of `ours` minus the mean of `theirs`; `None` unless both groups have a value.
    pub difference: Option<f64>,
    /// The 95% bootstrap interval of the difference, over the games of each group; `None` without a difference.
    pub interval: Option<[f64; 2]>,
    /// The difference in points: percent of all games, of the scale from 0 to 1, or of the other group's mean count.
    /// `None` without a difference, or if that mean count is 0.
    pub points: Option<f64>,
    /// `true` if `ours` is not significantly worse, which means that the upper end of the interval is not below 0.
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
            name: question.name,
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

impl Line {
    fn group(&self, group: &Group) -> TableCell {
        TableCell::figure(group.mean.map(|mean| {
            let mean = match self.unit {
                Unit::Share => format!("{:.0}%", 100.0 * mean),
                Unit::Scale => format!("{mean:.2}"),
                Unit::Count => format!("{mean:.1}"),
            };
            format!("{mean} of {}", group.games)
        }))
    }

    fn difference(&self) -> TableCell {
        let figure = |value: f64| match self.unit {
            Unit::Share => format!("{:+.0}", 100.0 * value),
            Unit::Scale => format!("{value:+.2}"),
            Unit::Count => format!("{value:+.1}"),
        };
        TableCell::figure(self.difference.zip(self.interval).map(|(difference, [low, high])| {
            format!("{} ({} to {})", figure(difference), figure(low), figure(high))
        }))
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A comparison of two groups of games, line by line.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The lines, in table order.
    pub lines: Vec<Line>,
}

impl Comparison {
    /// Compares two groups. The same rows and seed give the same figures.
    pub fn of(ours: &[GameRow], theirs: &[GameRow], seed: Seed) -> Comparison {
        let line = |(at, question)| Line::of(question, ours, theirs, seed.child("line", at));
        Comparison { lines: (0..).zip(&QUESTIONS).map(line).collect() }
    }

    /// Returns the comparison as a table, with a note on the omitted games.
    pub fn table(&self) -> Table {
        let level = self.lines.iter().filter(|line| line.level == Some(true)).count();
        let mut note = format!("Ours are at least equal to theirs on {level} of {} lines.", self.lines.len());
        for (side, of) in
            [("ours", (|line| &line.ours) as fn(&Line) -> &Group), ("theirs", |line| &line.theirs)]
        {
            for line in &self.lines {
                for (reason, count) in &of(line).left_out {
                    note += &format!(" {}, {side}: {count} left out, {reason}.", line.name);
                }
            }
        }
        let columns = ["Line", "Ours", "Theirs", "Difference (95%)", "Points", "At least equal"];
        let mut table = Table::new("side-by-side", "Side by side", &note, &columns);
        for line in &self.lines {
            let measure = if line.unit == Unit::Share { "share" } else { "mean" };
            let points = line.points.map(|points| format!("{points:+.0}"));
            let level = line.level.map(|level| if level { "yes" } else { "no" }.to_owned());
            table.push(vec![
                TableCell::text(format!("{} ({measure})", line.name)),
                line.group(&line.ours),
                line.group(&line.theirs),
                line.difference(),
                TableCell::figure(points),
                TableCell::figure(level),
            ]);
        }
        table
    }
}
