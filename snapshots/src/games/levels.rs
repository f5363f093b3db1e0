//! Levels for one game: candidates of the level generator until enough pass.

use crate::card::LevelCard;
use crate::mint::Tally;
use crate::recipe::Board;
use engine::{Digest, Episode, Game, Level, Seed};
use generators::Generator;
use generators::levels::{ConstructiveLevels, LevelConfig};
use validators::{Criteria, Finding, Judgement, Panel, Rate, Report, mcts_rate};

/// A level that its judges let in.
#[derive(Clone, Debug)]
pub struct FoundLevel {
    /// The level.
    pub level: Level,
    /// What its judges found; its witness wins it.
    pub report: Report,
    /// How often plain tree search wins it.
    pub mcts: Rate,
    /// The difficulty that its generator was asked for, from 0 to 1.
    pub difficulty: f64,
    /// Which candidate for its place it was, counted from 0.
    pub candidate: u32,
}

/// The levels of a game, and what was found of all of them together.
#[derive(Clone, Debug)]
pub struct FoundLevels {
    /// From the easiest that was asked for to the hardest.
    pub levels: Vec<FoundLevel>,
    /// What the judges of the game found.
    pub together: Vec<Judgement>,
}

/// The levels of one candidate game.
pub(crate) struct Levels<'a> {
    /// How many.
    pub(crate) count: u32,
    /// Candidates for each, at most.
    pub(crate) tries: u32,
    /// How large they are.
    pub(crate) board: &'a Board,
    pub(crate) criteria: &'a Criteria,
    /// The judges of these criteria.
    pub(crate) panel: &'a Panel,
    pub(crate) seed: Seed,
}

impl Levels<'_> {
    /// All levels, from the easiest asked for to the hardest; None as soon as one cannot be had, or if the game does not meet
    /// a criterion on all of them together.
    pub(crate) fn find(&self, game: &Game, tally: &mut Tally) -> Option<FoundLevels> {
        let mut levels: Vec<FoundLevel> = Vec::new();
        for number in 0..self.count {
            let taken: Vec<Digest> = levels.iter().map(|found| found.level.digest()).collect();
            match self.level(game, number, &taken, tally) {
                Some(level) => levels.push(level),
                None => {
                    tally.game_rejected(&format!("no level {number}"));
                    return None;
                }
            }
        }
        let (boards, reports): (Vec<Level>, Vec<Report>) =
            levels.iter().map(|found| (found.level.clone(), found.report.clone())).unzip();
        let together =
            self.panel.judge_together(game, &boards, &reports, self.seed.child("judges of the game", 0));
        if let Some(obstacle) = together.iter().find(|judgement| !judgement.finding.verdict.is_pass()) {
            tally.game_rejected(obstacle.criterion);
            return None;
        }
        Some(FoundLevels { levels, together })
    }

    fn level(&self, game: &Game, number: u32, taken: &[Digest], tally: &mut Tally) -> Option<FoundLevel> {
        let difficulty = f64::from(number) / f64::from((self.count - 1).max(1));
        let board = self.board;
        let config =
            LevelConfig { columns: board.columns, rows: board.rows, difficulty, ..LevelConfig::default() };
        let generator = match ConstructiveLevels::new(game, config) {
            Ok(generator) => generator,
            Err(error) => {
                tally.game_rejected(&error.to_string());
                return None;
            }
        };
        for candidate in 0..self.tries {
            let seed = self.seed.child("level", u64::from(number)).child("candidate", u64::from(candidate));
            let level = match generator.generate(seed.child("layout", 0)) {
                Ok(level) if taken.contains(&level.digest()) => {
                    tally.level(0, Some("the same level twice"));
                    continue;
                }
                Ok(level) => level,
                Err(_) => {
                    tally.level(0, Some("level generator"));
                    continue;
                }
            };
            let report = self.panel.screen(game, &level, seed.child("judges", 0));
            let obstacle = report.first_obstacle().map(|judgement| judgement.criterion);
            tally.level(report.judgements.iter().map(|judgement| judgement.finding.calls()).sum(), obstacle);
            if let (None, Some(witness)) = (obstacle, &report.witness) {
                let mcts = mcts_rate(game, &level, witness, self.criteria, seed.child("mcts verdict", 0));
                tally.calls(mcts.calls);
                return Some(FoundLevel { level, report, mcts, difficulty, candidate });
            }
        }
        None
    }
}

impl FoundLevel {
    /// What a card tells of the level, and the episode that wins it; none unless its judges were asked about idle and random
    /// play and for a win.
    pub(crate) fn card(&self, number: usize) -> Option<(LevelCard, Episode)> {
        let report = &self.report;
        let rate = |criterion: &str| -> Option<Rate> { report.finding(criterion)?.measured.clone() };
        let witness = report.witness.clone()?;
        let card = LevelCard {
            file: format!("lvl{number}.txt"),
            digest: self.level.digest(),
            columns: self.level.columns(),
            rows: self.level.rows(),
            generator: "constructive".to_owned(),
            difficulty: self.difficulty,
            candidate: self.candidate,
            witness_ticks: witness.actions.len(),
            witness_score: witness.score,
            optimal_ticks: report.finding("winnable").and_then(|finding| finding.optimal),
            search_calls: report.finding("winnable").map_or(0, Finding::calls),
            mcts: self.mcts.clone(),
            random: rate("not-random")?,
            idle: rate("not-idle")?,
            ladder: report.ladder().cloned(),
        };
        Some((card, witness))
    }
}
