//! A search with two populations: one evolves towards a better objective, the other towards feasibility.

use crate::breeding::Breeding;
use crate::{Evaluated, Evaluation, Search, Variation};
use base::{Digest, Sampler, Seed};

base::with_defaults! {
    /// The parameters of [`FeasibleInfeasible`].
    #[derive(Clone, Debug, PartialEq)]
    pub struct FeasibleInfeasibleConfig {
        /// The maximum size of each of the two populations.
        pub size: usize = 32,
        /// The number of candidates to create before the first one is bred.
        pub initial: usize = 64,
        /// The tournament size: a parent is the best of this many members; 1 chooses blindly, more raises the selection
        /// pressure.
        pub tournament: usize = 3,
        /// The minimum share of each batch that the feasible population breeds, however small it is.
        pub boost: f64 = 0.75,
        /// The probability that a child has two parents.
        pub crossing: f64 = 0.5,
        /// The share of candidates that are created from nothing once breeding has started.
        pub fresh: f64 = 0.05,
    }
}

/// A genetic algorithm with two populations (Kimbrough et al., "On a Feasible-Infeasible Two-Population (FI-2Pop) Genetic
/// Algorithm for Constrained Optimization", 2008).
///
/// Feasible candidates compete by their objective, infeasible ones by their feasibility. Both parents come from one
/// population; each child joins the population that it belongs to, so that each population feeds the other. The feasible
/// one breeds at least a given share of every batch, however small it is (the offspring boost of Liapis et al.,
/// "Enhancements to Constrained Novelty Search", 2013). Members stay until better ones displace them, and no candidate is
/// asked for twice.
///
/// ```
/// # use base as infinite_arcade_base;
/// use infinite_arcade_base::{Digest, Sampler, Seed};
/// use infinite_arcade_generators::{Evaluation, FeasibleInfeasible, FeasibleInfeasibleConfig, Search, Variation};
///
/// /// Numbers below 1000, one decimal digit changed at a time.
/// struct Digits;
///
/// impl Variation for Digits {
///     type Candidate = u32;
///     fn create(&self, seed: Seed) -> Option<u32> {
///         Some(seed.sampler().below(1000) as u32)
///     }
///     fn mutate(&self, parent: &u32, sampler: &mut Sampler) -> u32 {
///         let place = *sampler.choose(&[1, 10, 100]);
///         parent - parent / place % 10 * place + sampler.below(10) as u32 * place
///     }
///     fn cross(&self, one: &u32, two: &u32, _: &mut Sampler) -> u32 {
///         one / 100 * 100 + two % 100
///     }
/// }
///
/// // The highest number without an odd digit.
/// let config = FeasibleInfeasibleConfig::default();
/// let key = |number: &u32| Digest::of(&number.to_le_bytes());
/// let mut search = FeasibleInfeasible::new(&Digits, key, config, Seed::from_text("digits"));
/// for _ in 0..20 {
///     let judge = |number: u32| {
///         let even = [1, 10, 100].iter().filter(|&place| number / place % 2 == 0).count();
///         let (feasibility, objective) = (even as f64 / 3.0, f64::from(number) / 1000.0);
///         (number, Evaluation { feasibility, objective, measures: Vec::new() })
///     };
///     let judged = search.ask(16).into_iter().map(judge).collect();
///     search.tell(judged);
/// }
/// assert_eq!(search.feasible()[0].candidate, 888);
/// ```
pub struct FeasibleInfeasible<'a, V: Variation> {
    config: FeasibleInfeasibleConfig,
    breeding: Breeding<'a, V>,
    /// Candidates that are still to be created before breeding starts.
    initial: usize,
    /// By objective, the best first; among equals the youngest first.
    feasible: Vec<Evaluated<V::Candidate>>,
    /// By feasibility, the best first; among equals the youngest first.
    infeasible: Vec<Evaluated<V::Candidate>>,
}

impl<'a, V: Variation> FeasibleInfeasible<'a, V> {
    /// Creates a search that has not begun. Candidates with equal keys are the same. A population has at least one member, and a
    /// tournament at least one entrant.
    pub fn new(
        variation: &'a V,
        key: impl Fn(&V::Candidate) -> Digest + Send + 'a,
        config: FeasibleInfeasibleConfig,
        seed: Seed,
    ) -> Self {
        let (size, tournament) = (config.size.max(1), config.tournament.max(1));
        let config = FeasibleInfeasibleConfig { size, tournament, ..config };
        let breeding = Breeding::new(variation, Box::new(key), config.crossing, seed);
        let initial = config.initial.max(1);
        FeasibleInfeasible { config, breeding, initial, feasible: Vec::new(), infeasible: Vec::new() }
    }

    /// The feasible population, the best first.
    pub fn feasible(&self) -> &[Evaluated<V::Candidate>] {
        &self.feasible
    }

    /// The infeasible population, the closest to feasible first.
    pub fn infeasible(&self) -> &[Evaluated<V::Candidate>] {
        &self.infeasible
    }

    fn propose(&mut self) -> Option<V::Candidate> {
        let mut sampler = self.breeding.next_sampler();
        let is_fresh = sampler.unit() < self.config.fresh;
        let (feasible, infeasible) = (self.feasible.len(), self.infeasible.len());
        if self.initial > 0 || is_fresh || feasible + infeasible == 0 {
            self.initial = self.initial.saturating_sub(1);
            return self.breeding.create();
        }
        // Without the boost, each would breed in proportion to its size.
        let share = feasible as f64 / (feasible + infeasible) as f64;
        let is_feasible = feasible > 0 && sampler.unit() < share.max(self.config.boost);
        let population = if is_feasible || infeasible == 0 { &self.feasible } else { &self.infeasible };
        let parent = tournament(population.len(), self.config.tournament, &mut sampler);
        let mate = tournament(population.len(), self.config.tournament, &mut sampler);
        let mate = (mate != parent).then(|| &population[mate].candidate);
        let child = self.breeding.breed(&population[parent].candidate, mate, &mut sampler);
        child.or_else(|| self.breeding.create())
    }
}

impl<V: Variation> Search for FeasibleInfeasible<'_, V> {
    type Candidate = V::Candidate;

    /// Returns fewer than `count` only if the variation yields nothing new; a later call may return more.
    fn ask(&mut self, count: usize) -> Vec<V::Candidate> {
        (0..count).filter_map(|_| self.propose()).collect()
    }

    /// Also accepts candidates that were not asked for, as a start.
    fn tell(&mut self, evaluated: Vec<(V::Candidate, Evaluation)>) {
        for (candidate, evaluation) in evaluated {
            self.breeding.note(&candidate);
            let judged = Evaluated { candidate, evaluation };
            let size = self.config.size;
            if judged.evaluation.is_feasible() {
                insert_ranked(&mut self.feasible, judged, size, |evaluation| evaluation.objective);
            } else {
                insert_ranked(&mut self.infeasible, judged, size, |evaluation| evaluation.feasibility);
            }
        }
    }
}

/// Draws a few members of a sorted population and returns the index of the best.
fn tournament(members: usize, size: usize, sampler: &mut Sampler) -> usize {
    (0..size).map(|_| sampler.below(members)).min().expect("a tournament has entrants")
}

/// Inserts a member at its rank, before its equals, and drops the last one if there are too many.
fn insert_ranked<C>(
    population: &mut Vec<Evaluated<C>>,
    judged: Evaluated<C>,
    size: usize,
    merit: impl Fn(&Evaluation) -> f64,
) {
    let place = population.partition_point(|kept| merit(&kept.evaluation) > merit(&judged.evaluation));
    population.insert(place, judged);
    population.truncate(size);
}
