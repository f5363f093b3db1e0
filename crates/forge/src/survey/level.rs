//! Levels judged again by all judges for a report.

use base::Seed;
use engine::{Analysis, Level};
use generators::levels::{LevelMeasure, LevelMeasures};
use rayon::prelude::*;
use validators::{
    Case, Cost, Criteria, CriteriaError, CriterionSet, Difficulty, Effort, Judging, Ladder, LadderConfig,
    Measures, Panel, Report,
};

/// The maximum win rate of idle play and of random play at which a level does not count as won without effort.
pub(crate) const FOR_NOTHING: f64 = 0.1;

/// A level and all findings about it.
#[derive(Clone, Debug)]
pub struct SurveyedLevel {
    /// The judged level.
    pub level: Level,
    /// The judges' findings.
    pub report: Report,
    /// The results of the ladder (reference players of increasing strength) on the level, and the difficulty derived
    /// from them. The seeds have not been used in any search. `None` if no ladder played the level.
    pub ladder: Option<Ladder>,
    /// The measures of the level's witness; `None` without a witness.
    pub measures: Option<Measures>,
    /// The measures of the grid alone, by name (such as `openness` or `cover`), each from 0 to 1. The names are the
    /// same for all levels.
    pub layout: Vec<(String, f64)>,
    /// The requested difficulty; `None` if none was requested.
    pub asked: Option<Difficulty>,
}

impl SurveyedLevel {
    /// Returns the level's difficulty as measured by the ladder of reference players; `None` without a ladder.
    pub fn label(&self) -> Option<Difficulty> {
        self.ladder.as_ref().map(|ladder| ladder.difficulty)
    }

    /// Returns a measure by name: `ticks`, `pushes`, `branching`, `mechanics`, `pressure`, `skill`, or a layout
    /// measure; `None` if the level lacks the measure.
    pub(crate) fn measure(&self, name: &str) -> Option<f64> {
        let play = self.measures.as_ref().and_then(|measures| match name {
            "ticks" => Some(measures.ticks as f64),
            "pushes" => Some(measures.pushes as f64),
            "branching" => Some(measures.branching),
            "mechanics" => Some(measures.mechanics),
            "pressure" => Some(measures.pressure),
            "skill" => measures.skill.map(|skill| skill.wins),
            _ => None,
        });
        play.or_else(|| self.layout.iter().find(|(known, _)| known == name).map(|(_, value)| *value))
    }
}

/// A survey that judges levels for a report with its own seeds, without trusting any search result. All criteria are
/// checked for every level, even after one of them fails.
pub struct LevelSurvey<'a> {
    analysis: &'a Analysis,
    layout: Option<LevelMeasures>,
    panel: Panel,
    climb: Option<LadderConfig>,
    seed: Seed,
}

impl<'a> LevelSurvey<'a> {
    /// Creates a survey of one game's levels. Random play may win a tenth of its episodes, even if the criteria set a
    /// lower limit to account for the selection among many candidates. The level is played by the criteria's ladder of
    /// reference players without the held-out players, so difficulty has the same meaning as in `arcade generate levels
    /// --difficulty`.
    ///
    /// # Errors
    /// Returns an error if the criteria are invalid.
    pub fn new(
        analysis: &'a Analysis,
        criteria: &Criteria,
        seed: Seed,
    ) -> Result<LevelSurvey<'a>, CriteriaError> {
        let criteria =
            Criteria { random_wins: criteria.random_wins.max(FOR_NOTHING), ..criteria.clone() }.check()?;
        // The survey plays the reference players' episodes itself, and playing them twice would be expensive.
        let panel = criteria.without(CriterionSet::costing(Cost::Ladder));
        Ok(LevelSurvey {
            analysis,
            layout: LevelMeasures::new(analysis),
            panel: Panel::new(panel, Effort::Full),
            climb: Some(LadderConfig { held_out: Vec::new(), ..criteria.players() }),
            seed,
        })
    }

    /// Returns the same survey without the ladder of reference players. Such a survey does not measure difficulty or
    /// skill.
    #[must_use]
    pub fn without_ladder(self) -> LevelSurvey<'a> {
        LevelSurvey { climb: None, ..self }
    }

    /// Judges levels, each with its requested difficulty, on all threads of the current rayon pool. The result for a
    /// level does not depend on the other levels. Costs one run of the panel per level and, for each level with a
    /// witness, the episodes of the ladder's reference players.
    pub fn judge(&self, levels: &[(Level, Option<Difficulty>)]) -> Vec<SurveyedLevel> {
        levels.par_iter().map(|(level, asked)| self.one(level, *asked)).collect()
    }

    fn one(&self, level: &Level, asked: Option<Difficulty>) -> SurveyedLevel {
        let (analysis, game) = (self.analysis, self.analysis.game());
        let seed = self.seed.child(&level.digest().to_string(), 0);
        let report = self.panel.judge(Judging::level(game, level, seed.child("panel", 0)));
        let ladder = report.witness.as_ref().zip(self.climb.as_ref()).map(|(witness, climb)| {
            let seed = seed.child("ladder", 0).into();
            climb.ladder(Case { game, level, seed: &seed, analysis, witness: Some(witness) })
        });
        let measures = Measures::of(analysis, level, &report, ladder.as_ref(), seed.child("measures", 0));
        let layout = self.layout.as_ref().map_or(Vec::new(), |layout| {
            let names = LevelMeasure::ALL.iter().map(|measure| measure.name().to_owned());
            names.zip(layout.of(level)).collect()
        });
        SurveyedLevel { level: level.clone(), report, ladder, measures, layout, asked }
    }
}
