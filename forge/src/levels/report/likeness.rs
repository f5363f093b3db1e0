//! How alike levels are: to each other, and to the game's own.

use super::Judged;
use engine::Digest;
use generators::levels::LevelSimilarity;
use rayon::prelude::*;
use report::{Estimate, Quantiles, Share};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Levels at most this far apart are near-duplicates.
pub const NEAR: f64 = 0.05;

/// How different are they from each other?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Diversity {
    /// Different levels, of all: a level and its mirror image are one.
    pub unique: Share,
    /// Distance of two of them: for each level the mean distance to the others, in the mean over levels; none for fewer than
    /// two.
    pub distance: Option<Estimate>,
    /// Distance of each level to the one that is most like it.
    pub nearest: Option<Quantiles>,
    /// Levels with another one at a distance of at most [`NEAR`].
    pub near_duplicates: Share,
}

impl Diversity {
    /// Also the distance of each level to its nearest neighbour.
    pub(super) fn of(levels: &[Judged], likeness: &LevelSimilarity) -> (Diversity, Vec<Option<f64>>) {
        let row = |at: usize| -> Vec<f64> {
            let others = levels.iter().enumerate().filter(|(other, _)| *other != at);
            others.map(|(_, other)| likeness.distance(&levels[at].level, &other.level)).collect()
        };
        let rows: Vec<Vec<f64>> = (0..levels.len()).into_par_iter().map(row).collect();
        let compared = || rows.iter().filter(|row| !row.is_empty());
        let means: Vec<f64> = compared().map(|row| row.iter().sum::<f64>() / row.len() as f64).collect();
        let nearest: Vec<Option<f64>> = rows.iter().map(|row| least(row)).collect();
        let known: Vec<f64> = nearest.iter().flatten().copied().collect();
        let forms: BTreeSet<Digest> = levels.iter().map(|judged| likeness.digest(&judged.level)).collect();
        let diversity = Diversity {
            unique: Share::new(forms.len() as u64, levels.len() as u64),
            distance: Estimate::of(&means),
            nearest: Quantiles::of(&known),
            near_duplicates: Share::yes(known.iter().map(|distance| *distance <= NEAR)),
        };
        (diversity, nearest)
    }
}

/// How different are they from the game's own levels?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Novelty {
    /// Distance of each level to the most similar one of the game's own.
    pub nearest: Option<Quantiles>,
    /// Levels with one of them at a distance of at most [`NEAR`].
    pub near_duplicates: Share,
    /// Levels that are one of them, or its mirror image.
    pub copies: Share,
    /// For scale: distance of each of the game's own levels to the most similar other one.
    pub among_examples: Option<Quantiles>,
}

impl Novelty {
    pub(super) fn of(levels: &[Judged], examples: &[Judged], likeness: &LevelSimilarity) -> Option<Novelty> {
        if examples.is_empty() {
            return None;
        }
        let to_examples = |judged: &Judged| {
            let to = |example: &Judged| likeness.distance(&judged.level, &example.level);
            least(&examples.iter().map(to).collect::<Vec<f64>>())
        };
        let nearest: Vec<f64> =
            levels.par_iter().map(to_examples).collect::<Vec<Option<f64>>>().into_iter().flatten().collect();
        let forms: BTreeSet<Digest> =
            examples.iter().map(|example| likeness.digest(&example.level)).collect();
        let copied = |judged: &Judged| forms.contains(&likeness.digest(&judged.level));
        Some(Novelty {
            nearest: Quantiles::of(&nearest),
            near_duplicates: Share::yes(nearest.iter().map(|distance| *distance <= NEAR)),
            copies: Share::yes(levels.iter().map(copied)),
            among_examples: Diversity::of(examples, likeness).0.nearest,
        })
    }
}

fn least(distances: &[f64]) -> Option<f64> {
    distances.iter().copied().min_by(f64::total_cmp)
}
