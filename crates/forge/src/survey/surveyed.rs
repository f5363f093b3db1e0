//! A game after its survey.

use engine::{Game, Level};
use validators::{GameReport, Judgement};

/// A game and all that its judges found.
#[derive(Clone, Debug)]
pub struct SurveyedGame {
    /// Title in the game's own fiction, or its name among the games that it is judged with.
    pub name: String,
    /// The way to win, for people: a line; may be empty.
    pub goal: String,
    /// The game.
    pub game: Game,
    /// Its levels that were judged, in their order.
    pub levels: Vec<Level>,
    /// The findings of the panel about each level, and about all together.
    pub report: GameReport,
}

impl SurveyedGame {
    /// The first criterion that is not met: on the levels in their order, then on all together.
    pub(crate) fn obstacle(&self) -> Option<&Judgement> {
        let of_levels = self.report.levels.iter().find_map(|report| report.first_obstacle());
        of_levels.or_else(|| self.report.judgements.iter().find(|judged| !judged.finding.verdict.is_pass()))
    }
}
