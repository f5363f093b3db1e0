//! The search for a level for one place of a game: candidates of the generator, until one passes and fits beside the others.

use super::levels::{Drawn, FoundLevel, LevelSource, Levels, judges_seed};
use super::likeness::are_one_board;
use super::puzzles::{self, PuzzleGenerator, PuzzleLevels};
use crate::tally::Tally;
use agents::systematic_seed;
use base::{Digest, Seed, SeedPath};
use engine::{Action, Analysis, Game, Level};
use generators::kernels::{Course, CourseLevel, Slot};
use generators::levels::{ConstructiveLevels, LevelConfig};
use generators::{GenerateError, Generator};
use std::slice;
use validators::{
    Criterion, CriterionSet, Demand, Effort, Finding, Judgement, Judging, NotInstant, OpenGround, Panel,
    Verdict,
};

/// The place of a level in a game, beside the levels that other places have.
pub(super) struct Place<'a> {
    levels: &'a Levels<'a>,
    game: &'a Game,
    number: u32,
    /// The levels of other places, each with its number.
    others: &'a [(u32, FoundLevel)],
}

/// A generator of candidates for one place.
enum PlaceGenerator<'a> {
    Rules(Box<ConstructiveLevels<'a>>),
    Course(&'a Course, Slot),
    Puzzles(PuzzleGenerator<'a>),
}

/// The seed of the win of a candidate's puzzle: that of the search which the win replaces.
fn win_seed(candidate: &SeedPath) -> SeedPath {
    systematic_seed(&Criterion::Winnable.seed(&judges_seed(candidate)))
}

/// A level, its question to the player if it is one of a course, and actions that win it if they are known.
type Generated = (Level, Option<String>, Option<Vec<Action>>);

impl PlaceGenerator<'_> {
    /// Generates the candidate of a seed.
    fn generate(&self, game: &Game, candidate: &SeedPath) -> Result<Generated, GenerateError> {
        let seed = candidate.seed().child("layout", 0);
        match self {
            PlaceGenerator::Rules(levels) => Ok((levels.generate(seed)?, None, None)),
            PlaceGenerator::Puzzles(puzzles) => {
                let far = || GenerateError::Unlucky("no puzzle is far enough from its solution".to_owned());
                let win = win_seed(candidate).seed();
                let (level, known) = puzzles.create_solved(game, seed, win).ok_or_else(far)?;
                Ok((level, None, Some(known)))
            }
            PlaceGenerator::Course(course, slot) => {
                let CourseLevel { text, asks, .. } = course.level(*slot, seed)?;
                let level =
                    game.level(&text).map_err(|problems| GenerateError::Unlucky(problems.to_string()))?;
                Ok((level, Some(asks), None))
            }
        }
    }
}

impl<'a> Place<'a> {
    /// The place of a number.
    pub(super) fn of(
        levels: &'a Levels<'a>,
        game: &'a Game,
        number: u32,
        others: &'a [(u32, FoundLevel)],
    ) -> Place<'a> {
        Place { levels, game, number, others }
    }

    /// Returns the first candidate from number `from` on that passes.
    pub(super) fn find(&self, from: u32, tally: &mut Tally) -> Option<FoundLevel> {
        let generator = match self.generator() {
            Ok(generator) => generator,
            Err(error) => {
                tally.game_rejected(&error.to_string());
                return None;
            }
        };
        let Levels { tries, criteria, .. } = self.levels;
        let mut left = tries.saturating_sub(from);
        for candidate in from..*tries {
            if left == 0 {
                break;
            }
            left -= 1;
            let calls = tally.calls;
            let found = tally.spend(Tally::of_refused, |tally| self.candidate(&generator, candidate, tally));
            if found.is_some() {
                return found;
            }
            // A search in vain for a win is dear: it counts as several candidates.
            if tally.calls - calls > criteria.budget / 2 {
                left = left.saturating_sub(if self.others.len() < STAKE { EARLY_DEAR } else { DEAR });
            }
        }
        None
    }

    /// The difficulty that its level should have, from 0 to 1.
    fn difficulty(&self) -> f64 {
        f64::from(self.number) / f64::from((self.levels.count - 1).max(1))
    }

    fn generator(&self) -> Result<PlaceGenerator<'a>, GenerateError> {
        let difficulty = self.difficulty();
        match self.levels.source {
            LevelSource::Rules(config) => {
                let config = LevelConfig { difficulty, ..config.clone() };
                let levels = ConstructiveLevels::new(self.game, config)?;
                Ok(PlaceGenerator::Rules(Box::new(levels)))
            }
            LevelSource::Course(course) => {
                let last = Slot::ALL.len() - 1;
                let slot = Slot::ALL[(difficulty * last as f64).round() as usize];
                Ok(PlaceGenerator::Course(course, slot))
            }
            LevelSource::Puzzles(puzzles) => {
                puzzles.generator(self.game, self.number).map(PlaceGenerator::Puzzles)
            }
        }
    }

    /// Judges the candidate of a number: `None`, with the reason in the tally, if it does not pass.
    fn candidate(
        &self,
        generator: &PlaceGenerator<'_>,
        candidate: u32,
        tally: &mut Tally,
    ) -> Option<FoundLevel> {
        let Place { levels, game, number, others } = *self;
        let places = levels.seed.child("level", u64::from(number));
        let seed = places.child("candidate", u64::from(candidate));
        let Ok((level, asks, known)) = generator.generate(game, &seed) else {
            tally.no_level("level generator");
            return None;
        };
        let taken: Vec<Digest> = others.iter().map(|(_, found)| found.level.digest()).collect();
        if taken.contains(&level.digest()) {
            tally.no_level("the same level twice");
            return None;
        }
        let drawn = Drawn { level, difficulty: self.difficulty(), candidate, seed, win: None };
        if let (LevelSource::Puzzles(puzzles), Some(known)) = (levels.source, known) {
            return self.judge_puzzle(puzzles, drawn, known, tally);
        }
        let level = &drawn.level;
        let is_shown = |(_, other): &(u32, FoundLevel)| are_one_board(level, &other.level);
        if matches!(levels.source, LevelSource::Course(_)) && others.iter().any(is_shown) {
            tally.no_level("like another level");
            return None;
        }
        if self.is_narrow(level) {
            tally.no_level(Criterion::OpenGround.name());
            return None;
        }
        if self.is_walked_through(level, drawn.seed.seed()) {
            tally.no_level(Criterion::NotInstant.name());
            return None;
        }
        let found = levels.judge_drawn(levels.panel, game, drawn, tally)?;
        let LevelSource::Course(_) = levels.source else { return Some(found) };
        match self.objection(&found, tally) {
            Some(why) => {
                tally.level_taken_back(why);
                None
            }
            None => Some(FoundLevel { asks, ..found }),
        }
    }

    /// Returns what keeps a level of a course that passes alone from its place.
    fn objection(&self, found: &FoundLevel, tally: &mut Tally) -> Option<&'static str> {
        let in_order = |(place, other): &(u32, FoundLevel)| match *place < self.number {
            true => asks_as_much(found, other),
            false => asks_as_much(other, found),
        };
        if !self.others.iter().all(in_order) {
            Some("less than an earlier level")
        } else if self.number == 0 && !self.levels.leaves_something(self.game, found, self.others) {
            Some(Criterion::Progression.name())
        } else if self.is_won_too_soon(found) {
            Some(Criterion::NotInstant.name())
        } else if self.is_tedious(found, tally) {
            Some(Criterion::NoDeadTime.name())
        } else {
            None
        }
    }

    /// A puzzle of the tier of its place: won, judged, and measured; the search for its shortest win is that of `winnable`. Cost: a
    /// proof of the shortest win within the share of the budget for it, the judges, and [`Demand::of`].
    fn judge_puzzle(
        &self,
        puzzles: &PuzzleLevels,
        drawn: Drawn,
        known: Vec<Action>,
        tally: &mut Tally,
    ) -> Option<FoundLevel> {
        let (criteria, seed) = (self.levels.criteria, drawn.seed.clone());
        let analysis = Analysis::of(self.game);
        let calls = (criteria.budget as f64 * criteria.shortest) as u64;
        let (win, shortest, calls) = puzzles::win(&analysis, &drawn.level, known, calls, &win_seed(&seed))?;
        tally.judge(Criterion::Winnable.name(), true, calls);
        let others = criteria.without(CriterionSet::of(&[Criterion::Winnable]));
        let drawn = Drawn { win: Some(win.clone()), ..drawn };
        let panel = Panel::new(others, Effort::Sequential);
        let mut found = self.levels.judge_drawn(&panel, self.game, drawn, tally)?;
        let demand = Demand::of(&analysis, &found.level, &win, shortest, seed.seed().child("demand", 0))?;
        let optimal = shortest.then_some(win.actions.len());
        let verdict = Verdict::Pass { witness: Some(win) };
        let finding = Finding { searched: Some(calls), optimal, ..Finding::from(verdict) };
        found.report.judgements.insert(0, Judgement { criterion: Criterion::Winnable, finding });
        if demand.tier() != puzzles.tier(self.number) {
            tally.level_taken_back("tier");
            return None;
        }
        Some(FoundLevel { demand: Some(demand), ..found })
    }

    /// The gate against instant wins, if it is asked of the level of a place alone: of a course with room for an exception, the
    /// second level may be one.
    fn not_instant(&self) -> Option<NotInstant> {
        let Levels { criteria, count, source, .. } = self.levels;
        let gates = &criteria.gates;
        let exceptions = gates.instant_levels * f64::from(count.saturating_sub(1));
        let is_asked = criteria.includes(Criterion::NotInstant) && matches!(source, LevelSource::Course(_));
        let first = if exceptions >= 1.0 { 2 } else { 1 };
        (is_asked && self.number >= first).then(|| NotInstant(gates.clone()))
    }

    /// Tests whether a level of a course has so much narrow ground, together with those found before it, that the game could not pass
    /// the gate if all others had none.
    fn is_narrow(&self, level: &Level) -> bool {
        let Levels { criteria, source, count, .. } = self.levels;
        if !criteria.includes(Criterion::OpenGround) || !matches!(source, LevelSource::Course(_)) {
            return false;
        }
        let analysis = Analysis::of(self.game);
        let levels = self.others.iter().map(|(_, found)| &found.level).chain([level]);
        let shares = levels.filter_map(|level| OpenGround::narrow(&analysis, level));
        shares.sum::<f64>() > criteria.gates.narrow * f64::from(*count)
    }

    /// Tests whether whoever walks to the nearest goal wins a level, before a win is searched for.
    fn is_walked_through(&self, level: &Level, seed: Seed) -> bool {
        let (ticks, seed) = (self.levels.criteria.most_ticks, seed.child("nearest goal", 0));
        self.not_instant().is_some_and(|gate| gate.is_walked_through(self.game, level, ticks, seed))
    }

    fn is_won_too_soon(&self, found: &FoundLevel) -> bool {
        let Some(win) = &found.report.witness else { return false };
        let analysis = Analysis::of(self.game);
        self.not_instant().is_some_and(|gate| gate.is_too_short(&analysis, &found.level, win))
    }

    /// Tests whether the win of a level has dead time: the gate looks at each level alone.
    fn is_tedious(&self, found: &FoundLevel, tally: &mut Tally) -> bool {
        let panel = self.levels.panel_of(CriterionSet::of(&[Criterion::NoDeadTime]));
        let (board, report) = (slice::from_ref(&found.level), slice::from_ref(&found.report));
        let judging = Judging::together(self.game, board, report, found.seed.seed().child("dead time", 0));
        let judged = panel.judge(judging.until_failure());
        tally.judgements(&judged);
        judged.iter().any(|judgement| !judgement.finding.verdict.is_pass())
    }
}

/// Tests whether winning a level takes about as long as winning an earlier one of a course, or longer.
fn asks_as_much(found: &FoundLevel, earlier: &FoundLevel) -> bool {
    let ticks = |found: &FoundLevel| found.report.witness.as_ref().map_or(0, |win| win.actions.len());
    ticks(found) as f64 >= LATER_SHARE * ticks(earlier) as f64
}

/// The share of the ticks of an earlier level's win that a later one takes at least: a course never asks for much less.
const LATER_SHARE: f64 = 0.6;

/// Further candidates that a level costs whose win was searched for in vain.
const DEAR: u32 = 1;
/// The same while the game has fewer than [`STAKE`] levels, so that little is lost with it: where two searches are in vain, the next
/// succeeds in one of four.
const EARLY_DEAR: u32 = 5;
const STAKE: usize = 2;
