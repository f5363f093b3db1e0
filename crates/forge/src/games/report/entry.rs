//! One game as a report row.

use crate::survey::{Edge, GameRow, SurveyedGame};
use base::{Digest, Seed};
use engine::Analysis;
use report::{Table, TableCell};
use serde::Serialize;
use validators::{Criteria, Criterion, Difficulty, GameForm, GameKind};

/// A game with its measures.
pub(super) struct Measured<'a> {
    pub(super) surveyed: &'a SurveyedGame,
    pub(super) row: GameRow,
    pub(super) form: GameForm,
    pub(super) kind: GameKind,
    pub(super) held_out: Option<Edge>,
}

impl<'a> Measured<'a> {
    pub(super) fn of(surveyed: &'a SurveyedGame, criteria: &Criteria, seed: Seed) -> Measured<'a> {
        let SurveyedGame { game, levels, report, .. } = surveyed;
        let digests = levels.iter().flat_map(|level| *level.digest().as_bytes());
        let bytes: Vec<u8> = game.digest().as_bytes().iter().copied().chain(digests).collect();
        let analysis = Analysis::of(game);
        let seed = seed.child(&game.digest().to_string(), 0);
        Measured {
            surveyed,
            row: GameRow::of(surveyed, criteria, Digest::of(&bytes), seed),
            form: GameForm::of(game),
            kind: GameKind::of(&analysis),
            held_out: Edge::held_out(&analysis, levels, &report.levels, criteria),
        }
    }
}

/// One game in the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GameEntry {
    /// The title in the game's theme.
    pub title: String,
    /// The way to win, explained to players.
    pub goal: String,
    /// The digest of the game's rules.
    pub rules: Digest,
    /// `true` if the game and all of its levels meet every criterion.
    pub passes: bool,
    /// The first unmet criterion; `None` if all criteria are met.
    pub obstacle: Option<Criterion>,
    /// The kind of game.
    pub kind: GameKind,
    /// The findings about the game's play, as used for comparisons with other games.
    pub found: GameRow,
    /// The advantage in win rate of the strongest held-out player over the best player that does not look ahead.
    pub held_out: Option<Edge>,
    /// The game's levels.
    pub levels: Vec<LevelEntry>,
    /// The nearest other game in the set; `None` if the set has only one game.
    pub nearest: Option<Nearest>,
    /// The nearest game in the corpus; `None` if the corpus is empty.
    pub nearest_corpus: Option<Nearest>,
}

/// One level of a game in the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelEntry {
    /// The number of columns of the board.
    pub columns: u64,
    /// The number of rows of the board.
    pub rows: u64,
    /// The number of ticks in the shortest win found; `None` if no win was found.
    pub ticks: Option<u64>,
    /// The ease measured by the ladder (reference players of increasing strength), from 0 to 1; `None` if it was not
    /// measured.
    pub ease: Option<f64>,
    /// The difficulty label according to the ladder; `None` if no ladder played.
    pub label: Option<Difficulty>,
}

/// A game's nearest neighbour.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Nearest {
    /// The game's name.
    pub name: String,
    /// The distance to the game, from 0 (the same) to 1.
    pub distance: f64,
}

impl GameEntry {
    pub(super) fn of(measured: &Measured<'_>, [nearest, nearest_corpus]: [Option<Nearest>; 2]) -> GameEntry {
        let SurveyedGame { name, goal, game, levels, report } = measured.surveyed;
        let level = |(level, report): (&engine::Level, &validators::Report)| LevelEntry {
            columns: level.columns() as u64,
            rows: level.rows() as u64,
            ticks: report.witness.as_ref().map(|witness| witness.actions.len() as u64),
            ease: report.ladder().and_then(|ladder| ladder.ease),
            label: report.ladder().map(|ladder| ladder.difficulty),
        };
        GameEntry {
            title: name.clone(),
            goal: goal.clone(),
            rules: game.digest(),
            passes: report.passes(),
            obstacle: measured.surveyed.obstacle().map(|judged| judged.criterion),
            kind: measured.kind.clone(),
            found: measured.row.clone(),
            held_out: measured.held_out.clone(),
            levels: levels.iter().zip(&report.levels).map(level).collect(),
            nearest,
            nearest_corpus,
        }
    }

    /// Describes the game in one line: its kind, its number of rules, and the criterion it fails, if any.
    pub fn remark(&self) -> String {
        let rules =
            if self.found.rules == 1 { "1 rule".to_owned() } else { format!("{} rules", self.found.rules) };
        let kind = format!("{} × {}", self.kind.avatar.name(), self.kind.goal.name());
        let obstacle = self.obstacle.as_ref().map(|criterion| format!("{criterion} not passed"));
        [kind, rules].into_iter().chain(obstacle).collect::<Vec<_>>().join(" · ")
    }
}

pub(super) fn table(entries: &[GameEntry]) -> Table {
    let columns = ["game", "verdict"].into_iter().chain(GameRow::columns());
    let columns = columns.chain(["held out", "nearest", "in the corpus", "digest"]);
    let mut table = Table::new("games", "Every game", "", &columns.collect::<Vec<&str>>());
    for entry in entries {
        let verdict = entry.obstacle.as_ref().map(|criterion| format!("{criterion} not passed"));
        let mut cells = vec![
            TableCell::text(&*entry.title),
            TableCell::text(verdict.unwrap_or_else(|| "passes".to_owned())),
        ];
        cells.extend(entry.found.cells());
        let points = |edge: &Edge| format!("{} {:+.0}", edge.strongest, 100.0 * edge.points);
        cells.push(TableCell::figure(entry.held_out.as_ref().map(points)));
        for near in [&entry.nearest, &entry.nearest_corpus] {
            cells.push(TableCell::figure(
                near.as_ref().map(|near| format!("{:.2} {}", near.distance, near.name)),
            ));
        }
        cells.push(TableCell::Figure(entry.rules.short()));
        table.push(cells);
    }
    table
}
