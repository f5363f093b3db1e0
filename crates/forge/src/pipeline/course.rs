//! The stage that finds a game's levels, one for each position, and the stages that check the levels found so far.

use super::game::Trial;
use super::level::{Place, leaves_something};
use super::stage::{Passage, Refusal, Stage, walk};
use crate::games::{FoundLevel, Levels};
use crate::tally::Tally;
use engine::{Analysis, Game, Level};
use validators::{Criterion, CriterionSet, Effort, Judging, Panel, Report, SkillOverall};

/// The number of levels of a course (a game's levels in order of difficulty) to find first: the first two and the last.
const OUTLINE: usize = 3;

/// The number of further candidates to try for the first level of a game if the level found leaves no new mechanic for
/// later levels. If all of these candidates share the fault, more are unlikely to help.
const INTRODUCTIONS: u32 = 3;

/// The levels found so far for a game, in the order in which they were found.
pub(super) struct Begun<'a> {
    levels: &'a Levels<'a>,
    game: &'a Game,
    found: Vec<(u32, FoundLevel)>,
}

impl Trial<'_> {
    pub(super) const LEVELS: Stage<Self> = Stage {
        name: "levels",
        purpose: "finds a level for each position: first the first and the last position, then the \
                  positions between",
        cost: "seconds, which is most of the cost of a game",
        criteria: CriterionSet::of(&[Criterion::Progression, Criterion::Drama, Criterion::SkillOverall]),
        reasons: &["no level N"],
        replaces: Some(
            "a candidate, with the next candidate for its position: 16 per position, unless the order \
             says otherwise",
        ),
        ..Stage::once(Self::find_levels)
    };

    fn find_levels(&mut self, tally: &mut Tally) -> Passage {
        self.found = Begun::find_all(&self.levels, &self.candidate.game, tally)?;
        Ok(())
    }
}

impl<'a> Begun<'a> {
    pub(super) const INTRODUCTION: Stage<Self> = Stage {
        name: "introduction",
        purpose: "in a course of more than three levels, checks after the last level whether a win of a \
                  later level needs a mechanic that the first level does not need",
        cost: "a replay of each win",
        criteria: CriterionSet::of(&[Criterion::Progression]),
        replaces: Some("the first level, by one of its next three candidates"),
        ..Stage::once(Self::ask_for_something_left)
    };

    pub(super) const OUTLINE: Stage<Self> = Stage {
        name: "outline",
        purpose: "after the first two levels and the last level of a longer course, checks progression \
                  and half of the required drama, because the other levels could not compensate",
        cost: "a second",
        criteria: CriterionSet::of(&[Criterion::Progression, Criterion::Drama]),
        ..Stage::once(Self::judge_outline)
    };

    pub(super) const SKILL: Stage<Self> = Stage {
        name: "skill so far",
        purpose: "checks whether `skill-overall` can still pass, if the ladder has played",
        criteria: CriterionSet::of(&[Criterion::SkillOverall]),
        ..Stage::once(Self::ask_for_a_chance_of_skill)
    };

    /// Finds a level for each position, and returns them sorted from easiest to hardest.
    fn find_all(
        levels: &'a Levels<'a>,
        game: &'a Game,
        tally: &mut Tally,
    ) -> Result<Vec<FoundLevel>, Refusal> {
        let mut begun = Begun { levels, game, found: Vec::new() };
        // Start with the levels most likely to fail: the easiest may be too easy, and the hardest too hard.
        let ends = [0, levels.count - 1].into_iter().take(levels.count as usize);
        for number in ends.chain(1..levels.count.max(1) - 1) {
            let place = Place { levels, game, number, others: &begun.found };
            let level = place.find(0, tally).ok_or_else(|| place.refusal())?;
            begun.found.push((number, level));
            walk(&Self::STAGES, &mut begun, tally)?;
        }
        begun.found.sort_by_key(|(number, _)| *number);
        let mut found: Vec<FoundLevel> = begun.found.into_iter().map(|(_, level)| level).collect();
        // The requested difficulty is only a guess, but the result of the ladder's reference players is a measurement.
        // A course keeps its own order.
        if !levels.source.is_ordered() {
            found.sort_by(|a, b| b.ease().total_cmp(&a.ease()));
        }
        Ok(found)
    }

    /// Returns `true` if the levels form a course that has more levels than those found first.
    fn is_longer_than_outline(&self) -> bool {
        self.levels.source.is_course() && self.levels.count as usize > OUTLINE
    }

    fn ask_for_something_left(&mut self, tally: &mut Tally) -> Passage {
        // In a game with few levels, the middle level may introduce something new.
        if self.found.len() != 2 || !self.is_longer_than_outline() {
            return Ok(());
        }
        let Begun { levels, game, found } = self;
        let (first, later) = (&found[0].1, &found[1..]);
        if !leaves_something(levels, game, first, later) {
            let another = another_introduction(levels, game, first, later, tally);
            self.found[0].1 = another.ok_or(Criterion::Progression)?;
        }
        Ok(())
    }

    fn judge_outline(&mut self, tally: &mut Tally) -> Passage {
        if self.found.len() != OUTLINE || !self.is_longer_than_outline() {
            return Ok(());
        }
        let Levels { criteria, seed, .. } = *self.levels;
        let asked = CriterionSet::of(&[Criterion::Progression, Criterion::Drama]);
        let panel = Panel::new(criteria.only(asked).for_some_levels(), Effort::Sequential);
        let mut found: Vec<&(u32, FoundLevel)> = self.found.iter().collect();
        found.sort_by_key(|(number, _)| *number);
        let (boards, reports): (Vec<Level>, Vec<Report>) =
            found.iter().map(|(_, found)| (found.level.clone(), found.report.clone())).unzip();
        let judging = Judging::together(self.game, &boards, &reports, seed.seed().child("outline", 0));
        let together = panel.judge(judging.until_failure());
        tally.judgements(&together);
        let obstacle = together.iter().find(|judgement| !judgement.finding.verdict.is_pass());
        obstacle.map_or(Ok(()), |judgement| Err(judgement.criterion.into()))
    }

    fn ask_for_a_chance_of_skill(&mut self, _: &mut Tally) -> Passage {
        let Levels { criteria, count, .. } = *self.levels;
        let ladders: Vec<_> = self.found.iter().filter_map(|(_, found)| found.report.ladder()).collect();
        let skill = SkillOverall { wins: criteria.skill_overall };
        if !criteria.includes(Criterion::SkillOverall) {
            return Ok(());
        }
        let analysis = Analysis::of(self.game);
        let planned = self.found.iter().all(|(_, found)| analysis.is_deterministic_in(&found.level));
        if skill.is_hopeless(&ladders, planned, count as usize) {
            Err(Criterion::SkillOverall.into())
        } else {
            Ok(())
        }
    }
}

/// Replaces a first level that leaves no new mechanic for later levels. Tries the next candidates until one leaves such
/// a mechanic; `None` if none of them does.
pub(super) fn another_introduction(
    levels: &Levels<'_>,
    game: &Game,
    first: &FoundLevel,
    later: &[(u32, FoundLevel)],
    tally: &mut Tally,
) -> Option<FoundLevel> {
    tally.level_taken_back(Criterion::Progression.name());
    let next = first.candidate + 1;
    let few = Levels { tries: levels.tries.min(next + INTRODUCTIONS), ..*levels };
    Place { levels: &few, game, number: 0, others: later }.find(next, tally)
}
