//! The machine-readable answer. The schema is in `docs/reference/validate.md`.

use crate::failure::Placed;
use base::Digest;
use engine::Episode;
use forge::review::{Review, ReviewedLevel};
use serde::Serialize;
use validators::{Criteria, Judgement, Report};

#[derive(Default, Serialize)]
pub(super) struct Document<'a> {
    pub(super) game: String,
    pub(super) digest: Option<Digest>,
    pub(super) passes: bool,
    pub(super) seed: Option<&'a str>,
    pub(super) criteria: Option<&'a Criteria>,
    pub(super) problems: Vec<Placed>,
    pub(super) levels: Vec<LevelDocument<'a>>,
    /// The judgements on the game across all its levels.
    pub(super) judgements: &'a [Judgement],
}

#[derive(Default, Serialize)]
pub(super) struct LevelDocument<'a> {
    pub(super) level: String,
    pub(super) digest: Option<Digest>,
    pub(super) passes: bool,
    pub(super) problems: Vec<Placed>,
    /// The level's characters, from top to bottom.
    pub(super) board: Vec<String>,
    /// The winning terminations that can never apply in the level, each with the reason.
    pub(super) out_of_reach: Vec<String>,
    #[serde(flatten)]
    pub(super) report: Option<&'a Report>,
    pub(super) witness: Option<&'a Episode>,
}

impl Document<'_> {
    /// Returns the parts of the document that the human-readable answer contains.
    pub(super) fn review<'a>(&'a self, warnings: &'a [String]) -> Review<'a> {
        let level = |level: &'a LevelDocument<'_>| ReviewedLevel {
            name: &level.level,
            passes: level.passes,
            board: &level.board,
            report: level.report,
        };
        Review {
            source: &self.game,
            passes: self.passes,
            levels: self.levels.iter().map(level).collect(),
            judgements: self.judgements,
            warnings,
        }
    }
}
