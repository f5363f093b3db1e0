//! A game's levels, and the request for them.

use crate::card::LevelCard;
use crate::games::found_level::{FoundLevel, judges_seed};
use crate::pipeline::BoardSource;
use crate::tally::Tally;
use base::SeedPath;
use engine::{Episode, Game, Level};
use std::collections::BTreeSet;
use validators::measures::Guards;
use validators::{
    CheckedCriteria, Criterion, CriterionSet, Demand, Effort, Finding, Judgement, Judging, Panel, Rate,
    used_rules,
};

/// An unjudged candidate for a level.
#[derive(Clone)]
pub(crate) struct Drawn {
    pub(crate) level: Level,
    /// The difficulty requested from the generator, from 0 to 1.
    pub(crate) difficulty: f64,
    /// The candidate's index among the candidates for its position, from 0.
    pub(crate) candidate: u32,
    /// The candidate's seed.
    pub(crate) seed: SeedPath,
    /// A known win; `None` if no win is known.
    pub(crate) win: Option<Episode>,
}

/// The levels of a game, and the findings about them as a whole.
#[derive(Clone, Debug)]
pub struct FoundLevels {
    /// The levels in the order of the game. If a ladder (reference players of increasing strength) played them, they
    /// are sorted from easiest to hardest for these players. Otherwise they are in the requested order.
    pub levels: Vec<FoundLevel>,
    /// The win rate of plain tree search on each level.
    pub mcts: Vec<Rate>,
    /// The findings of the judges for the whole game.
    pub together: Vec<Judgement>,
    /// The seed for candidates and judges.
    pub seed: SeedPath,
}

/// Finished levels, as the source of a game's levels. Each position has one candidate.
pub struct FinishedLevels(pub Vec<Level>);

/// The request for the levels of a candidate game.
#[derive(Clone, Copy)]
pub struct Levels<'a> {
    /// The number of levels.
    pub count: u32,
    /// The maximum number of candidates for each level.
    pub tries: u32,
    /// The source of candidates.
    pub source: &'a dyn BoardSource,
    /// The criteria that each level, and all levels together, must meet.
    pub criteria: &'a CheckedCriteria,
    /// The judges of these criteria.
    pub panel: &'a Panel,
    /// The seed for candidates and judges.
    pub seed: &'a SeedPath,
}

impl Levels<'_> {
    /// Returns the judges for the requested criteria that are in `set`.
    pub(crate) fn panel_of(&self, set: CriterionSet) -> Panel {
        Panel::new(self.criteria.only(set), Effort::Sequential)
    }

    /// Judges a candidate. Returns `None` if the candidate fails a criterion.
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
    /// Returns the interactions that the level's win executes, not counting guards (rules that only keep sprites on the
    /// board and out of walls).
    pub(crate) fn mechanics(&self, game: &Game, guards: &Guards) -> BTreeSet<usize> {
        let Some(win) = &self.report.witness else { return BTreeSet::new() };
        let guards: BTreeSet<usize> = guards.lines().collect();
        used_rules(game, &self.level, win).into_iter().filter(|line| !guards.contains(line)).collect()
    }

    /// Returns the level's ease as measured by the ladder (reference players of increasing strength), from 0 to 1. If
    /// no ladder played, the ease is 0 for all levels.
    pub(crate) fn ease(&self) -> f64 {
        self.report.ladder().and_then(|ladder| ladder.ease).unwrap_or_default()
    }

    /// Returns the level's card and its winning episode; `None` unless idle play, random play and winnability have all
    /// been judged.
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
