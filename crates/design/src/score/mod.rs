//! A designer's score: the fraction of its drafts that reach each step, and the costs per accepted game.

mod table;

pub use table::table;

use crate::draft::Draft;
use crate::error::DesignError;
use crate::folder::DesignFolder;
use crate::settings::DesignSettings;
use base::Seed;
use serde::Serialize;
use statistics::{Interval, Z95, bootstrap, quantile, wilson};
use validators::Criterion;

/// The number of bootstrap resamples for the intervals of the costs per accepted game.
const RESAMPLES: usize = 2000;

/// The score of a designer over all finished drafts in a run. All intervals are 95% intervals over drafts, which are
/// treated as independent. They are approximate, because the designer is shown the ideas of its earlier drafts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignerScore {
    /// The designer's name.
    pub designer: String,
    /// The number of finished drafts.
    pub drafts: u64,
    /// The rates, from the first step to the last.
    pub rates: Vec<Rate>,
    /// The median distance to the nearest known game, over all drafts whose rules compile; `None` if there are no such
    /// drafts or no known games.
    pub distance: Option<f64>,
    /// The costs per accepted game.
    pub costs: Vec<CostPerGame>,
}

/// The fraction of drafts that reach a step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// The step: `compiles`, `loads`, `won`, a criterion's name, `new`, `accepted at once`, or `accepted`.
    pub step: String,
    /// The number of drafts that reach the step.
    pub count: u64,
    /// The Wilson interval's lower bound for the fraction.
    pub low: f64,
    /// The Wilson interval's upper bound for the fraction.
    pub high: f64,
}

/// A cost per accepted game: the total over all drafts, divided by the number of accepted games.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostPerGame {
    /// The unit: `corrections`, `answers`, `tokens` or `US dollars`.
    pub unit: String,
    /// The cost, or `None` if no game was accepted or the price is unknown.
    pub value: Option<f64>,
    /// The bootstrap interval's lower bound, or `None` if the cost is unknown.
    pub low: Option<f64>,
    /// The bootstrap interval's upper bound, or `None` if too few games were accepted to compute it.
    pub high: Option<f64>,
}

impl DesignerScore {
    /// Computes the score over the finished drafts in a folder.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read.
    pub fn read(folder: &DesignFolder) -> Result<DesignerScore, DesignError> {
        let mut drafts = Vec::new();
        for number in 0..folder.settings.drafts {
            drafts.extend(folder.draft(number)?);
        }
        Ok(DesignerScore::of(&folder.settings, &drafts))
    }

    /// Computes the score over the given drafts.
    pub fn of(settings: &DesignSettings, drafts: &[Draft]) -> DesignerScore {
        let of = drafts.len() as u64;
        let rate = |step: &str, holds: &dyn Fn(&Draft) -> bool| {
            let count = drafts.iter().filter(|draft| holds(draft)).count() as u64;
            let Interval { low, high } = wilson(count, of, Z95);
            Rate { step: step.to_owned(), count, low, high }
        };
        let mut rates = vec![
            rate("compiles", &|draft| draft.measures.compiles),
            rate("loads", &|draft| draft.measures.loads),
            rate("won", &|draft| draft.measures.loads && draft.measures.won == settings.brief.levels),
        ];
        for criterion in settings.criteria.ask.iter() {
            rates.push(rate(criterion.name(), &|draft| meets(draft, criterion)));
        }
        rates.push(rate("new", &is_new));
        rates.push(rate("accepted at once", &|draft| draft.is_accepted() && corrections(draft) == 0.0));
        rates.push(rate("accepted", &Draft::is_accepted));
        let near = drafts.iter().filter_map(|draft| Some(draft.measures.nearest.as_ref()?.distance));
        let near: Vec<f64> = near.collect();
        DesignerScore {
            designer: settings.designer.clone(),
            drafts: of,
            rates,
            distance: quantile(&near, 0.5),
            costs: vec![
                cost("corrections", drafts, |draft| Some(corrections(draft))),
                cost("answers", drafts, |draft| Some(draft.spending.answers as f64)),
                cost("tokens", drafts, |draft| {
                    Some((draft.spending.input_tokens + draft.spending.output_tokens) as f64)
                }),
                cost("US dollars", drafts, |draft| draft.spending.cost),
            ],
        }
    }
}

fn meets(draft: &Draft, criterion: Criterion) -> bool {
    draft.measures.criteria.get(&criterion) == Some(&true)
}

fn is_new(draft: &Draft) -> bool {
    draft.measures.compiles && draft.measures.nearest.as_ref().is_none_or(|nearest| nearest.is_far())
}

fn corrections(draft: &Draft) -> f64 {
    f64::from(draft.repairs.values().sum::<u32>())
}

/// Computes a cost per accepted game. Samples without an accepted game have an infinite cost.
fn cost(unit: &str, drafts: &[Draft], of: impl Fn(&Draft) -> Option<f64>) -> CostPerGame {
    let unit = unit.to_owned();
    let each: Option<Vec<(f64, bool)>> =
        drafts.iter().map(|draft| Some((of(draft)?, draft.is_accepted()))).collect();
    let per_game = |sample: &[(f64, bool)]| {
        let accepted = sample.iter().filter(|(_, accepted)| *accepted).count();
        let total: f64 = sample.iter().map(|(cost, _)| cost).sum();
        if accepted == 0 { f64::INFINITY } else { total / accepted as f64 }
    };
    let finite = |value: f64| value.is_finite().then_some(value);
    let Some(value) = each.as_deref().map(per_game).and_then(finite) else {
        return CostPerGame { unit, value: None, low: None, high: None };
    };
    let seed = *Seed::from_text("designer's score").child(&unit, 0).as_bytes();
    let interval = bootstrap(&each.unwrap_or_default(), per_game, RESAMPLES, 0.95, seed);
    let bound = |bound: fn(&Interval) -> f64| interval.as_ref().map(bound).and_then(finite);
    CostPerGame { unit, value: Some(value), low: bound(|found| found.low), high: bound(|found| found.high) }
}
