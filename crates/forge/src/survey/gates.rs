//! A survey of the fraction of games that pass each gate, which is a criterion for a whole game. The thresholds of the
//! gates are based on this survey.

use base::Seed;
use engine::{Episode, Game, Level};
use rayon::prelude::*;
use report::{Table, TableCell};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::{Criteria, CriteriaError, Criterion, CriterionSet, Effort, Judging, Panel, Verdict};

/// A survey that judges games by each gate (a criterion for a whole game) separately, and all games in the same way.
pub struct GateSurvey {
    panel: Panel,
    /// The judges for levels with a known win.
    panel_of_won: Panel,
    seed: Seed,
}

/// A gate's verdict on a game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateAnswer {
    /// `true` if the game passes the gate; `None` if the gate could not judge the game.
    pub passes: Option<bool>,
    /// The value measured by the gate, for tables; `None` if it measured none.
    pub figure: Option<f64>,
    /// The details from the evidence.
    pub seen: Vec<String>,
}

/// A game and the gates' verdicts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateRow {
    /// The game's name.
    pub name: String,
    /// The number of judged levels.
    pub levels: usize,
    /// The number of levels for which a win was found.
    pub won: usize,
    /// The verdict of each gate.
    pub gates: BTreeMap<Criterion, GateAnswer>,
}

impl GateSurvey {
    /// Creates a survey with the criteria's thresholds and its budget for win searches.
    ///
    /// # Errors
    /// Returns an error if the criteria are invalid.
    pub fn new(criteria: &Criteria, seed: Seed) -> Result<GateSurvey, CriteriaError> {
        let ask = CriterionSet::GATES.with(CriterionSet::of(&[Criterion::Winnable]));
        let criteria = Criteria { ask, ..criteria.clone() }.check()?;
        let of_won = criteria.only(CriterionSet::GATES);
        let panel = |criteria| Panel::new(criteria, Effort::Full);
        Ok(GateSurvey { panel: panel(criteria), panel_of_won: panel(of_won), seed })
    }

    /// Returns criteria with a budget small enough to judge a hundred games in half an hour on two cores.
    pub fn criteria() -> Criteria {
        Criteria { budget: 300_000, foresight: 0.4, ..Criteria::default() }
    }

    /// Returns a game's row. The row does not depend on the other games or on the number of threads. Levels are judged
    /// by their known win or, if none is known, by a win that a search finds.
    pub fn row(&self, name: &str, game: &Game, levels: &[(Level, Option<Episode>)]) -> GateRow {
        let seed = self.seed.child(&game.digest().to_string(), 0);
        let judge = |(level, win): &(Level, Option<Episode>)| {
            let seed = seed.child(&level.digest().to_string(), 0);
            let panel = if win.is_some() { &self.panel_of_won } else { &self.panel };
            panel.judge(Judging::level(game, level, seed).won_by(win.clone()))
        };
        let reports: Vec<_> = levels.par_iter().map(judge).collect();
        let boards: Vec<Level> = levels.iter().map(|(level, _)| level.clone()).collect();
        let judgements = self.panel.judge(Judging::together(game, &boards, &reports, seed));
        let won = reports.iter().filter(|level| level.witness.is_some()).count();
        let answer = |judged: &validators::Judgement| {
            let finding = &judged.finding;
            let passes = match finding.verdict {
                Verdict::Pass { .. } => Some(true),
                Verdict::Fail { .. } => Some(false),
                Verdict::Unknown { .. } => None,
            };
            let seen = finding.evidence.iter().map(|seen| seen.text.clone()).collect();
            (judged.criterion, GateAnswer { passes, figure: finding.figure, seen })
        };
        let gates = judgements.iter().map(answer).collect();
        GateRow { name: name.to_owned(), levels: levels.len(), won, gates }
    }
}

impl GateRow {
    /// Describes the row in one line, for progress messages: `hailglass: won 5 of 5, drama 0.61, …`, with `!` after the
    /// gates that fail.
    pub fn line(&self) -> String {
        let answer = |gate: Criterion| {
            let answer = self.gates.get(&gate)?;
            let figure = answer.figure.map_or(String::new(), |figure| format!(" {figure:.2}"));
            let mark = match answer.passes {
                Some(true) => "",
                Some(false) => "!",
                None => "?",
            };
            Some(format!("{gate}{mark}{figure}"))
        };
        let answers: Vec<String> = CriterionSet::GATES.iter().filter_map(answer).collect();
        format!("{}: won {} of {}, {}", self.name, self.won, self.levels, answers.join(", "))
    }

    /// Returns a table that compares groups of games. For each gate and group, it lists how many of the judged games
    /// pass the gate, and the median of the value that the gate measured.
    pub fn table(groups: &[(&str, &[GateRow])]) -> Table {
        let columns =
            groups.iter().flat_map(|(group, _)| [format!("{group} pass"), format!("{group} median")]);
        let columns: Vec<String> = ["gate".to_owned()].into_iter().chain(columns).collect();
        let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
        let mut table = Table::new("gates", "Gates", "", &columns);
        for gate in CriterionSet::GATES.iter() {
            let cells = groups.iter().flat_map(|(_, rows)| {
                let answers: Vec<&GateAnswer> = rows.iter().filter_map(|row| row.gates.get(&gate)).collect();
                let judged = answers.iter().filter(|answer| answer.passes.is_some()).count();
                let passed = answers.iter().filter(|answer| answer.passes == Some(true)).count();
                let mut figures: Vec<f64> = answers.iter().filter_map(|answer| answer.figure).collect();
                figures.sort_by(f64::total_cmp);
                let median = figures.get(figures.len() / 2).copied();
                [TableCell::Figure(format!("{passed} of {judged}")), TableCell::number(median, 2)]
            });
            table.push([TableCell::text(gate.name())].into_iter().chain(cells).collect());
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::canonical::to_canonical_json;
    use engine::Action;

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n  InteractionSet\n    avatar wall > stepBack\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    Timeout limit=60 win=False\n";

    #[test]
    fn a_walk_to_a_plum_fails_and_is_counted() {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("wwwwww\nwA  pw\nwwwwww\n").unwrap();
        let seed = Seed::from_text("gates");
        let criteria = Criteria { budget: 1000, ..GateSurvey::criteria() };
        let row = GateSurvey::new(&criteria, seed).unwrap().row("plums", &game, &[(level, None)]);
        assert_eq!((row.levels, row.won), (1, 1));
        assert_eq!(row.gates[&Criterion::Drama].passes, Some(false));
        assert_eq!(row.gates[&Criterion::Progression].passes, None);
        assert!(
            row.line().starts_with("plums: won 1 of 1, open-ground! 1.00, progression?, drama! 0.00,"),
            "{}",
            row.line()
        );
        let table = GateRow::table(&[("ours", &[row])]).to_markdown();
        assert!(table.contains("| drama | 0 of 1 | 0.00 |"), "{table}");
    }

    #[test]
    fn a_known_win_is_the_one_that_is_judged() {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("wwwwww\nwA  pw\nwwwwww\n").unwrap();
        let (mut win, mut state) = Episode::begin(&game, &level, Seed::from_text("win"));
        // The win has a detour. A search would find a win of three steps.
        for action in [Action::Right, Action::Left, Action::Right, Action::Right, Action::Right] {
            win.play(&game, &mut state, action);
        }
        let survey = GateSurvey::new(&GateSurvey::criteria(), Seed::from_text("gates")).unwrap();
        let ticks = |win: Option<Episode>| {
            let row = survey.row("plums", &game, &[(level.clone(), win)]);
            row.gates[&Criterion::NoDeadTime].seen.last().cloned().unwrap_or_default()
        };
        assert!(ticks(Some(win)).contains("of the 5 ticks of a win"), "{}", ticks(None));
        assert!(ticks(None).contains("of the 3 ticks of a win"), "{}", ticks(None));
    }

    #[test]
    fn default_thresholds_move_no_recipe() {
        let written = to_canonical_json(&Criteria::default()).unwrap();
        assert!(!written.contains("gates"), "{written}");
        let mut criteria = Criteria::default();
        criteria.gates.drama = 0.3;
        assert!(to_canonical_json(&criteria).unwrap().contains("gates"));
    }
}
