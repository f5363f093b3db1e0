//! What is found of a game.

use super::SurveyedGame;
use super::edge::{Edge, ladder_order};
use engine::Digest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use validators::{Criteria, Report, RulesShown, is_guard, used_rules};

/// The version of what a row holds.
pub(super) const FORM: u32 = 1;

/// Why a figure is missing: no win of any level was found.
pub const NO_WIN: &str = "no win found";
/// Why a figure is missing: there was no level to judge.
pub const NO_LEVEL: &str = "no level";

/// What is found of a game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameRow {
    /// What it is called.
    pub name: String,
    /// What decides the row; see [`GameSurvey::digest`](super::GameSurvey::digest).
    pub digest: Digest,
    /// Levels that were judged.
    pub levels: u64,
    /// Levels of which a win was found.
    pub won: u64,
    /// Interactions of the rules; those with the edge of the screen left out.
    pub rules: u64,
    /// Of those, how many some recorded episode executes.
    pub executed: u64,
    /// Types that are declared for sprites of their own.
    pub types: u64,
    /// Of those, how many were there or held in some recorded episode.
    pub there: u64,
    /// How much better the strongest player does than the best of those who do not look ahead.
    pub edge: Option<Edge>,
    /// The rank correlation of a player's place in the ladder with how it fares; see [`ladder_order`].
    pub order: Option<f64>,
    /// Different interactions that the wins execute, those with the edge of the screen left out: over the wins of all levels.
    pub mechanics: Option<u64>,
    /// How open the outcome is while the level is being won, in the mean over the levels that were; see `docs/side-by-side.md`.
    pub drama: Option<f64>,
    /// Forward-model calls of all searches and plays.
    pub calls: u64,
}

impl GameRow {
    /// Of a game whose levels were judged; `reports` are in their order.
    pub(super) fn of(
        surveyed: &SurveyedGame,
        reports: &[Report],
        shown: &RulesShown,
        drama: &[f64],
        criteria: &Criteria,
        digest: Digest,
    ) -> GameRow {
        let SurveyedGame { name, game, levels } = surveyed;
        let wins =
            levels.iter().zip(reports).filter_map(|(level, report)| Some((level, report.witness.as_ref()?)));
        let used: BTreeSet<usize> = wins
            .flat_map(|(level, witness)| used_rules(game, level, witness))
            .filter(|&line| !is_guard(game, line))
            .collect();
        let won = reports.iter().filter(|report| report.witness.is_some()).count() as u64;
        let [executed, idle, there, absent] =
            [shown.executed.len(), shown.idle.len(), shown.there.len(), shown.absent.len()]
                .map(|count| count as u64);
        GameRow {
            name: name.clone(),
            digest,
            levels: levels.len() as u64,
            won,
            rules: executed + idle,
            executed,
            types: there + absent,
            there,
            edge: Edge::of(game, reports, criteria),
            order: ladder_order(reports),
            drama: statistics::Summary::of(drama).map(|summary| summary.mean),
            mechanics: (won > 0).then_some(used.len() as u64),
            calls: reports.iter().map(calls).sum(),
        }
    }
}

/// Forward-model calls of a level's judges.
fn calls(report: &Report) -> u64 {
    let findings = || report.judgements.iter().map(|judgement| &judgement.finding);
    let searched: u64 = findings().map(|found| found.searched.unwrap_or(0)).sum();
    let measured: u64 = findings().filter_map(|found| found.measured.as_ref()).map(|rate| rate.calls).sum();
    let ladder: u64 = report
        .ladder()
        .map_or(0, |ladder| ladder.rungs.iter().chain(&ladder.held_out).map(|fared| fared.rate.calls).sum());
    searched + measured + ladder
}
