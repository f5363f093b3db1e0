//! The stages of a requested level: the panel, and the order's requirements beyond the criteria.

use super::stage::{Passage, Refusal, Stage, walk};
use crate::levels::aim::{bears, wins};
use crate::levels::{LevelOrder, MadeLevel};
use crate::tally::Tally;
use base::{Seed, SeedPath};
use engine::{Analysis, Level};
use validators::{
    Case, CheckedCriteria, Criteria, Criterion, CriterionSet, Effort, Judging, Ladder, LadderConfig,
    NotRandom, Panel, Report, Validator,
};

/// The factor by which the second test of random play increases the number of episodes.
const LUCK_PLAYS: u32 = 5;
/// The factor by which the second test of random play raises the maximum fraction of wins. The panel's test has few
/// episodes, so its limit is strict.
const LUCK_WINS: f64 = 1.6;

/// The measurements of a level's difficulty by the ladder of reference players. Each entry is the factor applied to the
/// criteria's number of episodes, and the minimum distance between the ease and any other label. The first measurement
/// rejects most levels. The second plays more episodes, to correct for the selection of lucky levels.
const LADDERS: [(u64, f64); 2] = [(1, 0.03), (3, 0.045)];
/// The minimum fraction of all episodes of the ladder's reference players that must be won. A rarely won level might
/// have no win in a second measurement.
const BEATEN: f64 = 0.02;

/// The reason for rejecting a level whose difficulty differs from the requested one.
pub(crate) const DIFFICULTY: &str = "difficulty";

/// The final decision on an order's levels, made with fresh seeds.
pub(crate) struct LevelGate<'a> {
    analysis: &'a Analysis,
    order: &'a LevelOrder,
    panel: Panel,
    climb: Option<LadderConfig>,
    seed: Seed,
}

/// A requested level, and the stages' findings.
pub(super) struct RequestTrial<'a> {
    gate: &'a LevelGate<'a>,
    level: &'a Level,
    /// The seed for judging the level. The same level always gets the same verdict.
    seed: Seed,
    report: Report,
    /// The results of the ladder's reference players, which measure the difficulty; `None` if no difficulty was
    /// requested.
    ladder: Option<Ladder>,
}

impl<'a> LevelGate<'a> {
    pub(crate) fn new(
        analysis: &'a Analysis,
        order: &'a LevelOrder,
        criteria: &CheckedCriteria,
        seed: Seed,
    ) -> LevelGate<'a> {
        let climb = order.difficulty.map(|_| LadderConfig { held_out: Vec::new(), ..criteria.players() });
        let panel = Panel::new(criteria.clone(), Effort::Full);
        LevelGate { analysis, order, panel, climb, seed }
    }

    /// Takes a level through the stages. If a stage rejects the level, counts the reason in the result's tally, and
    /// returns `None`.
    pub(crate) fn judge(&self, number: u32, level: &Level) -> (Option<MadeLevel>, Tally) {
        let seed = self.seed.child(&level.digest().to_string(), 0);
        let report = Report { judgements: Vec::new(), witness: None };
        let mut trial = RequestTrial { gate: self, level, seed, report, ladder: None };
        let mut tally = Tally::default();
        match walk(&RequestTrial::STAGES, &mut trial, &mut tally) {
            Ok(()) => {
                let RequestTrial { report, ladder, .. } = trial;
                let made = MadeLevel { number, level: level.clone(), report: Some(report), ladder };
                return (Some(made), tally);
            }
            Err(Refusal::Because(why)) => tally.level_taken_back(&why),
            Err(Refusal::Counted) => {}
        }
        (None, tally)
    }
}

impl RequestTrial<'_> {
    pub(super) const PANEL: Stage<Self> = Stage {
        name: "panel",
        purpose: "judges every criterion of levels",
        cost: "up to the budget of `winnable`",
        criteria: CriterionSet::LEVEL,
        ..Stage::once(Self::ask_panel)
    };

    pub(super) const RANDOM_PLAY: Stage<Self> = Stage {
        name: "random play",
        purpose: "plays five times as many random episodes as the panel, which corrects for the selection \
                  of lucky levels",
        cost: "plays",
        criteria: CriterionSet::of(&[Criterion::NotRandom]),
        ..Stage::once(Self::play_more_at_random)
    };

    pub(super) const RULES_USED: Stage<Self> = Stage {
        name: "rules used",
        purpose: "requires that the win uses every rule that the order specifies",
        cost: "a replay",
        reasons: &["uses"],
        ..Stage::once(Self::ask_for_rules)
    };

    pub(super) const DIFFICULTY: Stage<Self> = Stage {
        name: DIFFICULTY,
        purpose: "if the order requests a difficulty, measures it with two ladders, the second three times \
                  as long",
        cost: "more than the other stages",
        reasons: &[DIFFICULTY],
        ..Stage::once(Self::measure_difficulty)
    };

    fn ask_panel(&mut self, tally: &mut Tally) -> Passage {
        let judging = Judging::level(self.gate.analysis.game(), self.level, self.seed.child("panel", 0));
        self.report = self.gate.panel.judge(judging.until_failure());
        let obstacle = self.report.first_obstacle().map(|judgement| judgement.criterion);
        let obstacle = obstacle.or(self.report.witness.is_none().then_some(Criterion::Winnable));
        tally.level(&self.report.judgements, obstacle.map(Criterion::name));
        if obstacle.is_none() { Ok(()) } else { Err(Refusal::Counted) }
    }

    fn play_more_at_random(&mut self, tally: &mut Tally) -> Passage {
        let Criteria { random_plays, random_wins, .. } = self.gate.order.criteria;
        let (plays, most) = (LUCK_PLAYS * random_plays, LUCK_WINS * random_wins);
        let more = NotRandom { plays, most, ticks: usize::MAX };
        let seed = self.seed.child("luck", 0).into();
        let finding = more.validate(Case { witness: None, ..self.case(&seed) });
        let passes = finding.verdict.is_pass();
        tally.judge(Criterion::NotRandom.name(), passes, finding.calls());
        if passes { Ok(()) } else { Err(Criterion::NotRandom.into()) }
    }

    fn ask_for_rules(&mut self, _: &mut Tally) -> Passage {
        let Some(win) = &self.report.witness else { return Ok(()) };
        let (analysis, uses) = (self.gate.analysis, &self.gate.order.uses);
        let are_used = uses.iter().all(|rule| rule.is_used(analysis, self.level, win));
        if are_used { Ok(()) } else { Err("uses".into()) }
    }

    fn measure_difficulty(&mut self, tally: &mut Tally) -> Passage {
        let (Some(climb), Some(asked)) = (&self.gate.climb, self.gate.order.difficulty) else {
            return Ok(());
        };
        for (times, margin) in LADDERS {
            let climb =
                LadderConfig { plays: climb.plays * times, calls: climb.calls * times, ..climb.clone() };
            let ladder = climb.ladder(self.case(&self.seed.child("ladder", times).into()));
            // A second measurement with other seeds should give the same label.
            let is_met = bears(&ladder, asked, margin) && wins(&ladder) >= BEATEN;
            let calls = ladder.rungs.iter().map(|fared| fared.rate.calls).sum();
            tally.judge(DIFFICULTY, is_met, calls);
            tally.unbeaten += u64::from(!is_met && wins(&ladder) == 0.0);
            self.ladder = Some(ladder);
            if !is_met {
                return Err(DIFFICULTY.into());
            }
        }
        Ok(())
    }

    fn case<'s>(&'s self, seed: &'s SeedPath) -> Case<'s> {
        let analysis = self.gate.analysis;
        let (game, witness) = (analysis.game(), self.report.witness.as_ref());
        Case { game, level: self.level, seed, analysis, witness }
    }
}
