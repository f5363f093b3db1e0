//! How far apart the games are by their rules: from each other, and from the corpus.

use super::entry::{Judged, Nearest};
use engine::Digest;
use rayon::prelude::*;
use report::{Quantiles, Share};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use validators::novelty::{GameForm, distance};

/// The distances of each game to its neighbours.
pub struct Distances {
    /// By game: its nearest neighbour in the set, and in the corpus.
    pub(super) each: Vec<[Option<Nearest>; 2]>,
    /// Of all pairs of the set.
    pub(super) pairs: Vec<f64>,
}

impl Distances {
    pub(super) fn of(judged: &[Judged<'_>], names: &[&str], corpus: &[GameForm]) -> Distances {
        let titles: Vec<&str> = judged.iter().map(|judged| judged.reported.title.as_str()).collect();
        let near = |at: usize| {
            let others = || (0..judged.len()).filter(|&other| other != at);
            let of_set = judged[at].form.nearest(others().map(|other| &judged[other].form));
            let of_set = of_set.map(|(place, distance)| {
                let name = titles[others().nth(place).expect("one of them")].to_owned();
                Nearest { name, distance }
            });
            let of_corpus = judged[at].form.nearest(corpus);
            [of_set, of_corpus.map(|(at, distance)| Nearest { name: names[at].to_owned(), distance })]
        };
        let to_later = |at: usize| -> Vec<f64> {
            judged[at + 1..].iter().map(|other| distance(&judged[at].form, &other.form)).collect()
        };
        let pairs: Vec<Vec<f64>> = (0..judged.len()).into_par_iter().map(to_later).collect();
        Distances { each: (0..judged.len()).into_par_iter().map(near).collect(), pairs: pairs.concat() }
    }
}

/// How new are they?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Novelty {
    /// Different games, of all: names, symbols and the order of rules do not count.
    pub unique: Share,
    /// Games with another one of the set nearer than [`validators::novelty::NEAR`].
    pub near_duplicates: Share,
    /// Distance of each game to the one of the set that is most like it.
    pub nearest: Option<Quantiles>,
    /// Distances of all pairs of the set.
    pub pairs: Option<Quantiles>,
    /// Games with one of the corpus nearer than [`validators::novelty::NEAR`].
    pub near_corpus: Share,
    /// Distance of each game to the one of the corpus that is most like it.
    pub nearest_corpus: Option<Quantiles>,
    /// For scale: distance of each game of the corpus to the most similar other one.
    pub among_corpus: Option<Quantiles>,
}

impl Novelty {
    pub(super) fn of(judged: &[Judged<'_>], distances: &Distances, corpus: &[GameForm]) -> Novelty {
        let side = |side: usize| -> Vec<f64> {
            distances.each.iter().filter_map(|each| each[side].as_ref()).map(|near| near.distance).collect()
        };
        let (nearest, of_corpus) = (side(0), side(1));
        let near = |distances: &[f64]| {
            Share::yes(distances.iter().map(|distance| *distance < validators::novelty::NEAR))
        };
        let forms: BTreeSet<Digest> = judged.iter().map(|judged| judged.form.digest()).collect();
        let among = |at: usize| {
            let others = corpus.iter().enumerate().filter(|(other, _)| *other != at);
            corpus[at].nearest(others.map(|(_, form)| form)).map(|(_, distance)| distance)
        };
        let among: Vec<f64> = (0..corpus.len()).filter_map(among).collect();
        Novelty {
            unique: Share::new(forms.len() as u64, judged.len() as u64),
            near_duplicates: near(&nearest),
            nearest: Quantiles::of(&nearest),
            pairs: Quantiles::of(&distances.pairs),
            near_corpus: near(&of_corpus),
            nearest_corpus: Quantiles::of(&of_corpus),
            among_corpus: Quantiles::of(&among),
        }
    }
}
