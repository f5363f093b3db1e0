//! The measures of a game, for comparison with people's preferences.

use super::Candidate;
use base::Seed;
use engine::{Analysis, Episode};
use rayon::prelude::*;
use std::collections::BTreeMap;
use validators::{
    Criteria, Criterion, CriterionSet, Effort, Judging, Panel, PlayMeasures, Recorded, Report, SkillGap,
};

/// The values of measures, by name.
pub(super) type Measures = BTreeMap<String, f64>;

/// The number of forward-model calls for each level, divided between the search for a win and the ladder (the reference
/// players of increasing strength).
const CALLS: u64 = 200_000;

/// Returns a game's measures: the measures of its episodes, the length of its wins in ticks, and the
/// advantage of stronger players. Cost: some seconds. The same game has the same measures in every session.
pub(super) fn of(Candidate { game, levels, .. }: &Candidate) -> Measures {
    let ask = CriterionSet::of(&[Criterion::Winnable, Criterion::Skill]);
    let criteria = Criteria { ask, held_out: Vec::new(), budget: CALLS, ..Criteria::full() };
    let Ok(criteria) = criteria.check() else { return Measures::new() };
    let panel = Panel::new(criteria, Effort::Calls(CALLS));
    let seed = Seed::from_text("judging");
    let judge = |level| panel.judge(Judging::level(game, level, seed.child(&game.digest().to_string(), 0)));
    let reports: Vec<Report> = levels.par_iter().map(judge).collect();
    let episodes: Vec<Vec<Episode>> = reports.iter().map(Report::episodes).collect();
    let recording: Vec<Recorded<'_>> =
        levels.iter().zip(&episodes).map(|(level, episodes)| Recorded { level, episodes }).collect();
    let mut measures = Measures::new();
    if let Some(play) = PlayMeasures::of(&Analysis::of(game), &recording, seed) {
        let PlayMeasures { pace, density, chance, mechanics, sight, drama, lead_changes, .. } = play;
        for (name, value) in [
            ("pace", pace),
            ("density", density),
            ("chance", chance),
            ("mechanics", mechanics as f64),
            ("sight", sight),
            ("drama", drama),
            ("lead-changes", lead_changes),
        ] {
            measures.insert(name.to_owned(), value);
        }
    }
    let mut mean = |name: &str, values: Vec<f64>| {
        if !values.is_empty() {
            measures.insert(name.to_owned(), values.iter().sum::<f64>() / values.len() as f64);
        }
    };
    let wins = reports.iter().filter_map(|report| report.witness.as_ref());
    mean("ticks", wins.map(|witness| witness.actions.len() as f64).collect());
    let ladders = || reports.iter().filter_map(Report::ladder);
    mean("skill", ladders().filter_map(SkillGap::of).map(|gap| gap.wins).collect());
    mean("ease", ladders().filter_map(|ladder| ladder.ease).collect());
    measures
}
