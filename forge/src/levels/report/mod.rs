//! The one report of every level generator: what the levels of a set are like, each and together.
//!
//! A pure function of what was judged: the same levels and verdicts give the same bytes. No clock and no path is in it. What
//! each figure means, with its formula and source, is in `docs/generate-levels.md`.

mod control;
mod likeness;
mod play;
mod range;
mod row;
mod survey;

pub use control::{Control, Hits};
pub use likeness::{Diversity, NEAR, Novelty};
pub use play::{Fit, Lengths, LineUse, PlayerRate, Rules, Skill, Solvability, Triviality, Validity};
pub use range::{Axis, BINS, PAIRS, Range};
pub use report::{Estimate, Quantiles, Share};
pub use row::{LevelRow, OF_PLAY};
pub use survey::Survey;

use super::make::Cost;
use engine::{Analysis, Digest, Level};
use generators::levels::LevelSimilarity;
use report::canonical::{CanonicalError, to_canonical_json};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::{Difficulty, Ladder, Measures, Report};

/// The version of the report's form.
pub const REPORT_FORMAT: u32 = 1;

/// A level and all that is known of it; see [`Survey`].
#[derive(Clone, Debug)]
pub struct Judged {
    /// The level.
    pub level: Level,
    /// What the judges found.
    pub report: Report,
    /// How a ladder of players fared on it, and how hard that makes it; with seeds that no search was guided by.
    pub ladder: Option<Ladder>,
    /// What its witness is like; none without a witness.
    pub measures: Option<Measures>,
    /// Measures of the grid alone, by name (`openness`, `cover`), each from 0 to 1; the same names for all levels.
    pub layout: Vec<(String, f64)>,
    /// The difficulty that was asked for.
    pub asked: Option<Difficulty>,
}

impl Judged {
    /// The difficulty that was measured.
    pub fn label(&self) -> Option<Difficulty> {
        self.ladder.as_ref().map(|ladder| ladder.difficulty)
    }

    /// A measure by name: `ticks`, `pushes`, `branching`, `mechanics`, `pressure`, `skill`, or one of the layout.
    fn measure(&self, name: &str) -> Option<f64> {
        let play = self.measures.as_ref().and_then(|measures| match name {
            "ticks" => Some(measures.ticks as f64),
            "pushes" => Some(measures.pushes as f64),
            "branching" => Some(measures.branching),
            "mechanics" => Some(measures.mechanics),
            "pressure" => Some(measures.pressure),
            "skill" => measures.skill.map(|skill| skill.wins),
            _ => None,
        });
        play.or_else(|| self.layout.iter().find(|(known, _)| known == name).map(|(_, value)| *value))
    }
}

/// What making the levels cost. Time is no part of it: it differs from run to run. Nor is judging them for the report.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expense {
    /// Forward-model calls of all that looked and judged, on what was turned down too.
    pub calls: u64,
    /// Candidates that a search looked at.
    pub looks: u64,
    /// Candidates that came before the panel.
    pub judged: u64,
    /// Levels that were accepted.
    pub accepted: u64,
    /// How often each criterion of the panel, or the generator, said no.
    pub rejections: BTreeMap<String, u64>,
}

impl Expense {
    /// What so many accepted levels cost.
    pub fn of(cost: &Cost, accepted: usize) -> Expense {
        let Cost { looks, judged, calls, rejections } = cost.clone();
        Expense { calls, looks, judged, accepted: accepted as u64, rejections }
    }
}

/// What a report is made from.
#[derive(Clone, Copy)]
pub struct Sample<'a> {
    /// The game, and what its rules mean.
    pub analysis: &'a Analysis,
    /// Who made the levels: `constructive`, `search`, `evolutionary`.
    pub method: &'a str,
    /// The levels, in the order of their making.
    pub levels: &'a [Judged],
    /// The game's own levels, for comparison; empty if it has none.
    pub examples: &'a [Judged],
    /// The labels of levels that were made with no difficulty asked for: what picking at random would give.
    pub pool: &'a [Difficulty],
    /// What it cost.
    pub cost: &'a Expense,
}

/// What the levels of a set are like. Intervals of shares are Wilson's, those of means are bootstrapped over levels; both 95 %.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelSetReport {
    /// [`REPORT_FORMAT`].
    pub format: u32,
    /// [`engine::SEMANTICS`].
    pub semantics: u32,
    /// [`generators::GENERATION`].
    pub generation: u32,
    /// The digest of the game's rules.
    pub game: Digest,
    /// Who made the levels.
    pub method: String,
    /// How many levels.
    pub count: u64,
    /// How many of the game's own levels they are compared with.
    pub examples: u64,
    /// Are they levels at all?
    pub validity: Validity,
    /// Can they be won?
    pub solvability: Solvability,
    /// Are they won for nothing?
    pub triviality: Triviality,
    /// How long is a win?
    pub lengths: Lengths,
    /// Does looking ahead pay? None if no ladder played.
    pub skill: Option<Skill>,
    /// What of the rules do they use?
    pub rules: Rules,
    /// How different are they from each other?
    pub diversity: Diversity,
    /// And from the game's own levels? None if it has none.
    pub novelty: Option<Novelty>,
    /// Are they as hard as was asked for? None if nothing was asked, or no ladder played.
    pub control: Option<Control>,
    /// What lies where, in pairs of measures.
    pub ranges: Vec<Range>,
    /// What it cost.
    pub cost: Expense,
    /// A row for each level.
    pub levels: Vec<LevelRow>,
}

impl LevelSetReport {
    /// The report on a set. Cost: a comparison for each pair of levels, on all threads; the rest is summing up.
    pub fn of(sample: &Sample<'_>) -> LevelSetReport {
        let Sample { analysis, method, levels, examples, pool, cost } = *sample;
        let (game, likeness) = (analysis.game(), LevelSimilarity::of(analysis));
        let (diversity, nearest) = Diversity::of(levels, &likeness);
        LevelSetReport {
            format: REPORT_FORMAT,
            semantics: engine::SEMANTICS,
            generation: generators::GENERATION,
            game: game.digest(),
            method: method.to_owned(),
            count: levels.len() as u64,
            examples: examples.len() as u64,
            validity: Validity::of(levels, examples),
            solvability: Solvability::of(levels),
            triviality: Triviality::of(levels),
            lengths: Lengths::of(levels),
            skill: Skill::of(levels),
            rules: Rules::of(game, levels),
            diversity,
            novelty: Novelty::of(levels, examples, &likeness),
            control: Control::of(levels, pool),
            ranges: Range::all(levels, examples),
            cost: cost.clone(),
            levels: levels
                .iter()
                .zip(nearest)
                .map(|(judged, nearest)| LevelRow::of(judged, nearest))
                .collect(),
        }
    }

    /// Its canonical JSON, with a line feed at the end.
    ///
    /// # Errors
    /// A number is not finite: a measure that the caller gave.
    pub fn to_json(&self) -> Result<String, CanonicalError> {
        to_canonical_json(self)
    }
}

#[cfg(test)]
mod tests;
