//! The final decision on a level: the panel, and what the order asks beside the criteria.

use super::aim::{bears, wins};
use super::order::LevelOrder;
use base::Seed;
use engine::{Analysis, Level};
use validators::{
    Case, CheckedCriteria, Criteria, Criterion, Difficulty, Effort, Finding, Judging, Ladder, LadderConfig,
    NotRandom, Panel, Report, Validator,
};

/// Makes the final decision on levels, with fresh seeds.
pub(super) struct LevelGate<'a> {
    analysis: &'a Analysis,
    order: &'a LevelOrder,
    panel: Panel,
    climb: Option<LadderConfig>,
    seed: Seed,
}

/// The decision on a level.
pub(super) struct Ruling {
    /// The first criterion that is not met.
    pub(super) obstacle: Option<&'static str>,
    /// The findings of the panel.
    pub(super) report: Report,
    /// The ladder that tells how hard it is, if that was asked.
    pub(super) ladder: Option<Ladder>,
    /// Forward-model calls.
    pub(super) calls: u64,
    /// `true` if only its difficulty is wrong, and no player of the ladder wins it.
    pub(super) is_unbeaten: bool,
}

impl<'a> LevelGate<'a> {
    pub(super) fn new(
        analysis: &'a Analysis,
        order: &'a LevelOrder,
        criteria: &CheckedCriteria,
        seed: Seed,
    ) -> LevelGate<'a> {
        let climb = order.difficulty.map(|_| LadderConfig { held_out: Vec::new(), ..criteria.players() });
        let panel = Panel::new(criteria.clone(), Effort::Full);
        LevelGate { analysis, order, panel, climb, seed }
    }

    /// Judges a level. The same level gets the same answer, whoever asks and when.
    pub(super) fn judge(&self, level: &Level) -> Ruling {
        let game = self.analysis.game();
        let seed = self.seed.child(&level.digest().to_string(), 0);
        let judging = Judging::level(game, level, seed.child("panel", 0));
        let report = self.panel.judge(judging.until_failure());
        let calls = report.judgements.iter().map(|judgement| judgement.finding.calls()).sum();
        let obstacle = report.first_obstacle().map(|judgement| judgement.criterion.name());
        let mut judged = Ruling { obstacle, report, ladder: None, calls, is_unbeaten: false };
        let (None, Some(witness)) = (obstacle, judged.report.witness.clone()) else {
            judged.obstacle = obstacle.or(Some(Criterion::Winnable.name()));
            return judged;
        };
        let more = self.more_random_plays(level, seed);
        judged.calls += more.calls();
        if !more.verdict.is_pass() {
            judged.obstacle = Some(Criterion::NotRandom.name());
            return judged;
        }
        if !self.order.uses.iter().all(|rule| rule.is_used(self.analysis, level, &witness)) {
            judged.obstacle = Some("uses");
            return judged;
        }
        if let (Some(climb), Some(asked)) = (&self.climb, self.order.difficulty) {
            // A first ladder turns down most; the second is longer, because who is the best of many was lucky, too.
            for (times, margin) in LADDERS {
                let seed = seed.child("ladder", times).into();
                let case =
                    Case { game, level, seed: &seed, analysis: self.analysis, witness: Some(&witness) };
                let climb =
                    LadderConfig { plays: climb.plays * times, calls: climb.calls * times, ..climb.clone() };
                let ladder = climb.ladder(case);
                judged.calls += ladder.rungs.iter().map(|fared| fared.rate.calls).sum::<u64>();
                let is_met = is_within(&ladder, asked, margin);
                judged.is_unbeaten = !is_met && wins(&ladder) == 0.0;
                judged.ladder = Some(ladder);
                if !is_met {
                    judged.obstacle = Some("difficulty");
                    break;
                }
            }
        }
        judged
    }

    /// More plays of random keys: who has the fewest wins of many was lucky, too.
    fn more_random_plays(&self, level: &Level, seed: Seed) -> Finding {
        let Criteria { random_plays, random_wins, .. } = self.order.criteria;
        let (plays, most) = (LUCK_PLAYS * random_plays, LUCK_WINS * random_wins);
        let more = NotRandom { plays, most, ticks: usize::MAX };
        let seed = seed.child("luck", 0).into();
        more.validate(Case {
            game: self.analysis.game(),
            level,
            seed: &seed,
            analysis: self.analysis,
            witness: None,
        })
    }
}

/// The factor by which the random plays of the criteria are played once more.
const LUCK_PLAYS: u32 = 5;
/// The factor of the criteria's share that they may win: that of the panel is one of a few, and so a strict one.
const LUCK_WINS: f64 = 1.6;

/// The ladders that a level has to climb for its difficulty: how many times the plays of the criteria, and how far the ease
/// must be from any other label.
const LADDERS: [(u64, f64); 2] = [(1, 0.03), (3, 0.045)];

/// The share of all plays of a ladder that have to be won: a level that hardly anybody wins may find nobody the next time.
const BEATEN: f64 = 0.02;

/// Whether a level bears a label with a margin: another look with other seeds should find the label too.
fn is_within(ladder: &Ladder, asked: Difficulty, margin: f64) -> bool {
    bears(ladder, asked, margin) && wins(ladder) >= BEATEN
}
