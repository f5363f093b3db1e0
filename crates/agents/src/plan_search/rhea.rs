//! Rolling-horizon evolution, like the reference's `sampleRHEA`, with a budget in forward-model calls (`spec/04` §3).
//!
//! See Perez Liebana et al. 2013, "Rolling horizon evolution versus tree search for navigation in
//! single-player real-time games".

use super::sequences::{Gene, Sequences};
use crate::guides::heuristics::Heuristic;
use crate::planner::{Budget, Decision, Planner, Streams};
use base::Seed;
use engine::{Action, Game, State};
use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// The parameters of [`Rhea`]. The defaults match the reference.
    #[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct RheaConfig {
        /// The number of plans in the population. It is smaller if the budget does not suffice to try all plans.
        pub population: usize = 10,
        /// The length of a plan in ticks.
        pub horizon: usize = 10,
        /// The number of genes to redraw in each child. A redrawn gene may get its old value again.
        pub mutations: usize = 1,
        /// The heuristic that evaluates a plan's final state.
        pub heuristic: Heuristic = Heuristic::WinScore,
        /// `true` to start each decision from the plans of the previous decision, shifted by one tick and completed
        /// with a random last action. The reference starts each decision from random plans instead. Off by default.
        pub shift: bool = false,
    }
}

/// A planner that evolves plans in each decision and plays the first action of the best plan.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Rhea {
    config: RheaConfig,
    streams: Streams,
    /// The last decision's plans, best first. The plans are stored only if `shift` is set.
    plans: Vec<Vec<Gene>>,
    #[serde(skip)]
    scratch: Option<State>,
}

struct Individual {
    genes: Vec<Gene>,
    value: f64,
}

impl Rhea {
    /// Creates a planner with its own random-number streams for choices and imagined outcomes.
    pub fn new(config: RheaConfig, seed: Seed) -> Rhea {
        Rhea { config, streams: Streams::new(seed), plans: Vec::new(), scratch: None }
    }

    /// Creates the first generation. The budget limits its size, but there is at least one plan.
    fn first(
        &mut self,
        sequences: &mut Sequences<'_>,
        budget: Budget,
        decision: &mut Decision,
    ) -> Vec<Individual> {
        let horizon = self.config.horizon.max(1);
        let affordable = usize::try_from(budget.0 / horizon as u64).unwrap_or(usize::MAX);
        let size = self.config.population.min(affordable).max(1);
        let known = |genes: &Vec<Gene>| genes.iter().all(|&gene| sequences.has(gene));
        let mut plans: Vec<Vec<Gene>> = std::mem::take(&mut self.plans);
        plans.retain(known);
        let mut plans = plans.into_iter();
        let mut population: Vec<Individual> = Vec::with_capacity(size);
        while population.len() < size && (population.is_empty() || !sequences.is_spent()) {
            let genes = match plans.next() {
                Some(mut genes) => {
                    genes.rotate_left(1);
                    genes[horizon - 1] = sequences.gene(decision);
                    genes
                }
                None => sequences.random(horizon, decision),
            };
            let value = sequences.value(&genes, decision);
            population.push(Individual { genes, value });
        }
        best_first(&mut population);
        population
    }

    /// Creates a child of two distinct plans. Each gene comes from one of the two plans, and then a few genes are
    /// redrawn. If there is only one plan, creates a mutant of that plan. There is no selection of parents, because the
    /// reference's tournament is as large as the set of parents.
    fn child(
        &self,
        population: &[Individual],
        sequences: &Sequences<'_>,
        decision: &mut Decision,
    ) -> Vec<Gene> {
        let mut genes = if population.len() > 1 {
            let one = decision.choices.below(population.len());
            let other = decision.choices.below(population.len() - 1);
            let other = if other < one { other } else { other + 1 };
            let parents = [&population[one].genes, &population[other].genes];
            (0..parents[0].len()).map(|at| parents[decision.choices.below(2)][at]).collect()
        } else {
            population[0].genes.clone()
        };
        for _ in 0..self.config.mutations {
            let at = decision.choices.below(genes.len());
            genes[at] = sequences.gene(decision);
        }
        genes
    }
}

/// Sorts the plans by value, best first. The sort is stable, so the oldest of several equally good plans comes first.
fn best_first(population: &mut [Individual]) {
    population.sort_by(|a, b| b.value.total_cmp(&a.value));
}

impl Planner for Rhea {
    fn plan(&mut self, game: &Game, state: &State, budget: Budget) -> (Action, u64) {
        let mut decision = self.streams.next();
        let heuristic = self.config.heuristic;
        let mut sequences = Sequences::new(game, state, heuristic, budget, self.scratch.take());
        let mut population = self.first(&mut sequences, budget, &mut decision);
        while !sequences.is_spent() {
            // The best plan survives, and children replace all other plans. There is at least one child.
            let mut next = Vec::with_capacity(population.len());
            for _ in 1..population.len().max(2) {
                if sequences.is_spent() {
                    break;
                }
                let genes = self.child(&population, &sequences, &mut decision);
                let value = sequences.value(&genes, &mut decision);
                next.push(Individual { genes, value });
            }
            let size = population.len();
            // If the budget runs out, some plans survive that would otherwise have been replaced. None of them is
            // better than the best plan.
            population.splice(1..(1 + next.len()).min(size), next);
            best_first(&mut population);
            population.truncate(size);
        }
        let (action, calls) = (sequences.action(population[0].genes[0]), sequences.calls());
        if self.config.shift {
            self.plans = population.into_iter().map(|individual| individual.genes).collect();
        }
        self.scratch = Some(sequences.into_scratch());
        (action, calls)
    }
}
