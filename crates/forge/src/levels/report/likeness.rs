//! The similarity of levels to each other, and to the game's own levels.

use crate::survey::SurveyedLevel;
use base::Digest;
use generators::levels::LevelSimilarity;
use rayon::prelude::*;
use report::{Mean, Section, Share};
use std::collections::BTreeSet;

/// The maximum distance between levels that count as near-duplicates, from 0 (equal) to 1.
pub(crate) const NEAR: f64 = 0.05;

/// The distances between the levels in a set.
pub(super) struct Distances {
    /// For each level, its mean distance to the other levels, if there are any.
    means: Vec<f64>,
    /// For each level, the distance to the nearest other level.
    pub(super) nearest: Vec<Option<f64>>,
}

impl Distances {
    /// Computes the distances, using all threads. Cost: one comparison per pair of levels.
    pub(super) fn of(levels: &[SurveyedLevel], likeness: &LevelSimilarity) -> Distances {
        let row = |at: usize| -> Vec<f64> {
            let others = levels.iter().enumerate().filter(|(other, _)| *other != at);
            others.map(|(_, other)| likeness.distance(&levels[at].level, &other.level)).collect()
        };
        let rows: Vec<Vec<f64>> = (0..levels.len()).into_par_iter().map(row).collect();
        let compared = rows.iter().filter(|row| !row.is_empty());
        let means = compared.map(|row| row.iter().sum::<f64>() / row.len() as f64).collect();
        Distances { means, nearest: rows.iter().map(|row| least(row.iter().copied())).collect() }
    }

    fn known(&self) -> Vec<f64> {
        self.nearest.iter().flatten().copied().collect()
    }
}

pub(super) fn diversity(
    levels: &[SurveyedLevel],
    distances: &Distances,
    likeness: &LevelSimilarity,
) -> Section {
    let nearest = distances.known();
    let unique = Share::new(forms(levels, likeness).len() as u64, levels.len() as u64);
    Section::new(
        "diversity",
        "How different are the levels?",
        "Distances range from 0 (the same level) to 1.",
    )
    .share("unique", "unique up to symmetry", unique)
    .mean("distance", "distance between two levels", Mean::over("level", &distances.means))
    .share("near_duplicates", format!("near-duplicates: within {NEAR} of another level"), near(&nearest))
    .quantiles("nearest", "distance to the most similar other level", &nearest)
}

/// Describes the distances to the game's own levels; `None` if the game has no levels of its own.
pub(super) fn novelty(
    levels: &[SurveyedLevel],
    examples: &[SurveyedLevel],
    likeness: &LevelSimilarity,
) -> Option<Section> {
    let to_examples = |level: &SurveyedLevel| {
        least(examples.iter().map(|example| likeness.distance(&level.level, &example.level)))
    };
    let nearest: Vec<f64> = levels.par_iter().filter_map(to_examples).collect();
    let known = forms(examples, likeness);
    let copied = |level: &SurveyedLevel| known.contains(&likeness.digest(&level.level));
    let section = Section::new("novelty", "How new are the levels?", "")
        .share(
            "copies",
            "copies of the game's own levels, up to symmetry",
            Share::yes(levels.iter().map(copied)),
        )
        .share(
            "near_duplicates",
            format!("near-duplicates of the game's own levels: within {NEAR}"),
            near(&nearest),
        )
        .quantiles("nearest", "distance to the most similar of the game's own levels", &nearest)
        .quantiles(
            "among_examples",
            "for scale: among the game's own levels",
            &Distances::of(examples, likeness).known(),
        );
    (!examples.is_empty()).then_some(section)
}

fn forms(levels: &[SurveyedLevel], likeness: &LevelSimilarity) -> BTreeSet<Digest> {
    levels.iter().map(|level| likeness.digest(&level.level)).collect()
}

fn near(distances: &[f64]) -> Share {
    Share::yes(distances.iter().map(|distance| *distance <= NEAR))
}

fn least(distances: impl Iterator<Item = f64>) -> Option<f64> {
    distances.min_by(f64::total_cmp)
}
