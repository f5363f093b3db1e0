//! The findings about one game.

use super::edge::{Edge, ladder_order};
use super::surveyed::SurveyedGame;
use base::{Digest, Seed};
use engine::{Analysis, Episode, Outcome};
use report::TableCell;
use serde::{Deserialize, Serialize};
use std::fmt;
use validators::measures::Guards;
use validators::{Criteria, GameReport, PlayMeasures, Recorded, Report, RulesShown};

/// The version of a row's format.
pub(super) const FORM: u32 = 3;

/// The reason for a missing figure if no win was found on any level.
pub(super) const NO_WIN: &str = "no win found";
/// The reason for a missing figure if there is no level to judge.
pub(super) const NO_LEVEL: &str = "no level";

/// The findings about one game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameRow {
    /// The game's name.
    pub name: String,
    /// The digest of everything that determines the row; see [`GameSurvey::digest`](super::GameSurvey::digest).
    pub digest: Digest,
    /// The number of judged levels.
    pub levels: u64,
    /// The number of levels for which a win was found.
    pub won: u64,
    /// The number of interactions in the rules, not counting guards ([`Guards`]).
    pub rules: u64,
    /// The number of interactions counted in `rules` that are executed in a recorded episode.
    pub executed: u64,
    /// The number of types that can have sprites of their own.
    pub types: u64,
    /// The number of types counted in `types` that occur on the board or as a resource in a recorded episode.
    pub there: u64,
    /// The advantage of the strongest player over the best player that does not look ahead; `None` if there are no such
    /// players.
    pub edge: Option<Edge>,
    /// The rank correlation between the reference players' positions on the ladder (from weak to strong) and their
    /// results; `None` if no ladder played.
    pub order: Option<f64>,
    /// The number of distinct interactions that the wins execute in total, not counting guards
    /// ([`PlayMeasures::mechanics`]); `None` if no win was found.
    pub mechanics: Option<u64>,
    /// The despair on the way to a win ([`PlayMeasures::drama`]); `None` if no win was found.
    pub drama: Option<f64>,
    /// The number of forward-model calls in all searches and episodes.
    pub calls: u64,
}

impl GameRow {
    /// Returns the columns of [`GameRow::cells`].
    pub(crate) fn columns() -> impl Iterator<Item = &'static str> {
        COLUMNS.iter().map(|(name, _)| *name)
    }

    /// Returns the row for a game judged by `winnable` and `skill`. Costs three replays of the recorded episodes, plus
    /// the cost of [`PlayMeasures::of`].
    pub(crate) fn of(surveyed: &SurveyedGame, criteria: &Criteria, digest: Digest, seed: Seed) -> GameRow {
        let SurveyedGame { name, game, levels, report: GameReport { levels: reports, .. }, .. } = surveyed;
        let analysis = Analysis::of(game);
        let guards: Vec<usize> = Guards::of(&analysis).lines().collect();
        let inner = |lines: &[usize]| lines.iter().filter(|line| !guards.contains(line)).count() as u64;
        let shown = RulesShown::of(game, levels, reports, seed.child("rules", 0));
        let (executed, idle) = (inner(&shown.executed), inner(&shown.idle));
        let (there, absent) = (shown.present.len() as u64, shown.absent.len() as u64);
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
            edge: Edge::of(&analysis, levels, reports, criteria),
            order: ladder_order(reports),
            drama: play.as_ref().map(|play| play.drama),
            mechanics: play.as_ref().map(|play| play.mechanics as u64),
            calls: judgements().map(|judgement| judgement.finding.calls()).sum(),
        }
    }

    /// Returns the row as table cells.
    pub(crate) fn cells(&self) -> impl Iterator<Item = TableCell> {
        COLUMNS.iter().map(|(_, cell)| cell(self))
    }
}

/// A column in the table of games: its name, and its cell for a row.
type Column = (&'static str, fn(&GameRow) -> TableCell);

const COLUMNS: [Column; 13] = [
    ("won", |row| TableCell::Figure(format!("{} of {}", row.won, row.levels))),
    ("rules", |row| TableCell::Count(row.rules)),
    ("run", |row| TableCell::Count(row.executed)),
    ("sprites", |row| TableCell::Count(row.types)),
    ("there", |row| TableCell::Count(row.there)),
    ("mechanics", |row| TableCell::count(row.mechanics)),
    ("drama", |row| TableCell::number(row.drama, 2)),
    ("strongest", |row| of_edge(row, |edge| format!("{} {} of {}", edge.strongest, edge.wins, edge.plays))),
    ("floor", |row| of_edge(row, |edge| format!("{} {}", edge.floor, edge.floor_wins))),
    ("points", |row| of_edge(row, |edge| points(edge.points))),
    ("95%", |row| of_edge(row, |edge| edge.interval.map(points).join(" to "))),
    ("score", |row| signed(row.edge.as_ref().and_then(|edge| edge.score))),
    ("order", |row| signed(row.order)),
];

fn of_edge(row: &GameRow, text: impl Fn(&Edge) -> String) -> TableCell {
    TableCell::figure(row.edge.as_ref().map(text))
}

fn points(value: f64) -> String {
    format!("{:+.0}", 100.0 * value)
}

fn signed(value: Option<f64>) -> TableCell {
    TableCell::figure(value.map(|value| format!("{value:+.2}")))
}

impl fmt::Display for GameRow {
    /// Writes one line for progress messages: `hailglass: won 3 of 3, rules 9, …`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.name)?;
        let known = GameRow::columns().zip(self.cells()).filter(|(_, cell)| *cell != TableCell::Missing);
        known.enumerate().try_for_each(|(at, (column, cell))| {
            let comma = if at == 0 { "" } else { "," };
            write!(f, "{comma} {column} {}", cell.plain())
        })
    }
}

/// Returns a level's winning episodes: the shortest known win, then the players' wins.
fn wins(report: &Report) -> Vec<Episode> {
    let mut won = report.episodes();
    won.retain(|episode| episode.outcome == Outcome::Won);
    won
}
