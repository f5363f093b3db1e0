//! Levels judged for a report: afresh, by everybody.

use base::Seed;
use engine::{Analysis, Level};
use generators::levels::{LevelMeasure, LevelMeasures};
use rayon::prelude::*;
use validators::{
    Case, Cost, Criteria, CriteriaError, CriterionSet, Difficulty, Effort, Judging, Ladder, LadderConfig,
    Measures, Panel, Report,
};

/// The greatest share of wins that is still not won for nothing.
pub(crate) const FOR_NOTHING: f64 = 0.1;

/// A level and all that is known of it.
#[derive(Clone, Debug)]
pub struct SurveyedLevel {
    /// The level.
    pub level: Level,
    /// The findings of the judges.
    pub report: Report,
    /// The ladder of players on it, and how hard that makes it; with seeds that no search was guided by.
    pub ladder: Option<Ladder>,
    /// The measures of its witness; `None` without a witness.
    pub measures: Option<Measures>,
    /// Measures of the grid alone, by name (`openness`, `cover`), each from 0 to 1; the same names for all levels.
    pub layout: Vec<(String, f64)>,
    /// The difficulty that was asked for.
    pub asked: Option<Difficulty>,
}

impl SurveyedLevel {
    /// The difficulty that was measured.
    pub fn label(&self) -> Option<Difficulty> {
        self.ladder.as_ref().map(|ladder| ladder.difficulty)
    }

    /// A measure by name: `ticks`, `pushes`, `branching`, `mechanics`, `pressure`, `skill`, or one of the layout.
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

/// Judges levels for a report, with seeds of its own: nothing that a search knew is taken on trust. All criteria are asked of
/// every level, also after one is not met.
pub struct LevelSurvey<'a> {
    analysis: &'a Analysis,
    layout: Option<LevelMeasures>,
    panel: Panel,
    climb: Option<LadderConfig>,
    seed: Seed,
}

impl<'a> LevelSurvey<'a> {
    /// A survey of levels of one game. Random keys may win a tenth of their plays, as the report counts them, also where the
    /// criteria are stricter so that a choice among many candidates keeps to it. The ladder is that of the criteria without the
    /// players held out: difficulty is what `arcade generate levels --difficulty` means by it.
    ///
    /// # Errors
    /// The criteria are not sensible.
    pub fn new(
        analysis: &'a Analysis,
        criteria: &Criteria,
        seed: Seed,
    ) -> Result<LevelSurvey<'a>, CriteriaError> {
        let criteria =
            Criteria { random_wins: criteria.random_wins.max(FOR_NOTHING), ..criteria.clone() }.check()?;
        // The survey plays the ladder itself: twice would be expensive.
        let panel = criteria.without(CriterionSet::costing(Cost::Ladder));
        Ok(LevelSurvey {
            analysis,
            layout: LevelMeasures::new(analysis),
            panel: Panel::new(panel, Effort::Full),
            climb: Some(LadderConfig { held_out: Vec::new(), ..criteria.players() }),
            seed,
        })
    }

    /// The same survey without a ladder: difficulty and skill are not measured.
    #[must_use]
    pub fn without_ladder(self) -> LevelSurvey<'a> {
        LevelSurvey { climb: None, ..self }
    }

    /// Judges levels, each with the difficulty that was asked of it, on all threads of the current rayon pool. A level gets the
    /// same answer alone and among others. Cost: that of the panel and, where there is a witness, of the ladder.
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
