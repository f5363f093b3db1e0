//! The objective of a level search.

use super::order::{LevelOrder, Method};
use engine::{Analysis, Level};
use generators::levels::{LevelMeasure, LevelMeasures};
use validators::{Case, CheckedCriteria, Difficulty, Ladder, LadderConfig, Measures, RuleRef};

/// The aim of a level search.
pub(super) struct Aim<'a> {
    analysis: &'a Analysis,
    order: &'a LevelOrder,
    layout: Option<LevelMeasures>,
    /// The players that measure a level's difficulty, if a difficulty is requested.
    climb: Option<LadderConfig>,
}

/// The aim's assessment of a winnable level.
pub(super) struct Told {
    /// The degree to which the win meets the order's requirements, from 0.0 to 1.0.
    pub(super) constraint: f64,
    /// The quality of the level, from 0.0 to 1.0.
    pub(super) objective: f64,
    /// The measures of the level's win.
    pub(super) measures: Measures,
    /// The number of forward-model calls spent on these measurements.
    pub(super) calls: u64,
}

/// The number of episodes per player of the ladder (reference players of increasing strength) in a quick evaluation.
const PLAYS: u64 = 6;
/// The margin that searches keep from the boundaries of a label's ease range. A second measurement may move a level
/// that lies within this margin across the boundary.
const MARGIN: f64 = 0.08;
/// The margin that an archive keeps from the boundaries of a label's ease range. Levels closer to a boundary, or beyond
/// it, meet at most 90% of the constraint.
const KEPT: f64 = 0.03;
const CLOSE: f64 = 0.9;
/// The win rate over all episodes of the ladder (reference players of increasing strength) above which a second
/// measurement is almost certain to have a winner too.
const SURELY_BEATEN: f64 = 0.05;
/// The desired length of a win, as a multiple of the board's columns plus its rows.
const CROSSINGS: f64 = 2.5;

/// The measures available as archive axes: the measures of the win, then [`LevelMeasure::ALL`].
pub(super) const OF_PLAY: [&str; 4] = ["solution length", "branching", "mechanics", "pressure"];

/// Returns the names of all measures, in the order of [`Aim::measures`].
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    OF_PLAY.into_iter().chain(LevelMeasure::ALL.iter().map(|measure| measure.name()))
}

impl<'a> Aim<'a> {
    pub(super) fn new(analysis: &'a Analysis, order: &'a LevelOrder, criteria: &CheckedCriteria) -> Aim<'a> {
        let climb = order.difficulty.map(|_| LadderConfig {
            plays: PLAYS,
            held_out: Vec::new(),
            ..criteria.players()
        });
        Aim { analysis, order, layout: LevelMeasures::new(analysis), climb }
    }

    /// Assesses a level with a winning witness. Costs a few replays of the witness. If a difficulty is requested, also
    /// costs the episodes of the ladder's reference players.
    pub(super) fn tell(&self, case: Case<'_>) -> Told {
        let witness = case.witness.expect("a level that can be won");
        let measures =
            Measures::of_episode(self.analysis, case.level, witness, case.seed.seed().child("measures", 0));
        let least = self.order.min_solution.unwrap_or(0).max(self.order.criteria.least_ticks);
        let mut constraint = (measures.ticks as f64 / least.max(1) as f64).min(1.0);
        if !self.order.uses.is_empty() {
            let is_used = |rule: &&RuleRef| rule.is_used(self.analysis, case.level, witness);
            let used = self.order.uses.iter().filter(is_used).count();
            constraint = constraint.min(used as f64 / self.order.uses.len() as f64);
        }
        let quality = self.quality(case.level, &measures);
        let (objective, calls) = match (&self.climb, self.order.difficulty) {
            (Some(climb), Some(asked)) => {
                let ladder = climb.ladder(case);
                // Levels are picked from an archive because they lie far apart rather than for their quality, so all of
                // them must have the label.
                if self.order.method == Method::Evolutionary {
                    let missed = CLOSE * closeness(&ladder, asked, KEPT);
                    constraint = constraint.min(if bears(&ladder, asked, KEPT) { 1.0 } else { missed });
                }
                (0.8 * closeness(&ladder, asked, MARGIN) + 0.2 * quality, calls(&ladder))
            }
            _ => (quality, 0),
        };
        Told { constraint, objective, measures, calls }
    }

    /// Returns a level's quality, regardless of the request. On a good level, the win is long for the board and
    /// involves most rules, choices matter, and a loss is never far away. The walls form structures rather than noise.
    fn quality(&self, level: &Level, measures: &Measures) -> f64 {
        let sides = (level.columns() + level.rows()) as f64;
        let length = (measures.ticks as f64 / (CROSSINGS * sides)).min(1.0);
        let built = 1.0 - self.layout(level)[LevelMeasure::Sprinkle as usize];
        let danger = (2.0 * measures.pressure).min(1.0);
        0.4 * length + 0.25 * measures.mechanics + 0.1 * measures.branching + 0.1 * danger + 0.15 * built
    }

    fn layout(&self, level: &Level) -> [f64; LevelMeasure::ALL.len()] {
        self.layout.as_ref().map_or([0.0; LevelMeasure::ALL.len()], |layout| layout.of(level))
    }

    /// Returns all measures of a level, in the order of [`names`]; the measures of a win are 0.0 if no win is known.
    pub(super) fn measures(&self, level: &Level, won: Option<&Measures>) -> Vec<f64> {
        let of_play = won.map_or([0.0; OF_PLAY.len()], |measures| {
            [measures.ticks as f64, measures.branching, measures.mechanics, measures.pressure]
        });
        of_play.into_iter().chain(self.layout(level)).collect()
    }
}

/// Returns how close a level is to a label: 1.0 if the level is within the label's ease range by a margin, and 0.0 if
/// it is as far away as possible.
fn closeness(ladder: &Ladder, asked: Difficulty, margin: f64) -> f64 {
    let (Some(ease), Some([low, high])) = (ladder.ease, within(asked, margin)) else { return 0.0 };
    let beyond = (low - ease).max(ease - high).max(0.0);
    // Even a level that should rarely be won must be won by some player, and not only by luck.
    let beaten = (wins(ladder) / SURELY_BEATEN).min(1.0);
    (1.0 - beyond).max(0.0) * (0.8 + 0.2 * beaten)
}

/// Returns the part of a label's ease range that lies more than a margin away from all other labels.
fn within(label: Difficulty, margin: f64) -> Option<[f64; 2]> {
    let [low, high] = label.eases()?;
    Some([if low > 0.0 { low + margin } else { low }, if high < 1.0 { high - margin } else { high }])
}

/// Returns `true` if the measurement by the ladder's reference players confirms a difficulty label with a margin.
pub(crate) fn bears(ladder: &Ladder, asked: Difficulty, margin: f64) -> bool {
    let (Some(ease), Some([low, high])) = (ladder.ease, within(asked, margin)) else { return false };
    ladder.difficulty == asked && (low..=high).contains(&ease)
}

/// Returns the fraction of episodes that the ladder's reference players won.
pub(crate) fn wins(ladder: &Ladder) -> f64 {
    let plays: u64 = ladder.rungs.iter().map(|fared| fared.rate.plays).sum();
    let wins: u64 = ladder.rungs.iter().map(|fared| fared.rate.wins).sum();
    wins as f64 / plays.max(1) as f64
}

fn calls(ladder: &Ladder) -> u64 {
    ladder.rungs.iter().map(|fared| fared.rate.calls).sum()
}
