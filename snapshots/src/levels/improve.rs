//! Searches under the eyes of judges: each level by itself, or an archive of levels that differ.

use super::accept::Gate;
use super::aim::Aim;
use super::axes::Axes;
use super::look::{Look, Looker};
use super::make::{Attempt, Cost, LevelSet, Maker, NO_BOARD, TWICE, made};
use crate::striving::{Finalists, spread, strive};
use engine::{Digest, Level};
use generators::Variation;
use generators::levels::LevelSearch;
use generators::{Annealing, AnnealingConfig, Evaluation, MapElites, MapElitesConfig, Search};
use rayon::prelude::*;
use std::collections::BTreeSet;

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
            let mut best = Finalists::new();
            self.strive(&mut search, looks, &looker, &mut cost, |level, evaluation| {
                best.note(level, level.digest(), evaluation)
            });
            for level in best.into_candidates() {
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
        let look = |level: &Level| {
            let look = looker.look(level);
            self.progress.looked();
            look
        };
        let effort = (looks, self.order.effort.batch);
        let asked_all = strive(search, effort, look, |level, look| {
            cost.looked(&look);
            let mut evaluation = look.evaluation;
            note(level, &mut evaluation);
            evaluation
        });
        if !asked_all {
            cost.reject(NO_BOARD);
        }
    }
}
