//! A game after its survey.

use engine::{Game, Level};
use validators::{GameReport, Judgement};

/// A game and all findings of its judges.
#[derive(Clone, Debug)]
pub struct SurveyedGame {
    /// The title in the game's theme, or the game's name among the games being judged.
    pub name: String,
    /// The way to win, as explained to players: a single line that may be empty.
    pub goal: String,
    /// The judged game.
    pub game: Game,
    /// The judged levels, in the game's order.
    pub levels: Vec<Level>,
    /// The panel's findings about each level, and about the levels as a whole.
    pub report: GameReport,
}

impl SurveyedGame {
    /// Returns the first unmet criterion, checking the levels in order and then the levels as a whole; `None` if all
    /// criteria are met.
    pub(crate) fn obstacle(&self) -> Option<&Judgement> {
        let of_levels = self.report.levels.iter().find_map(|report| report.first_obstacle());
        of_levels.or_else(|| self.report.judgements.iter().find(|judged| !judged.finding.verdict.is_pass()))
    }
}
