//! What is found of a game.

use super::SurveyedGame;
use super::edge::{Edge, ladder_order};
use engine::{Analysis, Digest, Episode, Outcome, Seed};
use serde::{Deserialize, Serialize};
use validators::game_measures::Guards;
use validators::{Criteria, PlayMeasures, Recorded, Report, RulesShown};

/// The version of what a row holds.
pub(super) const FORM: u32 = 3;

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
    /// Interactions of the rules, guards ([`Guards`]) apart.
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
    /// Different interactions, guards apart, that wins execute: over all wins ([`PlayMeasures::mechanics`]).
    pub mechanics: Option<u64>,
    /// How desperate the game is on the way to a win ([`PlayMeasures::drama`]).
    pub drama: Option<f64>,
    /// Forward-model calls of all searches and plays.
    pub calls: u64,
}

impl GameRow {
    /// Of a game of which all levels were judged, by criteria that ask for `winnable` and `skill`; `reports` are in the order of
    /// its levels. Cost: the recorded episodes are played again three times, and that of [`PlayMeasures::of`].
    pub fn of(
        surveyed: &SurveyedGame,
        reports: &[Report],
        criteria: &Criteria,
        digest: Digest,
        seed: Seed,
    ) -> GameRow {
        let SurveyedGame { name, game, levels } = surveyed;
        let analysis = Analysis::of(game);
        let guards: Vec<usize> = Guards::of(&analysis).lines().collect();
        let inner = |lines: &[usize]| lines.iter().filter(|line| !guards.contains(line)).count() as u64;
        let shown = RulesShown::of(game, levels, reports, seed.child("rules", 0));
        let (executed, idle) = (inner(&shown.executed), inner(&shown.idle));
        let (there, absent) = (shown.there.len() as u64, shown.absent.len() as u64);
        let wins: Vec<Vec<Episode>> = reports.iter().map(wins).collect();
        let recording: Vec<Recorded<'_>> = levels
            .iter()
            .zip(&wins)
            .filter(|(_, wins)| !wins.is_empty())
            .map(|(level, wins)| Recorded { level, episodes: wins })
            .collect();
        let judgements = || reports.iter().flat_map(|report| &report.judgements);
        let play = PlayMeasures::of(&analysis, &recording, seed.child("play", 0));
        GameRow {
            name: name.clone(),
            digest,
            levels: levels.len() as u64,
            won: recording.len() as u64,
            rules: executed + idle,
            executed,
            types: there + absent,
            there,
            edge: Edge::of(game, reports, criteria),
            order: ladder_order(reports),
            drama: play.as_ref().map(|play| play.drama),
            mechanics: play.as_ref().map(|play| play.mechanics as u64),
            calls: judgements().map(|judgement| judgement.finding.calls()).sum(),
        }
    }
}

/// The episodes of a level that win: the shortest that is known, then those of players.
fn wins(report: &Report) -> Vec<Episode> {
    let mut won = report.episodes();
    won.retain(|episode| episode.outcome == Outcome::Won);
    won
}
