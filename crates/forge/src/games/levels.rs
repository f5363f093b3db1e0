//! Levels for one game: candidates of the level generator until enough pass.

use super::place::Place;
use super::puzzles::PuzzleLevels;
use crate::card::LevelCard;
use crate::tally::Tally;
use base::{Seed, SeedPath};
use engine::{Analysis, Episode, Game, Level, Outcome};
use generators::kernels::Course;
use generators::levels::LevelConfig;
use std::collections::BTreeSet;
use validators::measures::Guards;
use validators::{
    CheckedCriteria, Cost, Criterion, CriterionSet, Demand, Effort, Finding, Judgement, Judging, Panel, Rate,
    Report, SkillOverall, Verdict, mcts_rate, used_rules,
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
pub(super) struct Drawn {
    pub(super) level: Level,
    /// The difficulty that its generator was asked for, from 0 to 1.
    pub(super) difficulty: f64,
    /// Its number among the candidates for its place, from 0.
    pub(super) candidate: u32,
    /// The seed of the candidate.
    pub(super) seed: SeedPath,
    /// A win that is known.
    pub(super) win: Option<Episode>,
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

/// The generator of the candidates for levels.
#[derive(Clone, Copy)]
pub enum LevelSource<'a> {
    /// Levels from the rules alone; each place has a difficulty of its own.
    Rules(&'a LevelConfig),
    /// The maps of a kernel; each place has a slot.
    Course(&'a Course),
    /// Puzzles of pushed things, locks or yards; each place has a tier.
    Puzzles(&'a PuzzleLevels),
}

impl LevelSource<'_> {
    /// The name in cards.
    fn name(self) -> &'static str {
        match self {
            LevelSource::Rules(_) => "constructive",
            LevelSource::Course(_) => "course",
            LevelSource::Puzzles(_) => "puzzle",
        }
    }
}

/// The levels of one candidate game.
pub struct Levels<'a> {
    /// The number of levels.
    pub count: u32,
    /// Candidates for each, at most.
    pub tries: u32,
    /// The generator of candidates.
    pub source: LevelSource<'a>,
    /// The criteria that each level and all levels together have to meet.
    pub criteria: &'a CheckedCriteria,
    /// The judges of these criteria.
    pub panel: &'a Panel,
    /// The seed of candidates and judges.
    pub seed: &'a SeedPath,
}

impl Levels<'_> {
    /// Finds levels that meet the criteria alone and together. `None` as soon as a place stays empty, or if the game does not meet a
    /// criterion on all levels together.
    pub fn find(&self, game: &Game, tally: &mut Tally) -> Option<FoundLevels> {
        tally.spend(Tally::of_lost, |tally| self.find_all(game, tally))
    }

    fn find_all(&self, game: &Game, tally: &mut Tally) -> Option<FoundLevels> {
        let levels = self.find_each(game, tally)?;
        match self.judge_together(game, &levels, self.seed.seed().child("judges of the game", 0), tally) {
            Ok(together) => Some(self.with_rates(game, levels, together, tally)),
            Err(obstacle) => {
                tally.game_rejected(obstacle.name());
                None
            }
        }
    }

    /// Adds the win rate of plain tree search on each level.
    pub(crate) fn with_rates(
        &self,
        game: &Game,
        levels: Vec<FoundLevel>,
        together: Vec<Judgement>,
        tally: &mut Tally,
    ) -> FoundLevels {
        let rate = |found: &FoundLevel| {
            let seed = found.seed.seed().child("mcts verdict", 0);
            let witness = found.report.witness.as_ref()?;
            Some(mcts_rate(game, &found.level, witness, self.criteria, seed))
        };
        let mcts: Vec<Rate> = levels.iter().filter_map(rate).collect();
        for rate in &mcts {
            tally.judge("rate of mcts", true, rate.calls);
        }
        FoundLevels { levels, mcts, together, seed: self.seed.clone() }
    }

    /// Finds a level for each place, from the easiest to the hardest. `None` as soon as a place stays empty, or if skill has no
    /// chance to pay over all of them.
    pub(crate) fn find_each(&self, game: &Game, tally: &mut Tally) -> Option<Vec<FoundLevel>> {
        let mut levels: Vec<(u32, FoundLevel)> = Vec::new();
        // Fail fast: the easiest may be too easy, and the hardest too hard.
        let ends = [0, self.count - 1].into_iter().take(self.count as usize);
        for number in ends.chain(1..self.count.max(1) - 1) {
            match Place::of(self, game, number, &levels).find(0, tally) {
                Some(level) => {
                    levels.push((number, level));
                    // In a short course the level between may bring something new.
                    let is_long =
                        matches!(self.source, LevelSource::Course(_)) && self.count as usize > OUTLINE;
                    if levels.len() == 2
                        && is_long
                        && !self.leaves_something(game, &levels[0].1, &levels[1..])
                    {
                        let Some(first) = self.another_introduction(game, &levels[0].1, &levels[1..], tally)
                        else {
                            tally.game_rejected(Criterion::Progression.name());
                            return None;
                        };
                        levels[0].1 = first;
                    }
                    if levels.len() == OUTLINE
                        && let Some(obstacle) = self.objection_to_outline(game, &levels, tally)
                    {
                        tally.game_rejected(obstacle.name());
                        return None;
                    }
                    if self.is_hopeless(game, &levels) {
                        tally.game_rejected(Criterion::SkillOverall.name());
                        return None;
                    }
                }
                None => {
                    tally.game_rejected(&format!("no level {number}"));
                    return None;
                }
            }
        }
        levels.sort_by_key(|(number, _)| *number);
        let mut levels: Vec<FoundLevel> = levels.into_iter().map(|(_, level)| level).collect();
        // What was asked for is a guess: how the ladder fared is known. Of equals, what was asked for. A course has an order.
        if matches!(self.source, LevelSource::Rules(_)) {
            levels.sort_by(|a, b| b.ease().total_cmp(&a.ease()));
        }
        Some(levels)
    }

    /// Another first level for a course, where the one that passed gives everything away: one of its next few candidates that
    /// does not.
    pub(super) fn another_introduction(
        &self,
        game: &Game,
        first: &FoundLevel,
        later: &[(u32, FoundLevel)],
        tally: &mut Tally,
    ) -> Option<FoundLevel> {
        tally.level_taken_back(Criterion::Progression.name());
        let next = first.candidate + 1;
        let few = Levels { tries: self.tries.min(next + INTRODUCTIONS), ..*self };
        Place::of(&few, game, 0, later).find(next, tally)
    }

    /// Whether the wins of later levels need a mechanic that the win of the first does not, if that is asked for.
    pub(super) fn leaves_something(
        &self,
        game: &Game,
        first: &FoundLevel,
        later: &[(u32, FoundLevel)],
    ) -> bool {
        if later.is_empty()
            || !self.criteria.includes(Criterion::Progression)
            || self.criteria.gates.growth == 0
        {
            return true;
        }
        let guards = Guards::of(&Analysis::of(game));
        let known = first.mechanics(game, &guards);
        later.iter().any(|(_, found)| !found.mechanics(game, &guards).is_subset(&known))
    }

    /// Returns the gate that the first two levels and the last of a course have no chance to pass together with the others:
    /// the last is easier or does not need what the first need, or there is less than half the drama.
    fn objection_to_outline(
        &self,
        game: &Game,
        levels: &[(u32, FoundLevel)],
        tally: &mut Tally,
    ) -> Option<Criterion> {
        if !matches!(self.source, LevelSource::Course(_)) || self.count as usize == OUTLINE {
            return None;
        }
        let asked = CriterionSet::of(&[Criterion::Progression, Criterion::Drama]);
        let panel = Panel::new(self.criteria.only(asked).for_some_levels(), Effort::Sequential);
        let mut levels: Vec<&(u32, FoundLevel)> = levels.iter().collect();
        levels.sort_by_key(|(number, _)| *number);
        let (boards, reports): (Vec<Level>, Vec<Report>) =
            levels.iter().map(|(_, found)| (found.level.clone(), found.report.clone())).unzip();
        let seed = self.seed.seed().child("outline", 0);
        let together = panel.judge(Judging::together(game, &boards, &reports, seed).until_failure());
        tally.judgements(&together);
        let obstacle = together.iter().find(|judgement| !judgement.finding.verdict.is_pass());
        obstacle.map(|judgement| judgement.criterion)
    }

    /// The judges of those criteria that are in the set.
    pub(super) fn panel_of(&self, set: CriterionSet) -> Panel {
        Panel::new(self.criteria.only(set), Effort::Sequential)
    }

    /// Whether skill has no chance to pay over all levels, after some of them: before the others cost as much again. After all of
    /// them, whether it does not pay.
    fn is_hopeless(&self, game: &Game, levels: &[(u32, FoundLevel)]) -> bool {
        let ladders: Vec<_> = levels.iter().filter_map(|(_, found)| found.report.ladder()).collect();
        let skill = SkillOverall { wins: self.criteria.skill_overall };
        self.criteria.includes(Criterion::SkillOverall)
            && skill.is_hopeless(&ladders, game.is_deterministic(), self.count as usize)
    }

    /// Returns the findings of the judges of the game.
    ///
    /// # Errors
    /// The first criterion that is not met.
    pub(crate) fn judge_together(
        &self,
        game: &Game,
        levels: &[FoundLevel],
        seed: Seed,
        tally: &mut Tally,
    ) -> Result<Vec<Judgement>, Criterion> {
        let (boards, reports): (Vec<Level>, Vec<Report>) =
            levels.iter().map(|found| (found.level.clone(), found.report.clone())).unzip();
        let together = self.panel.judge(Judging::together(game, &boards, &reports, seed).until_failure());
        tally.judgements(&together);
        match together.iter().find(|judgement| !judgement.finding.verdict.is_pass()) {
            Some(obstacle) => Err(obstacle.criterion),
            None => Ok(together),
        }
    }

    /// Judges the levels of a course by the ladder of players, which comes last because it is expensive: most games fail at cheaper
    /// criteria. A level that fails is replaced by the next candidate for its place that passes. `None`, with the reason in the
    /// tally, if there is none, or if so many fail that the game must be at fault.
    pub(crate) fn judge_by_ladder(
        &self,
        game: &Game,
        found: Vec<FoundLevel>,
        tally: &mut Tally,
    ) -> Option<Vec<FoundLevel>> {
        let panel = self.panel_of(CriterionSet::costing(Cost::Ladder));
        let judge = |found: &mut FoundLevel, tally: &mut Tally| {
            let (witness, seed) = (found.report.witness.clone()?, judges_seed(&found.seed));
            let judging = Judging::level(game, &found.level, seed).won_by(witness);
            let report = panel.judge(judging.until_failure());
            tally.judgements(&report.judgements);
            let passes = report.passes();
            found.report.judgements.extend(report.judgements);
            Some(passes)
        };
        let mut levels: Vec<(u32, FoundLevel)> = (0..).zip(found).collect();
        let mut misfits = 0;
        // Fail fast: the last level asks the most of players.
        for number in (0..self.count).rev() {
            let at = number as usize;
            while !judge(&mut levels[at].1, tally)? {
                tally.level_taken_back(Criterion::Skill.name());
                misfits += 1;
                if misfits > MISFITS {
                    tally.game_rejected(Criterion::Skill.name());
                    return None;
                }
                let (_, misfit) = levels.remove(at);
                let place = Place::of(self, game, number, &levels);
                let Some(next) = place.find(misfit.candidate + 1, tally) else {
                    tally.game_rejected(&format!("no level {number}"));
                    return None;
                };
                levels.insert(at, (number, next));
            }
        }
        Some(levels.into_iter().map(|(_, found)| found).collect())
    }

    /// Whether judges with other seeds accept the same levels, as far as the answers depend on chance. The first judges choose
    /// among candidates, so that their findings on the chosen ones are too good; here nothing is chosen. Cost: that of
    /// judging the accepted levels, without the search for a win.
    pub(crate) fn confirm(&self, game: &Game, levels: &[FoundLevel], seed: Seed, tally: &mut Tally) -> bool {
        let panel = Panel::new(self.criteria.without(CERTAIN), Effort::Sequential);
        let (mut boards, mut reports) = (Vec::new(), Vec::new());
        for (number, found) in (0..).zip(levels) {
            let Some(witness) = found.report.witness.clone() else { return false };
            let judging = Judging::level(game, &found.level, seed.child("level", number)).won_by(witness);
            let report = panel.judge(judging.until_failure());
            tally.judgements(&report.judgements);
            if !report.passes() {
                return false;
            }
            boards.push(found.level.clone());
            reports.push(report);
        }
        let judging = Judging::together(game, &boards, &reports, seed.child("game", 0));
        let together = panel.judge(judging.until_failure());
        tally.judgements(&together);
        together.iter().all(|judgement| judgement.finding.verdict.is_pass())
    }

    /// Whether the game passes the gates with each of `times` further seeds, when one win of each level is known, the witness. Cost:
    /// some seconds for each seed.
    pub(crate) fn confirm_gates(
        &self,
        game: &Game,
        levels: &[FoundLevel],
        seed: Seed,
        times: u64,
        tally: &mut Tally,
    ) -> bool {
        let panel = self.panel_of(CriterionSet::GATES);
        let boards: Vec<Level> = levels.iter().map(|found| found.level.clone()).collect();
        let report =
            |found: &FoundLevel| Report { judgements: Vec::new(), witness: found.report.witness.clone() };
        let reports: Vec<Report> = levels.iter().map(report).collect();
        (0..times).all(|number| {
            let judging = Judging::together(game, &boards, &reports, seed.child("judges", number));
            let together = panel.judge(judging.until_failure());
            tally.judgements(&together);
            together.iter().all(|judgement| judgement.finding.verdict.is_pass())
        })
    }

    /// Judges a level that was found for the game with another time limit, except by the ladder. The search for a win is carried
    /// over if the win still wins. The seeds are the same, so that a replay ends as before.
    pub(crate) fn rejudge(&self, game: &Game, found: &FoundLevel, tally: &mut Tally) -> Option<FoundLevel> {
        let level = game.level(&found.level.to_string()).ok()?;
        let witness = recorded(game, &level, found.report.witness.as_ref()?);
        let is_won = witness.outcome == Outcome::Won;
        let carried = if is_won { CriterionSet::of(&[Criterion::Winnable]) } else { CriterionSet::default() };
        let criteria = self.criteria.without(carried.with(CriterionSet::costing(Cost::Ladder)));
        let panel = Panel::new(criteria, Effort::Sequential);
        let FoundLevel { difficulty, candidate, .. } = *found;
        let (seed, win) = (found.seed.clone(), is_won.then_some(witness));
        let drawn = Drawn { level, difficulty, candidate, seed, win };
        let mut again = self.judge_drawn(&panel, game, drawn, tally)?;
        let carried =
            found.report.judgements.iter().filter(|judgement| carried.contains(judgement.criterion));
        for mut judgement in carried.cloned() {
            for episode in &mut judgement.finding.episodes {
                *episode = recorded(game, &again.level, episode);
            }
            if let Verdict::Pass { witness: Some(won) } = &mut judgement.finding.verdict {
                *won = recorded(game, &again.level, won);
            }
            again.report.judgements.push(judgement);
        }
        let place_of = |judgement: &Judgement| {
            found.report.judgements.iter().position(|before| before.criterion == judgement.criterion)
        };
        again.report.judgements.sort_by_key(place_of);
        again.asks.clone_from(&found.asks);
        Some(again)
    }

    /// Judges a candidate: `None` if it does not meet all criteria.
    pub(super) fn judge_drawn(
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

/// The levels of a course that are found first: two to begin with and the exam.
const OUTLINE: usize = 3;

/// Further candidates for the first level of a course where the one that passed gives everything away: games in which those
/// do, too, hardly ever have one that does not.
const INTRODUCTIONS: u32 = 3;

/// Levels of a course that may fail the ladder before its game is rejected.
const MISFITS: u32 = 5;

/// The criteria whose answer does not depend on chance once there is a witness.
const CERTAIN: CriterionSet =
    CriterionSet::of(&[Criterion::WellFormed, Criterion::Readable, Criterion::Winnable, Criterion::Length]);

/// The seed of the judges of a candidate.
pub(super) fn judges_seed(candidate: &SeedPath) -> SeedPath {
    candidate.child("judges", 0)
}

/// An episode replayed as one of another game.
fn recorded(game: &Game, level: &Level, played: &Episode) -> Episode {
    let (mut episode, mut state) = Episode::begin(game, level, played.seed);
    for &action in &played.actions {
        episode.play(game, &mut state, action);
    }
    episode.path.clone_from(&played.path);
    episode
}

impl FoundLevel {
    /// The interactions that its win executes, guards apart.
    pub(super) fn mechanics(&self, game: &Game, guards: &Guards) -> BTreeSet<usize> {
        let Some(win) = &self.report.witness else { return BTreeSet::new() };
        let guards: BTreeSet<usize> = guards.lines().collect();
        used_rules(game, &self.level, win).into_iter().filter(|line| !guards.contains(line)).collect()
    }

    /// Its ease for the ladder, from 0 to 1; the same for all levels if none played.
    fn ease(&self) -> f64 {
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
