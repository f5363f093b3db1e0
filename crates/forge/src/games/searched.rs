//! Searches for games: they look at candidates of any kind, and pass the best ones to the judges.

use super::attempt::Attempted;
use super::candidate::Candidate;
use super::make::Maker;
use crate::levels::Method;
use crate::pipeline::Rules;
use crate::search_loop::{Finalists, run_search};
use crate::tally::Tally;
use base::{Digest, Seed, SeedPath};
use generators::{Annealing, AnnealingConfig, Evaluation, Search, Variation};

/// The feasibility assigned to a game that passed a look and was rejected by the final judges.
pub(super) const REFUSED: f64 = 0.95;

/// Rules that a search can look at.
pub(super) trait Searchable: Rules + Clone + Send + Sync {
    /// Returns a digest; candidates with equal digests are the same.
    fn key(&self) -> Digest;

    /// Looks at the game cheaply.
    fn look(&self, seed: Seed) -> Look;
}

/// The result of a look.
pub(super) struct Look {
    /// The evaluation for the search.
    pub(super) evaluation: Evaluation,
    /// The number of forward-model calls.
    pub(super) calls: u64,
}

impl Maker<'_> {
    /// Runs a search for a number of looks. Unwanted candidates get no look and count as infeasible.
    pub(super) fn search<S>(
        &self,
        search: &mut S,
        (looks, seed): (usize, Seed),
        is_wanted: impl Fn(&S::Candidate) -> bool + Sync,
        tally: &mut Tally,
        mut note: impl FnMut(&S::Candidate, &Evaluation),
    ) where
        S: Search<Candidate: Searchable>,
    {
        let look = |candidate: &S::Candidate| {
            self.progress.looked();
            is_wanted(candidate).then(|| candidate.look(seed.child(&candidate.key().to_string(), 0)))
        };
        let unwanted = Evaluation { feasibility: 0.0, objective: 0.0, measures: Vec::new() };
        run_search(search, (looks, self.order.effort.batch), look, |candidate, look| {
            let Some(look) = look else { return unwanted.clone() };
            tally.look(look.evaluation.is_feasible(), look.calls);
            note(candidate, &look.evaluation);
            look.evaluation
        });
    }

    /// Judges the games that are proposed from a drawn game, until one is accepted.
    pub(super) fn judge_proposed<C: Searchable>(
        &self,
        (drawn, variation): (C, &impl Variation<Candidate = C>),
        attempt: u32,
        seed: &SeedPath,
        objection: &dyn Fn(&Candidate) -> Option<&'static str>,
        attempted: &mut Attempted,
    ) {
        let proposed = self.proposed(drawn, variation, seed.seed(), attempted);
        for (at, candidate) in (0..).zip(&proposed) {
            let judges = seed.child("judges", at);
            attempted.made = self.gate.judge(candidate, attempt, &judges, objection, &mut attempted.tally);
            self.progress.looked();
            if attempted.made.is_some() {
                break;
            }
        }
    }

    /// Returns the games to judge: the best games that a search finds by variation. If there is no search, or if it
    /// finds nothing, returns the drawn game, since the players of a look are weak and cannot win games of some
    /// kernels.
    fn proposed<C: Searchable>(
        &self,
        drawn: C,
        variation: &impl Variation<Candidate = C>,
        seed: Seed,
        attempted: &mut Attempted,
    ) -> Vec<C> {
        let found = match self.order.method {
            Method::Constructive => Vec::new(),
            _ => self.annealed(variation, seed.child("search", 0), attempted),
        };
        if found.is_empty() { vec![drawn] } else { found }
    }

    /// Returns the best games of a search.
    pub(super) fn annealed<C: Searchable>(
        &self,
        variation: &impl Variation<Candidate = C>,
        seed: Seed,
        attempted: &mut Attempted,
    ) -> Vec<C> {
        let looks = self.order.effort.looks as usize;
        let config = AnnealingConfig { starts: looks / 3, ..AnnealingConfig::of(looks) };
        let mut search = Annealing::new(variation, config, seed.child("annealing", 0));
        let mut best = Finalists::new();
        let (effort, tally) = ((looks, seed.child("look", 0)), &mut attempted.tally);
        self.search(
            &mut search,
            effort,
            |_| true,
            tally,
            |candidate, evaluation| {
                best.note(candidate, candidate.key(), evaluation);
            },
        );
        best.into_candidates().collect()
    }
}
