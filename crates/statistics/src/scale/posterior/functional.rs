//! Linear functions of the effects, used to compute the abilities, difficulties and months in a calibration.

use super::Model;
use crate::scale::plays::Dimension;
use crate::scale::spreads::Spreads;
use nalgebra::DVector;

/// A linear function of all effects, with a constant term.
pub(in crate::scale) struct Functional {
    pub(in crate::scale) constant: f64,
    pub(in crate::scale) shared: DVector<f64>,
    pub(in crate::scale) games: Vec<DVector<f64>>,
}

impl Model<'_> {
    /// Returns the functional that is zero everywhere.
    fn nothing(&self) -> Functional {
        Functional {
            constant: 0.0,
            shared: DVector::zeros(self.shared()),
            games: self.layouts.iter().map(|layout| DVector::zeros(layout.size)).collect(),
        }
    }

    /// Returns the functional for a shared parameter.
    pub(in crate::scale) fn shared_functional(&self, at: usize) -> Functional {
        let mut found = self.nothing();
        found.shared[at] = 1.0;
        found
    }

    /// Returns the functionals for the difficulties of a game's levels.
    pub(in crate::scale) fn game_functionals(
        &self,
        spreads: &Spreads,
        game: usize,
        dimension: Dimension,
    ) -> Vec<Functional> {
        let of_level = |level: usize| {
            let mut found = self.nothing();
            self.add_level(&mut found, spreads, (game, level), dimension, 1.0);
            found
        };
        (0..self.layouts[game].levels).map(of_level).collect()
    }

    fn add_level(
        &self,
        to: &mut Functional,
        spreads: &Spreads,
        (game, level): (usize, usize),
        dimension: Dimension,
        share: f64,
    ) {
        for (at, factor) in self.shift_terms(spreads, dimension) {
            to.shared[at] += share * factor;
        }
        for (at, factor) in self.difficulty_terms(spreads, game, level, dimension) {
            to.games[game][at] += share * factor;
        }
    }

    /// Returns all levels, as pairs of game index and level index.
    fn levels(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let layouts = self.layouts.iter().enumerate();
        layouts.flat_map(|(game, layout)| (0..layout.levels).map(move |level| (game, level)))
    }

    /// Returns the functional for the mean difficulty of all levels.
    pub(in crate::scale) fn mean_functional(&self, spreads: &Spreads, dimension: Dimension) -> Functional {
        let mut found = self.nothing();
        let share = 1.0 / self.levels().count() as f64;
        for level in self.levels() {
            self.add_level(&mut found, spreads, level, dimension, share);
        }
        found
    }

    /// Returns the functional for the planners' mean logit on all levels, which is the levels' ease for exactly these
    /// planners.
    pub(in crate::scale) fn planners_functional(&self, spreads: &Spreads) -> Functional {
        let mut found = self.nothing();
        let planners: Vec<usize> = (0..self.examinees.len())
            .filter(|&at| self.examinees[at].dimension == Dimension::Planner)
            .collect();
        let share = 1.0 / (self.levels().count() * planners.len()) as f64;
        for (game, level) in self.levels() {
            for &planner in &planners {
                let (shared, offset) = self.shared_terms(spreads, planner);
                found.constant += share * offset;
                for (at, factor) in shared {
                    found.shared[at] += share * factor;
                }
                for (at, factor) in self.terms(spreads, game, planner, level) {
                    found.games[game][at] += share * factor;
                }
            }
        }
        found
    }
}
