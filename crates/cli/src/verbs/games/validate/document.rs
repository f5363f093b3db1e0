//! The machine-readable answer. The schema is in `docs/reference/validate.md`.

use crate::diagnostics::Named;
use crate::failure::Placed;
use base::Digest;
use engine::{Episode, line_and_column};
use serde::Serialize;
use validators::{Criteria, Finding, Judgement, Report};

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

/// Fills in the line numbers of the rules in the evidence.
pub(super) fn locate(finding: &mut Finding, source: &Named) {
    for rule in finding.evidence.iter_mut().filter_map(|seen| seen.rule.as_mut()) {
        rule.line = Some(line_and_column(&source.text, rule.span.start).0);
    }
}
