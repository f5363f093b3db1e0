//! Which measures an archive of levels tells apart.

use super::aim::names;
use generators::Axis;

/// Bins of an axis at least.
const LEAST_BINS: usize = 8;
/// Elites that an archive has room for, for each level that is wanted of it.
const ROOM: usize = 6;

/// The axes of an archive, and where among all measures theirs are.
pub(super) struct Axes {
    pub(super) axes: Vec<Axis>,
    chosen: Vec<usize>,
}

impl Axes {
    /// The length of the solution, and of all other measures the one in which the levels of a sample differ most, as a share of
    /// what it can be. The ranges are those of the sample, half as wide again on either side.
    ///
    /// `sample` holds the measures of levels, each in the order of [`names`].
    pub(super) fn of(sample: &[Vec<f64>], wanted: usize) -> Axes {
        let others = 1..names().count();
        let column = |at: usize| {
            let mut column: Vec<f64> = sample.iter().map(|measures| measures[at]).collect();
            column.sort_by(f64::total_cmp);
            column
        };
        let spread = |at: usize| {
            let column = column(at);
            let quantile =
                |share: usize| column.get((column.len() * share / 10).min(column.len().max(1) - 1));
            quantile(9).zip(quantile(1)).map_or(0.0, |(high, low)| high - low)
        };
        let most = others.max_by(|&a, &b| spread(a).total_cmp(&spread(b)).then(b.cmp(&a)));
        let chosen: Vec<usize> = [0].into_iter().chain(most).collect();
        let bins = (1..).find(|side| side * side >= ROOM * wanted).unwrap_or(LEAST_BINS).max(LEAST_BINS);
        let axis = |&at: &usize| {
            let column = column(at);
            let (low, high) = (column.first().copied().unwrap_or(0.0), column.last().copied().unwrap_or(1.0));
            let width = if high > low { high - low } else { 1.0 };
            let range = ((low - width / 2.0).max(0.0), high + width / 2.0);
            Axis::new(names().nth(at).expect("it is one of them"), range, bins)
        };
        Axes { axes: chosen.iter().map(axis).collect(), chosen }
    }

    /// The measures of these axes, of all measures.
    pub(super) fn pick(&self, measures: &[f64]) -> Vec<f64> {
        self.chosen.iter().map(|&at| measures[at]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_measure_that_tells_levels_apart_is_chosen() {
        let count = names().count();
        let level = |at: usize| {
            let mut measures = vec![0.5; count];
            (measures[0], measures[5]) = (10.0 + at as f64, at as f64 / 10.0);
            measures
        };
        let sample: Vec<Vec<f64>> = (0..10).map(level).collect();
        let axes = Axes::of(&sample, 10);
        let found: Vec<(&str, (f64, f64), usize)> =
            axes.axes.iter().map(|axis| (axis.name.as_str(), axis.range, axis.bins)).collect();
        let names: Vec<&str> = names().collect();
        assert_eq!(found[0], ("solution length", (5.5, 23.5), 8));
        assert_eq!(found[1].0, names[5]);
        assert_eq!(axes.pick(&sample[3]), [13.0, 0.3]);
        // Nothing to go by is no reason to fail.
        assert_eq!(Axes::of(&[], 1000).axes[0].range, (0.0, 1.5));
    }
}
