//! Searches for invented games. They evaluate inventions quickly and pass the best to the judges.

use super::attempt::Attempted;
use super::make::Maker;
use crate::pipeline::Rules;
use crate::search_loop::{Finalists, run_search};
use crate::tally::Tally;
use base::Seed;
use generators::invention::{Invention, Profile};
use generators::{Annealing, AnnealingConfig, Evaluation, Search, Variation};

/// The feasibility of a game that passed a quick evaluation but was rejected by the final judges.
pub(super) const REFUSED: f64 = 0.95;

/// Evaluates an invention cheaply. Returns the evaluation and the number of forward-model calls. Costs as much as the
/// pipeline stage `quick look`.
fn look(invention: &Invention, seed: Seed) -> (Evaluation, u64) {
    let Profile { coupling, verb, pace } = invention.profile();
    let measures = vec![coupling as f64, verb.number() as f64, pace];
    let Some((game, boards)) = Rules::build(invention) else {
        return (Evaluation { feasibility: 0.0, objective: 0.0, measures }, 0);
    };
    let look = boards.look_quickly(&game.rules, seed);
    let (feasibility, objective) = (look.feasibility(), look.quality());
    (Evaluation { feasibility, objective, measures }, look.calls)
}

impl Maker<'_> {
    /// Runs a search with a given number of quick evaluations.
    pub(super) fn search(
        &self,
        search: &mut impl Search<Candidate = Invention>,
        (looks, seed): (usize, Seed),
        tally: &mut Tally,
        mut note: impl FnMut(&Invention, &Evaluation),
    ) {
        let look = |candidate: &Invention| {
            self.progress.looked();
            look(candidate, seed.child(&candidate.key().to_string(), 0))
        };
        run_search(search, (looks, self.order.effort.batch), look, |candidate, (evaluation, calls)| {
            tally.look(evaluation.is_feasible(), calls);
            note(candidate, &evaluation);
            evaluation
        });
    }

    /// Returns the best games found by a search.
    pub(super) fn annealed(
        &self,
        variation: &impl Variation<Candidate = Invention>,
        seed: Seed,
        attempted: &mut Attempted,
    ) -> Vec<Invention> {
        let looks = self.order.effort.looks as usize;
        let config = AnnealingConfig { starts: looks / 3, ..AnnealingConfig::of(looks) };
        let mut search = Annealing::new(variation, config, seed.child("annealing", 0));
        let mut best = Finalists::new();
        let effort = (looks, seed.child("look", 0));
        self.search(&mut search, effort, &mut attempted.tally, |candidate, evaluation| {
            best.note(candidate, candidate.key(), evaluation);
        });
        best.into_candidates().collect()
    }
}
