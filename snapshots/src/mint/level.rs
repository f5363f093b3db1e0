//! Levels for one game: candidates of the level generator until enough pass.

use super::tally::Tally;
use crate::card::LevelCard;
use crate::recipe::{Part, Recipe};
use engine::{Digest, Episode, Game, Level, Seed};
use generators::Generator;
use generators::levels::{ConstructiveLevels, LevelConfig};
use validators::{Finding, Panel, Rate, Report, mcts_rate};

/// A level that passed, with the episode that proves it winnable.
pub(super) struct MintedLevel {
    pub(super) text: String,
    pub(super) card: LevelCard,
    pub(super) witness: Episode,
}

/// The levels of one candidate game.
pub(super) struct Levels<'a> {
    pub(super) recipe: &'a Recipe,
    pub(super) part: &'a Part,
    pub(super) panel: &'a Panel,
    pub(super) seed: Seed,
}

impl Levels<'_> {
    /// All levels, from the easiest asked for to the hardest; None as soon as one cannot be had, or if the game does not meet
    /// a criterion on all of them together.
    pub(super) fn mint(&self, game: &Game, tally: &mut Tally) -> Option<Vec<MintedLevel>> {
        let mut found: Vec<Found> = Vec::new();
        for number in 0..self.part.levels {
            let taken: Vec<Digest> = found.iter().map(|found| found.level.digest()).collect();
            match self.level(game, number, &taken, tally) {
                Some(level) => found.push(level),
                None => {
                    tally.game_rejected(&format!("no level {number}"));
                    return None;
                }
            }
        }
        let (levels, reports): (Vec<Level>, Vec<Report>) =
            found.iter().map(|found| (found.level.clone(), found.report.clone())).unzip();
        let together =
            self.panel.judge_together(game, &levels, &reports, self.seed.child("judges of the game", 0));
        if let Some(obstacle) = together.iter().find(|judgement| !judgement.finding.verdict.is_pass()) {
            tally.game_rejected(obstacle.criterion);
            return None;
        }
        found.into_iter().map(minted).collect()
    }

    fn level(&self, game: &Game, number: u32, taken: &[Digest], tally: &mut Tally) -> Option<Found> {
        let difficulty = f64::from(number) / f64::from((self.part.levels - 1).max(1));
        let board = &self.recipe.board;
        let config =
            LevelConfig { columns: board.columns, rows: board.rows, difficulty, ..LevelConfig::default() };
        let generator = match ConstructiveLevels::new(game, config) {
            Ok(generator) => generator,
            Err(error) => {
                tally.game_rejected(&error.to_string());
                return None;
            }
        };
        for candidate in 0..self.part.level_tries {
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
            tally.level(report.judgements.iter().map(|judgement| calls(&judgement.finding)).sum(), obstacle);
            if let (None, Some(witness)) = (obstacle, &report.witness) {
                let mcts =
                    mcts_rate(game, &level, witness, &self.recipe.criteria, seed.child("mcts verdict", 0));
                tally.calls(mcts.calls);
                let file = format!("lvl{number}.txt");
                return Some(Found { level, report, mcts, file, difficulty, candidate });
            }
        }
        None
    }
}

/// A level that passed, and its place.
struct Found {
    level: Level,
    report: Report,
    mcts: Rate,
    file: String,
    difficulty: f64,
    candidate: u32,
}

/// The forward-model calls of a judge.
fn calls(finding: &Finding) -> u64 {
    finding.searched.unwrap_or(0) + finding.measured.as_ref().map_or(0, |rate| rate.calls)
}

fn minted(found: Found) -> Option<MintedLevel> {
    let Found { level, report, mcts, file, difficulty, candidate } = found;
    let rate = |criterion: &str| -> Option<Rate> { report.finding(criterion)?.measured.clone() };
    let witness = report.witness.clone()?;
    let card = LevelCard {
        file,
        digest: level.digest(),
        columns: level.columns(),
        rows: level.rows(),
        generator: "constructive".to_owned(),
        difficulty,
        candidate,
        witness_ticks: witness.actions.len(),
        witness_score: witness.score,
        optimal_ticks: report.finding("winnable").and_then(|finding| finding.optimal),
        search_calls: report.finding("winnable").map_or(0, calls),
        mcts,
        random: rate("not-random")?,
        idle: rate("not-idle")?,
        ladder: report.ladder().cloned(),
    };
    Some(MintedLevel { text: level.to_string(), card, witness })
}
