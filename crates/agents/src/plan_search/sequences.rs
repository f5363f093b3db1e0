//! Plans as action sequences, for the planners that search for such sequences: random search and evolution.

use crate::guides::heuristics::Heuristic;
use crate::planner::{Budget, Decision};
use engine::{Action, Game, State};

/// A gene: an index into the action alphabet.
pub(crate) type Gene = u8;

/// Evaluates sequences in one decision and counts the forward-model calls.
pub(crate) struct Sequences<'a> {
    game: &'a Game,
    state: &'a State,
    heuristic: Heuristic,
    /// The avatar's actions, including [`Action::Nil`].
    alphabet: Vec<Action>,
    copy: State,
    budget: u64,
    calls: u64,
}

impl<'a> Sequences<'a> {
    pub(crate) fn new(
        game: &'a Game,
        state: &'a State,
        heuristic: Heuristic,
        budget: Budget,
        scratch: Option<State>,
    ) -> Sequences<'a> {
        let mut alphabet = game.actions(state).to_vec();
        if !alphabet.contains(&Action::Nil) {
            alphabet.push(Action::Nil);
        }
        let copy = scratch.unwrap_or_else(|| state.clone());
        Sequences { game, state, heuristic, alphabet, copy, budget: budget.0, calls: 0 }
    }

    /// Draws a random gene.
    pub(crate) fn gene(&self, decision: &mut Decision) -> Gene {
        decision.choices.below(self.alphabet.len()) as Gene
    }

    /// Returns `true` if a gene stands for an action. A transformed avatar may have fewer actions than before.
    pub(crate) fn has(&self, gene: Gene) -> bool {
        usize::from(gene) < self.alphabet.len()
    }

    /// Draws a random sequence.
    pub(crate) fn random(&self, horizon: usize, decision: &mut Decision) -> Vec<Gene> {
        (0..horizon).map(|_| self.gene(decision)).collect()
    }

    pub(crate) fn action(&self, gene: Gene) -> Action {
        self.alphabet[usize::from(gene)]
    }

    /// Returns the value of the state after a sequence, or of the episode's final state if the episode ends first. If
    /// the budget runs out earlier, returns the value of the state at that point, as the reference does.
    pub(crate) fn value(&mut self, genes: &[Gene], decision: &mut Decision) -> f64 {
        decision.fork_with_random_future(&mut self.copy, self.state);
        for &gene in genes {
            if self.copy.is_over() || self.is_spent() {
                break;
            }
            self.game.step(&mut self.copy, self.alphabet[usize::from(gene)]);
            self.calls += 1;
        }
        self.heuristic.value(self.game, self.state, &self.copy)
    }

    /// Returns the number of forward-model calls so far.
    pub(crate) fn calls(&self) -> u64 {
        self.calls
    }

    /// Returns `true` if the budget is spent or the game is over.
    pub(crate) fn is_spent(&self) -> bool {
        self.calls >= self.budget || self.state.is_over()
    }

    /// Returns the state buffer, so that the next decision can reuse it.
    pub(crate) fn into_scratch(self) -> State {
        self.copy
    }
}
