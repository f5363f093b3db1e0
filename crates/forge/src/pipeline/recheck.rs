//! Stages that judge an accepted game again with different judges and seeds, and the stage that creates the game's
//! card.

use super::game::Trial;
use super::stage::{Passage, Stage};
use crate::games::{FoundLevel, FoundLevels, Levels};
use crate::tally::Tally;
use base::Seed;
use engine::{Game, Level};
use validators::{Criterion, CriterionSet, Effort, Judging, Panel, Rate, Report, mcts_rate};

/// The criteria whose verdicts do not depend on randomness once a witness exists. Second judges skip these criteria.
const CERTAIN: CriterionSet =
    CriterionSet::of(&[Criterion::WellFormed, Criterion::Readable, Criterion::Winnable, Criterion::Length]);

/// The reason for rejecting a game that its first judges accepted by luck.
const SECOND_JUDGES: &str = "second judges";
/// The reason for rejecting a game that passes the gates with some seeds but fails them with others.
const FURTHER_JUDGES: &str = "further judges";
/// The reason for rejecting a game whose judges' results are not sufficient for a card.
const NO_CARD: &str = "no card";

impl Trial<'_> {
    pub(super) const SECOND_JUDGES: Stage<Self> = Stage {
        name: SECOND_JUDGES,
        purpose: "repeats every check that depends on randomness with different seeds, which corrects for \
                  the selection of lucky candidates",
        cost: "as much as judging the accepted levels, without searches for wins",
        reasons: &[SECOND_JUDGES],
        ..Stage::once(Self::ask_second_judges)
    };

    pub(super) const FURTHER_JUDGES: Stage<Self> = Stage {
        name: FURTHER_JUDGES,
        purpose: "repeats the gates with ten other seeds (three in a release), given one win of each level",
        cost: "seconds for each seed",
        reasons: &[FURTHER_JUDGES],
        ..Stage::once(Self::ask_further_judges)
    };

    pub(super) const CARD: Stage<Self> = Stage {
        name: "card",
        purpose: "measures the win rate of plain tree search on each level, and writes the card",
        cost: "a second",
        reasons: &[NO_CARD],
        ..Stage::once(Self::write_card)
    };

    fn ask_second_judges(&mut self, tally: &mut Tally) -> Passage {
        let mut spent = Tally::default();
        let seed = self.levels.seed.seed().child(SECOND_JUDGES, 0);
        let agrees = self.levels.passes_with(&self.candidate.game, &self.found, seed, &mut spent);
        tally.judge(SECOND_JUDGES, agrees, spent.calls);
        if agrees { Ok(()) } else { Err(SECOND_JUDGES.into()) }
    }

    fn ask_further_judges(&mut self, tally: &mut Tally) -> Passage {
        let mut spent = Tally::default();
        let seed = self.levels.seed.seed().child(FURTHER_JUDGES, 0);
        let (game, times) = (&self.candidate.game, self.demands.further_judges);
        let agree = self.levels.passes_gates_with(game, &self.found, seed, times, &mut spent);
        tally.judge(FURTHER_JUDGES, agree, spent.calls);
        if agree { Ok(()) } else { Err(FURTHER_JUDGES.into()) }
    }

    fn write_card(&mut self, tally: &mut Tally) -> Passage {
        let rate = |found: &FoundLevel| {
            let seed = found.seed.seed().child("mcts verdict", 0);
            let witness = found.report.witness.as_ref()?;
            Some(mcts_rate(&self.candidate.game, &found.level, witness, self.levels.criteria, seed))
        };
        let mcts: Vec<Rate> = self.found.iter().filter_map(rate).collect();
        for rate in &mcts {
            tally.judge("rate of mcts", true, rate.calls);
        }
        let (levels, together) = (std::mem::take(&mut self.found), std::mem::take(&mut self.together));
        let found = FoundLevels { levels, mcts, together, seed: self.levels.seed.clone() };
        self.made = self.candidate.clone().finish(found, self.demands.canary);
        if self.made.is_some() { Ok(()) } else { Err(NO_CARD.into()) }
    }
}

impl Levels<'_> {
    /// Returns `true` if judges with a different seed accept the same levels by all criteria that depend on
    /// randomness.
    pub(super) fn passes_with(
        &self,
        game: &Game,
        levels: &[FoundLevel],
        seed: Seed,
        tally: &mut Tally,
    ) -> bool {
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

    /// Returns `true` if the game passes the gates with each of `times` further seeds. For these checks, the only
    /// known win of each level is its witness.
    fn passes_gates_with(
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
}
