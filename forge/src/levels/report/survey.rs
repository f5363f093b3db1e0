//! Levels judged for a report: afresh, by everybody.

use super::Judged;
use super::play::FOR_NOTHING;
use engine::{Analysis, Level, Seed};
use generators::levels::{LevelMeasure, LevelMeasures};
use rayon::prelude::*;
use validators::{Case, Climb, Criteria, CriteriaError, Difficulty, Measures, Panel};

/// Judges levels for a report, with dice of its own: nothing that a search knew is taken on trust. All criteria are asked of
/// every level, also after one is not met.
pub struct Survey<'a> {
    analysis: &'a Analysis,
    layout: Option<LevelMeasures>,
    panel: Panel,
    climb: Climb,
    seed: Seed,
}

impl<'a> Survey<'a> {
    /// A survey of levels of one game. Random keys may win a tenth of their plays, as [`Triviality`](super::Triviality) counts
    /// them, also where the criteria are stricter so that a choice among many candidates keeps to it. The ladder is that of the criteria without the players held out: difficulty is what
    /// `arcade generate levels --difficulty` means by it.
    ///
    /// # Errors
    /// The criteria are not sensible.
    pub fn new(analysis: &'a Analysis, criteria: &Criteria, seed: Seed) -> Result<Survey<'a>, CriteriaError> {
        criteria.check()?;
        // The ladder is played here: twice would be dear.
        let asked = |name: &&String| *name != "skill";
        let panel = Criteria {
            ask: criteria.ask.iter().filter(asked).cloned().collect(),
            random_wins: criteria.random_wins.max(FOR_NOTHING),
            ..criteria.clone()
        };
        let climb = criteria.climb().expect("the criteria were checked");
        Ok(Survey {
            analysis,
            layout: LevelMeasures::new(analysis),
            panel: Panel::new(&panel),
            climb: Climb { held_out: Vec::new(), ..climb },
            seed,
        })
    }

    /// Judges levels, each with the difficulty that was asked of it, on all threads of the current rayon pool. A level gets the
    /// same answer alone and among others. Cost: that of the panel and, where there is a witness, of the ladder.
    pub fn judge(&self, levels: &[(Level, Option<Difficulty>)]) -> Vec<Judged> {
        levels.par_iter().map(|(level, asked)| self.one(level, *asked)).collect()
    }

    fn one(&self, level: &Level, asked: Option<Difficulty>) -> Judged {
        let (analysis, game) = (self.analysis, self.analysis.game());
        let seed = self.seed.child(&level.digest().to_string(), 0);
        let report = self.panel.judge(game, level, seed.child("panel", 0));
        let ladder = report.witness.as_ref().map(|witness| {
            let seed = seed.child("ladder", 0);
            self.climb.ladder(Case { game, level, seed, analysis, witness: Some(witness) })
        });
        let measures = Measures::of(analysis, level, &report, ladder.as_ref(), seed.child("measures", 0));
        let layout = self.layout.as_ref().map_or(Vec::new(), |layout| {
            let names = LevelMeasure::ALL.iter().map(|measure| measure.name().to_owned());
            names.zip(layout.of(level)).collect()
        });
        Judged { level: level.clone(), report, ladder, measures, layout, asked }
    }
}
