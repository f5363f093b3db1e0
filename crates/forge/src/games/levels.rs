//! The levels of a game, and the request for them.

use crate::card::LevelCard;
use crate::pipeline::BoardSource;
use crate::tally::Tally;
use base::SeedPath;
use engine::{Episode, Game, Level};
use std::collections::BTreeSet;
use validators::measures::Guards;
use validators::{
    CheckedCriteria, Criterion, CriterionSet, Demand, Effort, Finding, Judgement, Judging, Panel, Rate,
    Report, used_rules,
};

/// A level that its judges accepted.
#[derive(Clone, Debug)]
pub struct FoundLevel {
    /// The level.
    pub level: Level,
    /// The findings of its judges; its witness wins it.
    pub report: Report,
    /// The generator that made it.
    pub generator: &'static str,
    /// Its question to the player, if it is one of a course.
    pub asks: Option<String>,
    /// The difficulty that its generator was asked for, from 0 to 1.
    pub difficulty: f64,
    /// Its number among the candidates for its place, from 0.
    pub candidate: u32,
    /// The seed of the candidate.
    pub seed: SeedPath,
    /// Its demands on a player, if it was made to a tier.
    pub demand: Option<Demand>,
}

/// A candidate for a place, before its judges see it.
#[derive(Clone)]
pub(crate) struct Drawn {
    pub(crate) level: Level,
    /// The difficulty that its generator was asked for, from 0 to 1.
    pub(crate) difficulty: f64,
    /// Its number among the candidates for its place, from 0.
    pub(crate) candidate: u32,
    /// The seed of the candidate.
    pub(crate) seed: SeedPath,
    /// A win that is known.
    pub(crate) win: Option<Episode>,
}

/// The levels of a game, and the findings on all of them together.
#[derive(Clone, Debug)]
pub struct FoundLevels {
    /// In the order of the game: from the easiest to the hardest for the ladder, if it played, or else as was asked for.
    pub levels: Vec<FoundLevel>,
    /// The win rate of plain tree search on each.
    pub mcts: Vec<Rate>,
    /// The findings of the judges of the game.
    pub together: Vec<Judgement>,
    /// The seed of candidates and judges.
    pub seed: SeedPath,
}

/// The request for the levels of a candidate game.
#[derive(Clone, Copy)]
pub struct Levels<'a> {
    /// The number of levels.
    pub count: u32,
    /// Candidates for each, at most.
    pub tries: u32,
    /// The source of candidates.
    pub source: &'a dyn BoardSource,
    /// The criteria that each level and all levels together have to meet.
    pub criteria: &'a CheckedCriteria,
    /// The judges of these criteria.
    pub panel: &'a Panel,
    /// The seed of candidates and judges.
    pub seed: &'a SeedPath,
}

/// The seed of the judges of a candidate.
pub(crate) fn judges_seed(candidate: &SeedPath) -> SeedPath {
    candidate.child("judges", 0)
}

impl Levels<'_> {
    /// The judges of those criteria that are in the set.
    pub(crate) fn panel_of(&self, set: CriterionSet) -> Panel {
        Panel::new(self.criteria.only(set), Effort::Sequential)
    }

    /// Judges a candidate: `None` if it does not meet all criteria.
    pub(crate) fn judge_drawn(
        &self,
        panel: &Panel,
        game: &Game,
        drawn: Drawn,
        tally: &mut Tally,
    ) -> Option<FoundLevel> {
        let Drawn { level, difficulty, candidate, seed, win } = drawn;
        let judging = Judging::level(game, &level, judges_seed(&seed)).won_by(win);
        let report = panel.judge(judging.until_failure());
        let obstacle = report.first_obstacle().map(|judgement| judgement.criterion.name());
        tally.level(&report.judgements, obstacle);
        (obstacle.is_none() && report.witness.is_some()).then_some(FoundLevel {
            level,
            report,
            generator: self.source.name(),
            asks: None,
            difficulty,
            candidate,
            seed,
            demand: None,
        })
    }
}

impl FoundLevel {
    /// The interactions that its win executes, guards apart.
    pub(crate) fn mechanics(&self, game: &Game, guards: &Guards) -> BTreeSet<usize> {
        let Some(win) = &self.report.witness else { return BTreeSet::new() };
        let guards: BTreeSet<usize> = guards.lines().collect();
        used_rules(game, &self.level, win).into_iter().filter(|line| !guards.contains(line)).collect()
    }

    /// Its ease for the ladder, from 0 to 1; the same for all levels if none played.
    pub(crate) fn ease(&self) -> f64 {
        self.report.ladder().and_then(|ladder| ladder.ease).unwrap_or_default()
    }

    /// Returns the card of the level and the episode that wins it; `None` unless its judges were asked about idle and random
    /// play and for a win.
    pub(crate) fn card(&self, number: usize, mcts: &Rate) -> Option<(LevelCard, Episode)> {
        let report = &self.report;
        let rate = |criterion: Criterion| -> Option<Rate> { report.finding(criterion)?.measured.clone() };
        let witness = report.witness.clone()?;
        let card = LevelCard {
            file: format!("lvl{number}.txt"),
            digest: self.level.digest(),
            columns: self.level.columns(),
            rows: self.level.rows(),
            generator: self.generator.to_owned(),
            asks: self.asks.clone(),
            difficulty: self.difficulty,
            candidate: self.candidate,
            witness_ticks: witness.actions.len(),
            witness_score: witness.score,
            optimal_ticks: report.finding(Criterion::Winnable).and_then(|finding| finding.optimal),
            search_calls: report.finding(Criterion::Winnable).map_or(0, Finding::calls),
            mcts: mcts.clone(),
            random: rate(Criterion::NotRandom)?,
            idle: rate(Criterion::NotIdle)?,
            ladder: report.ladder().cloned(),
            tier: self.demand.as_ref().map(Demand::tier),
            demand: self.demand.clone(),
        };
        Some((card, witness))
    }
}
