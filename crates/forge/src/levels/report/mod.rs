//! The report on a set of levels, covering each level and the set as a whole. It has the same form for every generator.
//!
//! The report is a pure function of the levels and their verdicts, so the same input produces the same bytes. The
//! report contains no times or paths. For the meaning of each value, with its formula and source, see
//! `docs/how-to/generate-levels.md`.

mod control;
mod likeness;
mod play;
mod range;
mod row;

pub(crate) use likeness::NEAR;
pub use play::Fit;
pub use range::{Axis, BINS, Range};
pub use row::LevelRow;

use crate::survey::SurveyedLevel;
use crate::tally::Tally;
use engine::Analysis;
use generators::levels::LevelSimilarity;
use likeness::Distances;
use report::{Section, SetReport, Value};
use validators::Difficulty;

/// The version of the report's format.
pub const REPORT_FORMAT: u32 = 1;

/// The input for a report.
#[derive(Clone, Copy)]
pub struct Sample<'a> {
    /// The game, with an analysis of its rules.
    pub analysis: &'a Analysis,
    /// The method that generated the levels: `constructive`, `search` or `evolutionary`.
    pub method: &'a str,
    /// The levels, in the order of generation.
    pub levels: &'a [SurveyedLevel],
    /// The game's own levels, for comparison; empty if the game has no levels of its own.
    pub examples: &'a [SurveyedLevel],
    /// The labels of levels generated without a requested difficulty. They serve as the baseline for picking levels at
    /// random.
    pub pool: &'a [Difficulty],
    /// The cost of generating the levels, without the cost of judging them for the report.
    pub cost: &'a Tally,
}

/// The report on a set of levels. Intervals are 95% Wilson intervals for fractions, and 95% bootstrap intervals over
/// levels for means.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSetReport {
    /// The figures for the whole set.
    pub set: SetReport,
    /// The measures compared with those of the game's own levels; empty if the game has no levels of its own.
    pub fits: Vec<Fit>,
    /// The distributions of the levels over pairs of measures.
    pub ranges: Vec<Range>,
    /// One row per level.
    pub levels: Vec<LevelRow>,
}

impl LevelSetReport {
    /// Creates the report on a set, using all threads. Cost: one comparison per pair of levels. All other costs are
    /// small.
    pub fn of(sample: &Sample<'_>) -> LevelSetReport {
        let Sample { analysis, method, levels, examples, pool, cost } = *sample;
        let (game, likeness) = (analysis.game(), LevelSimilarity::of(analysis));
        let distances = Distances::of(levels, &likeness);
        let nearest = distances.nearest.iter();
        let rows: Vec<LevelRow> =
            levels.iter().zip(nearest).map(|(level, nearest)| LevelRow::of(level, *nearest)).collect();
        let fits = play::fits(levels, examples);
        let ranges = Range::all(levels, examples);
        let (control, asked) = control::control(levels, pool).unzip();
        let set = SetReport::default()
            .data("format", &REPORT_FORMAT)
            .data("semantics", &engine::SEMANTICS)
            .data("generation", &generators::GENERATION)
            .data("game", &game.digest())
            .data("method", method)
            .data("count", &levels.len())
            .data("examples", &examples.len())
            .data("ranges", &ranges)
            .data("levels", &rows)
            .section("validity", play::validity(levels, &fits))
            .section("solvability", play::solvability(levels))
            .section("triviality", play::triviality(levels))
            .section("lengths", play::lengths(levels))
            .section("skill", play::skill(levels))
            .section("rules", play::rules(game, levels))
            .section("diversity", likeness::diversity(levels, &distances, &likeness))
            .section("novelty", likeness::novelty(levels, examples, &likeness))
            .section("control", control)
            .section("cost", price(cost, levels.len() as u64))
            .table(asked)
            .table(row::table(&rows))
            .headlines(&[
                ("solvability", "solved", "solved"),
                ("triviality", "both_levels", "not won without effort"),
                ("diversity", "unique", "unique"),
                ("lengths", "ticks", "ticks to a win, median"),
                ("lengths", "pushes", "pushes, median"),
                ("skill", "wins", "gain from looking ahead"),
                ("control", "exact", "as hard as requested"),
            ]);
        LevelSetReport { set, fits, ranges, levels: rows }
    }
}

fn price(cost: &Tally, accepted: u64) -> Section {
    Section::new("cost", "What was the cost?", "The cost of judging for this report is not included.")
        .count("calls", "forward-model calls", cost.calls)
        .count("looks", "candidates inspected by a search", cost.looks())
        .count("judged", "candidates before the panel", cost.levels_tried)
        .count("accepted", "accepted", accepted)
        .shown(
            "calls per accepted item",
            cost.calls.checked_div(accepted).map_or(Value::Missing, Value::Count),
        )
        .tally("rejections", "rejected", &cost.rejections, None)
}

#[cfg(test)]
mod tests;
