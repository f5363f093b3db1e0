//! Searches guided by judges: either one search per level, or a diverse archive of levels.

use super::aim::Aim;
use super::axes::Axes;
use super::look::{LEAST_EFFORT, Look, Looker};
use super::make::{Attempt, LevelSet, Maker, NO_BOARD, TWICE};
use super::order::MadeLevel;
use super::report::NEAR;
use crate::pipeline::LevelGate;
use crate::search_loop::{Finalists, run_search, spread};
use crate::tally::Tally;
use base::Digest;
use engine::Level;
use generators::Variation;
use generators::levels::LevelSearch;
use generators::{Annealing, AnnealingConfig, MapElites, MapElitesConfig, Search};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// The feasibility of a level that passed a quick evaluation and was rejected by the panel.
const REFUSED: f64 = 0.95;
/// The fraction of an archive's effort spent on new levels before breeding starts. New levels differ more from each
/// other than edited levels do.
const CREATION: f64 = 0.4;
/// The fraction of candidates that are new levels, after breeding has started.
const FRESH: f64 = 0.1;
/// The number of initial rounds in which no two nearly equal levels are accepted. In later rounds, a nearly equal level
/// is better than none.
const CHOOSY: u32 = 2;

impl Maker<'_> {
    /// Searches for a level by annealing until the panel accepts a result. Each round is a separate search. The number
    /// of rounds is higher if most quick evaluations are cheap.
    pub(super) fn search_level(
        &self,
        variation: &LevelSearch<'_>,
        number: u32,
        refused: &BTreeSet<Digest>,
    ) -> Attempt {
        let seed = self.level_seed(number);
        let aim = Aim::new(self.analysis, self.order, &self.criteria);
        let looker = Looker::new(self.analysis, self.order, aim, seed.child("look", 0));
        let gate = LevelGate::new(self.analysis, self.order, &self.criteria, seed.child("gate", 0));
        let looks = self.order.effort.looks as usize;
        let mut tally = Tally::default();
        let mut left = f64::from(self.order.effort.rounds * self.order.effort.looks);
        let mut round = 0;
        while left > 0.0 {
            // Half of the quick evaluations serve to find a starting level that is worth improving, because edits
            // change a level less than levels differ from each other.
            let config = AnnealingConfig { starts: looks / 2, ..AnnealingConfig::of(looks) };
            let mut search = Annealing::new(variation, config, seed.child("round", round));
            let mut best = Finalists::new();
            let mut spent = 0.0;
            self.run_search(&mut search, looks, &looker, &mut tally, |level, look| {
                spent += look.effort.min(1.0);
                best.note(level, level.digest(), &look.evaluation);
            });
            for level in best.into_candidates() {
                if refused.contains(&self.likeness.digest(&level)) {
                    tally.reject(TWICE);
                    continue;
                }
                let (made, spent) = gate.judge(number, &level);
                tally.add(&spent);
                if made.is_some() {
                    return (made, tally);
                }
                if self.is_hopeless(&tally) {
                    return (None, tally);
                }
            }
            // A round counts at a minimum cost even if all its quick evaluations are cheap. It counts at full cost if
            // the search could not propose any level.
            let least = if spent > 0.0 { LEAST_EFFORT } else { 1.0 };
            left -= spent.max(least * looks as f64);
            round += 1;
        }
        (None, tally)
    }

    /// Fills an archive and picks diverse levels from it, until the panel has accepted enough.
    pub(super) fn evolve_levels(&self, variation: &LevelSearch<'_>) -> LevelSet {
        let aim = Aim::new(self.analysis, self.order, &self.criteria);
        let looker = Looker::new(self.analysis, self.order, aim, self.seed.child("look", 0));
        let gate = LevelGate::new(self.analysis, self.order, &self.criteria, self.seed.child("gate", 0));
        let wanted = self.order.count as usize;
        let effort = f64::from(self.order.effort.looks) * wanted as f64;
        let mut set = LevelSet { levels: Vec::new(), tally: Tally::default() };
        let found = self.create_levels(variation, &looker, CREATION * effort, &mut set.tally);
        let axes = Axes::of(found.iter().map(|(_, look)| look), wanted);
        let config = MapElitesConfig { initial: 1, fresh: FRESH, ..MapElitesConfig::default() };
        let key = |level: &Level| self.likeness.digest(level);
        let seed = self.seed.child("archive", 0);
        let mut search = MapElites::new(variation, key, axes.axes.clone(), config, seed);
        let place = |look: &mut Look| look.evaluation.measures = axes.pick(&look.evaluation.measures);
        let told = found.into_iter().map(|(level, mut look)| {
            place(&mut look);
            (level, look.evaluation)
        });
        search.tell(told.collect());
        let (mut shown, mut taken) = (BTreeSet::new(), Vec::new());
        let mut left = (1.0 - CREATION) * effort;
        for round in 0..self.order.effort.rounds {
            let batch = self.order.effort.batch;
            while left > 0.0 {
                let told = |_: &Level, look: &mut Look| {
                    left -= look.effort;
                    place(look);
                };
                if !self.run_search(&mut search, batch, &looker, &mut set.tally, told) {
                    break;
                }
            }
            // Many levels that pass a quick evaluation are not good enough, so all of them are judged before more
            // levels are bred.
            while set.levels.len() < wanted {
                let is_near =
                    |one: &Level, other: &Level| round < CHOOSY && self.likeness.distance(one, other) <= NEAR;
                let missing = wanted - set.levels.len();
                let picked = spread(search.archive(), missing, &taken, is_near, &mut shown, key);
                if picked.is_empty() {
                    break;
                }
                let judged: Vec<_> = picked.par_iter().map(|(_, level)| gate.judge(0, level)).collect();
                for ((cell, level), (made, tally)) in picked.into_iter().zip(judged) {
                    set.tally.add(&tally);
                    let Some(made) = made else {
                        search.demote(cell, REFUSED);
                        continue;
                    };
                    let number = set.levels.len() as u32;
                    self.progress.made(&format!("level {number}"));
                    taken.push((cell, level));
                    set.levels.push(MadeLevel { number, ..made });
                }
            }
            if set.levels.len() == wanted {
                break;
            }
            left = effort;
        }
        set
    }

    /// Creates levels until the effort is spent. These levels show which measures distinguish the game's levels, and
    /// they form the initial archive.
    fn create_levels(
        &self,
        variation: &LevelSearch<'_>,
        looker: &Looker<'_>,
        effort: f64,
        tally: &mut Tally,
    ) -> Vec<(Level, Look)> {
        let seed = self.seed.child("created", 0);
        let batch = self.order.effort.batch.max(1) as u64;
        let most = (effort / LEAST_EFFORT).ceil() as u64;
        let mut found: Vec<(Level, Look)> = Vec::new();
        let (mut at, mut spent) = (0, 0.0);
        while spent < effort && at < most {
            let levels =
                (at..at + batch).into_par_iter().filter_map(|at| variation.create(seed.child("level", at)));
            let looked: Vec<(Level, Look)> = levels
                .map(|level| {
                    let look = looker.look(&level);
                    self.progress.looked();
                    (level, look)
                })
                .collect();
            for (_, look) in &looked {
                look.count(tally);
                spent += look.effort;
            }
            found.extend(looked);
            at += batch;
            if found.is_empty() && at as f64 >= effort {
                // Stop after the usual number of quick evaluations without a level, because further attempts will fail
                // as well.
                break;
            }
        }
        found
    }

    /// Runs a search, evaluates its proposals on all threads, and reports the results to the search. Returns `true` if
    /// the search proposed the requested number of levels.
    fn run_search<S: Search<Candidate = Level>>(
        &self,
        search: &mut S,
        looks: usize,
        looker: &Looker<'_>,
        tally: &mut Tally,
        mut note: impl FnMut(&Level, &mut Look),
    ) -> bool {
        let look = |level: &Level| {
            let look = looker.look(level);
            self.progress.looked();
            look
        };
        let effort = (looks, self.order.effort.batch);
        let asked_all = run_search(search, effort, look, |level, mut look| {
            look.count(tally);
            note(level, &mut look);
            look.evaluation
        });
        if !asked_all {
            tally.reject(NO_BOARD);
        }
        asked_all
    }
}
