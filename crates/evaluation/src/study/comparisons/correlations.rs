//! The correlations between winning and other variables, as in the paper's correlation matrix (`spec/06` §3
//! and §5.5).

use crate::metrics::EpisodeMetrics;
use crate::study::Study;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{bonferroni, correlation_p, pearson, spearman};

/// The variables to correlate.
pub const CORRELATED: [&str; 4] = ["win", "meaningful", "steps", "distance"];

/// The correlations between four variables over the episodes of models, or of all players if there is no
/// model. The variables are winning (0 or 1), the meaningful step ratio, the number of steps, and the
/// distance travelled in cells.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Correlations {
    /// The number of episodes with known values for all four variables.
    pub episodes: u64,
    /// The number of episodes excluded because a value is missing. For example, episodes without steps or
    /// without an avatar lack a value.
    pub excluded: u64,
    /// The correlations for all six pairs of variables.
    pub pairs: Vec<Correlation>,
}

/// The correlation between two variables in [`CORRELATED`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Correlation {
    /// The indices of the two variables in [`CORRELATED`].
    pub pair: [usize; 2],
    /// Pearson's coefficient with its test, or `None` if a variable is constant.
    pub pearson: Option<Test>,
    /// Spearman's coefficient with a test based on the t approximation, or `None` if a variable is constant.
    pub spearman: Option<Test>,
}

/// A correlation coefficient and its test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Test {
    /// The coefficient, from −1 to 1.
    pub r: f64,
    /// The two-sided p-value. It treats episodes as independent.
    pub p: f64,
    /// The p-value corrected for the number of pairs (Bonferroni).
    pub adjusted: f64,
}

impl Correlations {
    pub(crate) fn of(study: &Study) -> Correlations {
        let episodes: Vec<&EpisodeMetrics> = study.tested().map(|episode| &episode.metrics).collect();
        let known: Vec<[f64; 4]> = episodes.iter().filter_map(|episode| four(episode)).collect();
        let pairs = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
        let values =
            pairs.map(|[a, b]| known.iter().map(|four| (four[a], four[b])).collect::<Vec<(f64, f64)>>());
        let tests = |coefficient: fn(&[(f64, f64)]) -> Option<f64>| {
            let found = values.each_ref().map(|values| {
                let r = coefficient(values)?;
                Some((r, correlation_p(r, values.len())?))
            });
            let adjusted = bonferroni(&found.map(|test| test.map_or(1.0, |(_, p)| p)));
            let test = |at: usize| found[at].map(|(r, p)| Test { r, p, adjusted: adjusted[at] });
            (0..pairs.len()).map(test).collect::<Vec<Option<Test>>>()
        };
        let (linear, ordered) = (tests(pearson), tests(spearman));
        let pairs = pairs.into_iter().zip(linear).zip(ordered);
        Correlations {
            episodes: known.len() as u64,
            excluded: (episodes.len() - known.len()) as u64,
            pairs: pairs.map(|((pair, pearson), spearman)| Correlation { pair, pearson, spearman }).collect(),
        }
    }

    pub(crate) fn table(&self) -> Table {
        let note = format!(
            "Computed over {} episodes, which are treated as independent ({} episodes with a missing value are excluded). Corrected: by \
             Bonferroni, for six pairs. Distance: cells walked.",
            self.episodes, self.excluded
        );
        let columns =
            ["", "", "Pearson", "p", "corrected p", "Spearman", "p of Spearman", "corrected p of Spearman"];
        let mut table = Table::new("correlations", "Correlations", &note, &columns);
        for Correlation { pair, pearson, spearman } in &self.pairs {
            let mut row: Vec<TableCell> = pair.iter().map(|&at| TableCell::text(CORRELATED[at])).collect();
            for test in [pearson, spearman] {
                row.push(TableCell::number(test.map(|test| test.r), 2));
                row.push(TableCell::probability(test.map(|test| test.p)));
                row.push(TableCell::probability(test.map(|test| test.adjusted)));
            }
            table.push(row);
        }
        table
    }
}

fn four(episode: &EpisodeMetrics) -> Option<[f64; 4]> {
    let win = f64::from(u8::from(episode.won()));
    Some([win, episode.meaningful?, episode.steps as f64, episode.movement.displacement? as f64])
}
