//! Searches under the eyes of judges: each level by itself, or an archive of levels that differ.

use super::accept::Gate;
use super::aim::Aim;
use super::axes::Axes;
use super::look::{Look, Looker};
use super::make::{Attempt, Cost, LevelSet, Maker, NO_BOARD, TWICE, made};
use engine::{Digest, Level};
use generators::Variation;
use generators::levels::LevelSearch;
use generators::{
    Annealing, AnnealingConfig, Archive, Evaluation, Judged, MapElites, MapElitesConfig, Search,
};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Levels that come before the panel after a search, at most.
const FINALISTS: usize = 3;
/// The feasibility of a level that a look took for feasible and the panel did not.
const REFUSED: f64 = 0.95;
/// Levels that are made from nothing to see in what those of a game differ.
const SAMPLE: u64 = 16;

impl Maker<'_> {
    /// Anneals a level until the panel lets one in: each round is a search of its own.
    pub(super) fn searched(
        &self,
        variation: &LevelSearch<'_>,
        number: u32,
        refused: &BTreeSet<Digest>,
    ) -> Attempt {
        let seed = self.level_seed(number);
        let aim = Aim::new(self.analysis, self.order);
        let looker = Looker::new(self.analysis, self.order, aim, seed.child("look", 0));
        let gate = Gate::new(self.analysis, self.order, seed.child("gate", 0));
        let looks = self.order.effort.looks as usize;
        let mut cost = Cost::default();
        for round in 0..u64::from(self.order.effort.rounds) {
            // Half of them to find a start that is worth improving: levels differ more than edits can change them.
            let config = AnnealingConfig { starts: looks / 2, ..AnnealingConfig::of(looks) };
            let mut search = Annealing::new(variation, config, seed.child("round", round));
            let mut best = Finalists::default();
            self.strive(&mut search, looks, &looker, &mut cost, |level, evaluation| {
                best.note(level, evaluation)
            });
            for level in best.levels {
                if refused.contains(&self.likeness.digest(&level)) {
                    cost.reject(TWICE);
                    continue;
                }
                let judged = gate.judge(&level);
                cost.judged(&judged);
                if judged.obstacle.is_none() {
                    return (Some(made(number, level, judged)), cost);
                }
            }
        }
        (None, cost)
    }

    /// Fills an archive and picks levels that differ from it, until enough have passed the panel.
    pub(super) fn evolved(&self, variation: &LevelSearch<'_>) -> LevelSet {
        let aim = Aim::new(self.analysis, self.order);
        let looker = Looker::new(self.analysis, self.order, aim, self.seed.child("look", 0));
        let gate = Gate::new(self.analysis, self.order, self.seed.child("gate", 0));
        let wanted = self.order.count as usize;
        let looks = self.order.effort.looks as usize * wanted;
        let mut set = LevelSet { levels: Vec::new(), cost: Cost::default() };
        let mut sample = self.sample(variation, &looker, &mut set.cost);
        let axes =
            Axes::of(&sample.iter().map(|(_, told)| told.measures.clone()).collect::<Vec<_>>(), wanted);
        sample.iter_mut().for_each(|(_, told)| told.measures = axes.pick(&told.measures));
        let config = MapElitesConfig { initial: (looks / 5).max(1), ..MapElitesConfig::default() };
        let key = |level: &Level| self.likeness.digest(level);
        let seed = self.seed.child("archive", 0);
        let mut search = MapElites::new(variation, key, axes.axes.clone(), config, seed);
        search.tell(sample);
        let mut shown = BTreeSet::new();
        for _ in 0..self.order.effort.rounds {
            let told = |_: &Level, told: &mut Evaluation| told.measures = axes.pick(&told.measures);
            self.strive(&mut search, looks, &looker, &mut set.cost, told);
            let picked = spread(search.archive(), wanted - set.levels.len(), &mut shown, key);
            let judged: Vec<_> = picked.par_iter().map(|(_, level)| gate.judge(level)).collect();
            for ((cell, level), judged) in picked.into_iter().zip(judged) {
                set.cost.judged(&judged);
                if judged.obstacle.is_some() {
                    search.refuse(cell, REFUSED);
                    continue;
                }
                let number = set.levels.len() as u32;
                self.progress.made(number);
                set.levels.push(made(number, level, judged));
            }
            if set.levels.len() == wanted {
                break;
            }
        }
        set
    }

    /// Levels from nothing, to see what levels of the game are like.
    fn sample(
        &self,
        variation: &LevelSearch<'_>,
        looker: &Looker<'_>,
        cost: &mut Cost,
    ) -> Vec<(Level, Evaluation)> {
        let levels = (0..SAMPLE).into_par_iter();
        let levels = levels.filter_map(|at| variation.create(self.seed.child("sample", at)));
        let looked = levels.map(|level| (looker.look(&level), level)).collect::<Vec<(Look, Level)>>();
        looked.iter().for_each(|(look, _)| cost.looked(look));
        looked.into_iter().map(|(look, level)| (level, look.evaluation)).collect()
    }

    /// Lets a search ask, looks at what it proposes on all threads, and tells it.
    fn strive<S: Search<Candidate = Level>>(
        &self,
        search: &mut S,
        looks: usize,
        looker: &Looker<'_>,
        cost: &mut Cost,
        mut note: impl FnMut(&Level, &mut Evaluation),
    ) {
        let mut asked = 0;
        while asked < looks {
            let levels = search.ask(self.order.effort.batch.min(looks - asked));
            if levels.is_empty() {
                cost.reject(NO_BOARD);
                return;
            }
            asked += levels.len();
            let looks: Vec<Look> = levels
                .par_iter()
                .map(|level| {
                    let look = looker.look(level);
                    self.progress.looked();
                    look
                })
                .collect();
            looks.iter().for_each(|look| cost.looked(look));
            let told = levels.into_iter().zip(looks).map(|(level, look)| (level, look.evaluation));
            let mut told: Vec<(Level, Evaluation)> = told.collect();
            told.iter_mut().for_each(|(level, evaluation)| note(level, evaluation));
            search.tell(told);
        }
    }
}

/// The best feasible levels of a search, the very best first.
#[derive(Default)]
struct Finalists {
    levels: Vec<Level>,
    objectives: Vec<f64>,
}

impl Finalists {
    fn note(&mut self, level: &Level, evaluation: &Evaluation) {
        if !evaluation.is_feasible() || self.levels.contains(level) {
            return;
        }
        let place = self.objectives.partition_point(|&objective| objective >= evaluation.objective);
        if place < FINALISTS {
            self.levels.insert(place, level.clone());
            self.objectives.insert(place, evaluation.objective);
            self.levels.truncate(FINALISTS);
            self.objectives.truncate(FINALISTS);
        }
    }
}

/// An elite of an archive, with its cell and the bins of that.
type Elite<'a> = (usize, Vec<usize>, &'a Judged<Level>);

/// Levels of an archive that have not been shown, with their cells, as far apart in it as can be: the best one first, then always
/// the one that is farthest from all that have been picked, the better one of equals.
fn spread(
    archive: &Archive<Level>,
    wanted: usize,
    shown: &mut BTreeSet<Digest>,
    key: impl Fn(&Level) -> Digest,
) -> Vec<(usize, Level)> {
    let mut left: Vec<Elite<'_>> = archive
        .elites()
        .filter(|(_, elite)| !shown.contains(&key(&elite.candidate)))
        .map(|(cell, elite)| (cell, archive.bins(cell), elite))
        .collect();
    let mut picked: Vec<Elite<'_>> = Vec::new();
    while picked.len() < wanted && !left.is_empty() {
        let apart = |bins: &[usize]| {
            let steps = |(_, other, _): &Elite<'_>| {
                bins.iter().zip(other).map(|(a, b)| a.abs_diff(*b)).sum::<usize>()
            };
            picked.iter().map(steps).min().unwrap_or(0)
        };
        let better = |(_, a, one): &Elite<'_>, (_, b, two): &Elite<'_>| {
            let objectives = one.evaluation.objective.total_cmp(&two.evaluation.objective);
            apart(a).cmp(&apart(b)).then(objectives)
        };
        let at = (0..left.len()).max_by(|&a, &b| better(&left[a], &left[b]).then(b.cmp(&a)));
        picked.push(left.swap_remove(at.expect("some are left")));
    }
    let levels: Vec<(usize, Level)> =
        picked.into_iter().map(|(cell, _, elite)| (cell, elite.candidate.clone())).collect();
    shown.extend(levels.iter().map(|(_, level)| key(level)));
    levels
}
