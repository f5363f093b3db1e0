//! The forecast of a mint's cost.

use super::{Job, Plan};
use crate::sections::SECTIONS;
use crate::sections::puzzles::PuzzleKind;
use crate::sections::section::JobCost;
use validators::{Criteria, Criterion, CriterionSet};

/// The mean cost of a job per requested level, in core-seconds: with neither gates nor `skill`, with gates (as in
/// `starter`), and with both (as in `medium` and `2026-12`).
const CONSTRUCTIVE: [f64; 3] = [PLAIN, 2.8, 3.4];
/// The same costs for inventions. Without gates, four jobs from one seed took 17 seconds per level. With gates, the
/// jobs from three seeds took 10, 42 and 190 seconds per level, and ten jobs with `skill` took about 50 seconds.
const INVENTED: [f64; 3] = [17.0, 60.0, 60.0];
const CORPUS: [f64; 3] = [0.41, 0.41, 1.2];
/// The mean cost of a level without gates if each win search may make [`PLAIN_BUDGET`] calls (the default). Most of
/// the cost comes from failed searches, whose cost is proportional to their call budget.
const PLAIN: f64 = 2.0;
const PLAIN_BUDGET: f64 = 3e6;
/// The fraction of [`PLAIN`] that does not depend on the budget.
const FIXED: f64 = 0.2;
/// The mean cost of measuring a level's difficulty without gates. With gates, few levels reach this step.
const LADDER: f64 = 0.8;
/// The variation of a job's cost across seeds: the standard deviation as a multiple of the mean. Without gates, a few
/// failed searches dominate the cost. With gates, the cost varies less, because every candidate is searched many times.
const SPREAD_PLAIN: f64 = 1.9;
const SPREAD_GATED: f64 = 0.7;
const SPREAD_FIXED_RULES: f64 = 0.8;
const SPREAD_INVENTED: f64 = 1.2;
/// The variation of the cost that all jobs in a mint share, because job costs were measured with few recipes on one
/// machine.
const SPREAD_SHARED: f64 = 0.15;
/// The 95th percentile of the standard normal distribution.
const NINETY_FIVE: f64 = 1.645;
/// The call budget per win search at which the costs with gates were measured.
const GATED_BUDGET: f64 = 1e6;

/// The expected cost of several jobs, in core seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// The median over all seeds.
    pub median: f64,
    /// The 95th percentile over all seeds: one mint in twenty costs more.
    pub tail: f64,
}

impl Forecast {
    /// Returns the forecast for a machine that is slower by the factor `slowness`.
    pub fn times(self, slowness: f64) -> Forecast {
        Forecast { median: self.median * slowness, tail: self.tail * slowness }
    }
}

impl Plan<'_> {
    /// Forecasts the total cost of jobs on the machine described in docs/reference/recipes.md. The total is
    /// approximated by a log-normal distribution with the correct mean and variance (L. F. Fenton, 1960), so
    /// the tail is long for few jobs and short for many.
    pub fn forecast(&self, jobs: &[Job]) -> Forecast {
        let costs = jobs.iter().map(|&job| self.cost(job));
        let (mean, variance) = costs.fold((0.0, 0.0), |(mean, variance), (cost, spread)| {
            (mean + cost, variance + cost * cost * spread * spread)
        });
        if mean <= 0.0 {
            return Forecast { median: 0.0, tail: 0.0 };
        }
        let relative = 1.0 + variance / (mean * mean) + SPREAD_SHARED * SPREAD_SHARED;
        let median = mean / relative.sqrt();
        Forecast { median, tail: median * libm::exp(NINETY_FIVE * libm::log(relative).sqrt()) }
    }

    /// Returns a job's mean cost in core seconds, and the variation of the cost.
    fn cost(&self, job: Job) -> (f64, f64) {
        let usual = Criteria::default();
        let is_gated = |criteria: &Criteria| !criteria.ask.only(CriterionSet::GATES).is_empty();
        let of = |[plain, gated, skill]: [f64; 3], levels: u32, criteria: &Criteria| {
            let budget = criteria.budget as f64;
            let (base, share, ladder) = match is_gated(criteria) {
                // With gates, three quarters of the cost come from searches for a win, most of which fail.
                true => (gated, 0.25 + 0.75 * budget / GATED_BUDGET, skill - gated),
                false => (plain, FIXED + (1.0 - FIXED) * budget / PLAIN_BUDGET, LADDER),
            };
            // The decision budget accounts for about a third of the cost.
            let thought = 0.65 + 0.35 * criteria.decision as f64 / usual.decision as f64;
            let played = match criteria.includes(Criterion::Skill) {
                true => criteria.ladder_plays as f64 / usual.ladder_plays as f64,
                false => 0.0,
            };
            f64::from(levels) * (base * share * thought + ladder * played)
        };
        let (old, new) = (self.recipe.corpus.levels, self.recipe.generated.levels);
        let puzzle_levels = |kind: PuzzleKind| self.recipe.puzzles_of(kind).map_or(0, |part| part.levels);
        let (levels, is_certain) = match job {
            Job::Constructive(_) => (new, false),
            Job::Invented(..) => (self.recipe.invented.as_ref().map_or(0, |part| part.levels), false),
            Job::Corpus(_) => (old, false),
            Job::Design(_) => (self.recipe.designs.as_ref().map_or(0, |part| part.levels), false),
            Job::Puzzle(kind, _) => (puzzle_levels(kind), kind != PuzzleKind::Strays),
        };
        let criteria = self.criteria_of(job);
        let made = match job {
            Job::Constructive(_) => of(CONSTRUCTIVE, levels, criteria),
            // Searches for boards have their own budgets.
            Job::Invented(..) => {
                let [plain, gated, skill] = INVENTED;
                let gated = if criteria.includes(Criterion::Skill) { skill } else { gated };
                f64::from(levels) * if is_gated(criteria) { gated } else { plain }
            }
            // Like the levels of corpus games, designs pass no stages for generated rules.
            Job::Corpus(_) | Job::Design(_) => of(CORPUS, levels, criteria),
            // The generators of puzzles solve every board within their own budgets.
            Job::Puzzle(kind, _) => f64::from(levels) * kind.seconds(),
        };
        let spread = match job {
            Job::Corpus(_) | Job::Puzzle(..) | Job::Design(_) => SPREAD_FIXED_RULES,
            Job::Invented(..) => SPREAD_INVENTED,
            _ if is_gated(criteria) => SPREAD_GATED,
            _ => SPREAD_PLAIN,
        };
        let job = JobCost { seconds: made, levels, is_certain };
        let added: f64 = SECTIONS.iter().map(|section| section.seconds(self.recipe, &job)).sum();
        (made + added, spread)
    }
}
