//! What makes one level better than another, for an order.

use super::order::LevelOrder;
use engine::{Analysis, Episode, Level};
use generators::Axis;
use validators::{Case, Climb, Difficulty, Ladder, Measures, RuleRef};

/// What a search strives for.
pub(super) struct Aim<'a> {
    analysis: &'a Analysis,
    order: &'a LevelOrder,
    /// The players that tell how hard a level is, if that is asked.
    climb: Option<Climb>,
}

/// What the aim says of a level that can be won.
pub(super) struct Told {
    /// How much of what the order asks of the win it meets, from 0.0 to 1.0.
    pub(super) constraint: f64,
    /// How good the level is, from 0.0 to 1.0.
    pub(super) objective: f64,
    /// Forward-model calls.
    pub(super) calls: u64,
}

/// Plays of each player of the ladder in a look.
const PLAYS: u64 = 4;
/// So much of a label's eases, on either side, is not aimed at: another look may find the level beyond.
pub(super) const MARGIN: f64 = 0.05;
/// A level is long enough if the avatar could cross the board so often in the ticks of the win.
const CROSSINGS: f64 = 2.5;
/// The same for the measure of an archive: longer wins all share its last bin.
const LONGEST: f64 = 6.0;

impl<'a> Aim<'a> {
    /// The aim of an order; only those of `players` that look ahead tell a difficulty.
    pub(super) fn new(analysis: &'a Analysis, order: &'a LevelOrder) -> Aim<'a> {
        let climb = order.difficulty.map(|_| Climb {
            plays: PLAYS,
            held_out: Vec::new(),
            ..order.criteria.climb().expect("the criteria were checked")
        });
        Aim { analysis, order, climb }
    }

    pub(super) fn tell(&self, case: Case<'_>) -> Told {
        let witness = case.witness.expect("a level that can be won");
        let ticks = witness.actions.len() as f64;
        let least = self.order.min_solution.unwrap_or(0).max(self.order.criteria.least_ticks) as f64;
        let mut constraint = (ticks / least.max(1.0)).min(1.0);
        let measures =
            Measures::of_episode(self.analysis, case.level, witness, case.seed.child("measures", 0));
        if !self.order.uses.is_empty() {
            let is_used = |rule: &&RuleRef| rule.is_used(self.analysis, case.level, witness);
            let found = self.order.uses.iter().filter(is_used).count();
            constraint = constraint.min(found as f64 / self.order.uses.len() as f64);
        }
        let quality = quality(case.level, &measures);
        let (objective, calls) = match (&self.climb, self.order.difficulty) {
            (Some(climb), Some(asked)) => {
                let ladder = climb.ladder(case);
                (0.8 * closeness(&ladder, asked) + 0.2 * quality, calls(&ladder))
            }
            _ => (quality, 0),
        };
        Told { constraint, objective, calls }
    }

    /// The measures of a level, each from 0.0 to 1.0: how long the win is for the board, how open the board is.
    pub(super) fn measures(&self, level: &Level, witness: Option<&Episode>) -> Vec<f64> {
        let sides = (level.columns() + level.rows()) as f64;
        let ticks = witness.map_or(0.0, |witness| witness.actions.len() as f64);
        let open = level.cells().iter().filter(|&&cell| self.analysis.game().places(cell).is_empty()).count();
        vec![(ticks / (LONGEST * sides)).min(1.0), open as f64 / level.cells().len().max(1) as f64]
    }
}

/// How good a level is, whatever is asked: the win is long for the board, choices matter, most rules take part, and losing is
/// never far.
fn quality(level: &Level, measures: &Measures) -> f64 {
    let sides = (level.columns() + level.rows()) as f64;
    let length = (measures.ticks as f64 / (CROSSINGS * sides)).min(1.0);
    0.45 * length
        + 0.25 * measures.mechanics
        + 0.15 * measures.branching
        + 0.15 * measures.pressure.min(0.5) * 2.0
}

/// The axes of an archive of levels, in the order of [`Aim::measures`].
pub(super) fn axes() -> Vec<Axis> {
    vec![Axis::new("solution length", (0.0, 1.0), 8), Axis::new("openness", (0.0, 1.0), 8)]
}

/// From 1.0, well within the eases of the label, down to 0.0, as far off as can be.
fn closeness(ladder: &Ladder, asked: Difficulty) -> f64 {
    let (Some(ease), Some([low, high])) = (ladder.ease, asked.eases()) else { return 0.0 };
    let beyond = (low + MARGIN - ease).max(ease - (high - MARGIN)).max(0.0);
    // Who is to be beaten very seldom must be beaten by somebody.
    let beaten = if ladder.difficulty == Difficulty::Unbeaten { 0.8 } else { 1.0 };
    (1.0 - beyond).max(0.0) * beaten
}

fn calls(ladder: &Ladder) -> u64 {
    ladder.rungs.iter().map(|fared| fared.rate.calls).sum()
}
