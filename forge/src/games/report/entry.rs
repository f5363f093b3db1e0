//! A game in a row.

use super::ReportedGame;
use crate::games::survey::{Edge, GameRow};
use engine::Digest;
use serde::{Deserialize, Serialize};
use validators::{Difficulty, GameForm, GameKind};

/// A game with what was measured.
pub(super) struct Judged<'a> {
    pub(super) reported: &'a ReportedGame,
    pub(super) row: GameRow,
    pub(super) form: GameForm,
    pub(super) kind: GameKind,
    pub(super) held_out: Option<Edge>,
}

/// What is told of a game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameEntry {
    /// Title in the game's own fiction.
    pub title: String,
    /// How to win.
    pub goal: String,
    /// The digest of its rules.
    pub rules: Digest,
    /// Whether every level and the game meet every criterion.
    pub passes: bool,
    /// The first criterion that is not met.
    pub obstacle: Option<String>,
    /// What kind of game it is.
    pub kind: GameKind,
    /// What was found of its play, as in the comparison with other games.
    pub found: GameRow,
    /// How much better the strongest of the players held out does than those who do not look ahead.
    pub held_out: Option<Edge>,
    /// Each of its levels.
    pub levels: Vec<LevelEntry>,
    /// The game of the set that is most like it.
    pub nearest: Option<Nearest>,
    /// The game of the corpus that is most like it.
    pub nearest_corpus: Option<Nearest>,
}

/// What is told of a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelEntry {
    /// Columns of the board.
    pub columns: u64,
    /// Rows of the board.
    pub rows: u64,
    /// Ticks of the shortest win that was found.
    pub ticks: Option<u64>,
    /// How easy, from 0 to 1.
    pub ease: Option<f64>,
    /// The label of that.
    pub label: Option<Difficulty>,
}

/// A game that is near.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nearest {
    /// What it is called.
    pub name: String,
    /// From 0, the same, to 1.
    pub distance: f64,
}

impl GameEntry {
    pub(super) fn of(judged: &Judged<'_>, [nearest, nearest_corpus]: [Option<Nearest>; 2]) -> GameEntry {
        let ReportedGame { title, goal, game, levels, report } = judged.reported;
        let level = |(level, report): (&engine::Level, &validators::Report)| LevelEntry {
            columns: level.columns() as u64,
            rows: level.rows() as u64,
            ticks: report.witness.as_ref().map(|witness| witness.actions.len() as u64),
            ease: report.ladder().and_then(|ladder| ladder.ease),
            label: report.ladder().map(|ladder| ladder.difficulty),
        };
        GameEntry {
            title: title.clone(),
            goal: goal.clone(),
            rules: game.digest(),
            passes: report.passes(),
            obstacle: obstacle(judged.reported).map(str::to_owned),
            kind: judged.kind.clone(),
            found: judged.row.clone(),
            held_out: judged.held_out.clone(),
            levels: levels.iter().zip(&report.levels).map(level).collect(),
            nearest,
            nearest_corpus,
        }
    }
}

/// The first criterion that a game does not meet: on its levels in their order, then on all together.
pub(super) fn obstacle(reported: &ReportedGame) -> Option<&'static str> {
    let of_levels = reported.report.levels.iter().find_map(|report| report.first_obstacle());
    let of_game = reported.report.judgements.iter().find(|judged| !judged.finding.verdict.is_pass());
    of_levels.or(of_game).map(|judged| judged.criterion)
}
