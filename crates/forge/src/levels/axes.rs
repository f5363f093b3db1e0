//! The measures by which an archive distinguishes levels.

use super::aim::{OF_PLAY, names};
use super::look::Look;
use generators::Axis;

/// The number of axes of an archive.
const AXES: usize = 2;
/// The minimum number of bins per axis.
const LEAST_BINS: usize = 8;
/// The number of archive cells provided per requested level.
const ROOM: usize = 6;
/// The minimum number of won levels in a sample for which the measures of wins serve to distinguish levels.
const LEAST_WON: usize = 4;

/// An archive's axes, and their indices among all measures.
pub(super) struct Axes {
    pub(super) axes: Vec<Axis>,
    chosen: Vec<usize>,
}

impl Axes {
    /// Chooses two axes: the solution length and the other measure in which a sample's won levels differ most from each
    /// other. If hardly any level was won, chooses the two board measures in which all levels differ most from each
    /// other. The ranges are those of the sample without outliers, extended by half at both ends.
    ///
    /// Each quick evaluation in the sample contains all measures, in the order of [`names`].
    pub(super) fn of<'a>(sample: impl Iterator<Item = &'a Look> + Clone, wanted: usize) -> Axes {
        let won: Vec<&Look> = sample.clone().filter(|look| look.is_won).collect();
        let is_enough = won.len() >= LEAST_WON;
        let sample: Vec<&Look> = if is_enough { won } else { sample.collect() };
        let range = |at: usize| {
            let mut column: Vec<f64> = sample.iter().map(|look| look.evaluation.measures[at]).collect();
            column.sort_by(f64::total_cmp);
            let decile = |share: usize| column.get((column.len() * share / 10).min(column.len().max(1) - 1));
            decile(1).zip(decile(9)).map_or((0.0, 1.0), |(low, high)| (*low, *high))
        };
        let spread = |at: usize| range(at).1 - range(at).0;
        let fixed = if is_enough { vec![0] } else { Vec::new() };
        let mut others: Vec<usize> = (if is_enough { 1 } else { OF_PLAY.len() }..names().count()).collect();
        others.sort_by(|&a, &b| spread(b).total_cmp(&spread(a)).then(a.cmp(&b)));
        let chosen: Vec<usize> = fixed.into_iter().chain(others).take(AXES).collect();
        let bins = (1..).find(|side| side * side >= ROOM * wanted).unwrap_or(LEAST_BINS).max(LEAST_BINS);
        let axis = |&at: &usize| {
            let (low, high) = range(at);
            let width = if high > low { high - low } else { 1.0 };
            let range = ((low - width / 2.0).max(0.0), high + width / 2.0);
            Axis::new(names().nth(at).expect("the measure is in the list"), range, bins)
        };
        Axes { axes: chosen.iter().map(axis).collect(), chosen }
    }

    /// Picks the values for this archive's axes from the values of all measures.
    pub(super) fn pick(&self, measures: &[f64]) -> Vec<f64> {
        self.chosen.iter().map(|&at| measures[at]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use generators::Evaluation;

    /// Returns the quick evaluation of a level. Levels with different `at` differ in measures 5 and 6, and won levels
    /// also differ in the length of the win.
    fn look(at: usize, is_won: bool) -> Look {
        let mut measures = vec![0.5; names().count()];
        measures[..OF_PLAY.len()].fill(0.0);
        (measures[5], measures[6]) = (at as f64 / 10.0, at as f64 / 20.0);
        if is_won {
            measures[0] = 10.0 + at as f64;
        }
        let evaluation = Evaluation { feasibility: 1.0, objective: 0.5, measures };
        Look { evaluation, obstacle: None, is_won, calls: 0, effort: 1.0 }
    }

    fn found(axes: &Axes) -> Vec<(&str, (f64, f64), usize)> {
        axes.axes.iter().map(|axis| (axis.name.as_str(), axis.range, axis.bins)).collect()
    }

    #[test]
    fn the_measure_that_tells_levels_apart_is_chosen() {
        let sample: Vec<Look> = (0..10).map(|at| look(at, true)).collect();
        let axes = Axes::of(sample.iter(), 10);
        let names: Vec<&str> = names().collect();
        assert_eq!(found(&axes)[0], ("solution length", (7.0, 23.0), 8));
        assert_eq!(found(&axes)[1].0, names[5]);
        assert_eq!(axes.pick(&sample[3].evaluation.measures), [13.0, 0.3]);
        // An empty sample must not fail.
        assert_eq!(Axes::of([].iter(), 1000).axes[0].range, (0.0, 1.5));
    }

    /// Levels without a win have no win length, so they would all share one bin.
    #[test]
    fn levels_without_a_win_are_told_apart_by_their_boards() {
        let names: Vec<&str> = names().collect();
        let chosen = |won: usize| {
            let sample: Vec<Look> = (0..30).map(|at| look(at % 10, at < won)).collect();
            found(&Axes::of(sample.iter(), 10)).iter().map(|axis| axis.0.to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(chosen(3), [names[5], names[6]]);
        assert_eq!(chosen(10), ["solution length", names[5]]);
    }
}
