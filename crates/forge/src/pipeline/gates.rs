//! The stage that judges a game's levels as a whole.

use super::course::another_introduction;
use super::game::Trial;
use super::level::leaves_something;
use super::stage::{Passage, Stage};
use crate::games::{FoundLevel, Levels};
use crate::tally::Tally;
use base::Seed;
use engine::{Game, Level};
use validators::{Criterion, CriterionSet, Judgement, Judging, Report};

impl Trial<'_> {
    pub(super) const GATES: Stage<Self> = Stage {
        name: "gates",
        purpose: "judges all levels together by every criterion of games that the order requests",
        cost: "seconds",
        criteria: CriterionSet::GAME.with(CriterionSet::GATES),
        replaces: Some(
            "the first level of a course, if `progression` fails because that level already uses every mechanic",
        ),
        ..Stage::once(Self::judge_all_levels)
    };

    /// Returns the seed for judging the levels as a whole.
    pub(super) fn judges(&self) -> Seed {
        self.levels.seed.seed().child("judges of the game", 0)
    }

    fn judge_all_levels(&mut self, tally: &mut Tally) -> Passage {
        let (levels, game, judges) = (&self.levels, &self.candidate.game, self.judges());
        let mut together = levels.judge_together(game, &self.found, judges, tally);
        if levels.source.is_course()
            && together.as_ref().is_err_and(|obstacle| *obstacle == Criterion::Progression)
            && let Some((first, later)) = self.found.split_first()
        {
            let later: Vec<(u32, FoundLevel)> = (1..).zip(later.iter().cloned()).collect();
            if !leaves_something(levels, game, first, &later)
                && let Some(another) = another_introduction(levels, game, first, &later, tally)
            {
                self.found[0] = another;
                together = levels.judge_together(game, &self.found, judges, tally);
            }
        }
        self.together = together?;
        Ok(())
    }
}

impl Levels<'_> {
    /// Returns the findings of the game's judges.
    ///
    /// # Errors
    /// Returns the first unmet criterion.
    pub(super) fn judge_together(
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
}
