//! The stage in which the ladder, a list of reference players of increasing strength, plays a game's levels.

use super::game::Trial;
use super::level::Place;
use super::stage::{Passage, Refusal, Stage};
use crate::games::judges_seed;
use crate::games::{FoundLevel, Levels};
use crate::tally::Tally;
use engine::Game;
use validators::{Cost, Criterion, CriterionSet, Judging};

/// The maximum number of a game's levels that may fail when the ladder of reference players plays them. If more levels
/// fail, the game is rejected.
const MISFITS: u32 = 5;

impl Trial<'_> {
    pub(super) const LADDER: Stage<Self> = Stage {
        name: "ladder",
        purpose: "lets the ladder of players play every level if `skill` or `skill-overall` is requested, \
                  and checks the gates again",
        cost: "more than all earlier stages",
        criteria: CriterionSet::GAME.with(CriterionSet::GATES).with(CriterionSet::of(&[Criterion::Skill])),
        reasons: &["no level N"],
        replaces: Some("a level on which skill does not pay, up to five times per game"),
        ..Stage::once(Self::climb)
    };

    fn climb(&mut self, tally: &mut Tally) -> Passage {
        if self.levels.criteria.ask.only(CriterionSet::costing(Cost::Ladder)).is_empty() {
            return Ok(());
        }
        let game = &self.candidate.game;
        self.found = self.levels.judge_by_ladder(game, self.found.clone(), tally)?;
        let all = Levels { panel: self.demands.panel, ..self.levels };
        self.together = all.judge_together(game, &self.found, self.judges(), tally)?;
        Ok(())
    }
}

impl Levels<'_> {
    /// Judges the levels of a game with the ladder of reference players. A failing level is replaced with the next
    /// passing candidate for the same position.
    ///
    /// # Errors
    /// Returns an error if no candidate passes for a position, or if many levels fail, which is a sign of a bad game.
    pub(super) fn judge_by_ladder(
        &self,
        game: &Game,
        found: Vec<FoundLevel>,
        tally: &mut Tally,
    ) -> Result<Vec<FoundLevel>, Refusal> {
        let panel = self.panel_of(CriterionSet::costing(Cost::Ladder));
        let judge = |found: &mut FoundLevel, tally: &mut Tally| {
            let win = found.report.witness.clone();
            let judging = Judging::level(game, &found.level, judges_seed(&found.seed)).won_by(win);
            let report = panel.judge(judging.until_failure());
            tally.judgements(&report.judgements);
            let passes = report.passes();
            found.report.judgements.extend(report.judgements);
            passes
        };
        let mut levels: Vec<(u32, FoundLevel)> = (0..).zip(found).collect();
        let mut misfits = 0;
        // Start with the level most likely to fail: the last one, which demands the most of players.
        for number in (0..self.count).rev() {
            let at = number as usize;
            while !judge(&mut levels[at].1, tally) {
                tally.level_taken_back(Criterion::Skill.name());
                misfits += 1;
                if misfits > MISFITS {
                    return Err(Criterion::Skill.into());
                }
                let (_, misfit) = levels.remove(at);
                let place = Place { levels: self, game, number, others: &levels };
                let next = place.find(misfit.candidate + 1, tally).ok_or_else(|| place.refusal())?;
                levels.insert(at, (number, next));
            }
        }
        Ok(levels.into_iter().map(|(_, found)| found).collect())
    }
}
