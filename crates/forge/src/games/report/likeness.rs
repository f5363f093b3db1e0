//! The distances between the rules of games in the set, and from these games to the corpus.

use super::entry::{Measured, Nearest};
use base::Digest;
use rayon::prelude::*;
use report::{Section, Share};
use std::collections::BTreeSet;
use validators::novelty::{GameForm, NEAR, distance};

/// The distances between each game and its neighbours.
pub(super) struct Distances {
    /// For each game, its nearest neighbour in the set and in the corpus.
    pub(super) each: Vec<[Option<Nearest>; 2]>,
    /// The distances between all pairs of games in the set.
    pairs: Vec<f64>,
}

impl Distances {
    pub(super) fn of(measured: &[Measured<'_>], names: &[&str], corpus: &[GameForm]) -> Distances {
        let near = |at: usize| {
            let others = || (0..measured.len()).filter(|&other| other != at);
            let of_set = measured[at].form.nearest(others().map(|other| &measured[other].form));
            let of_set = of_set.map(|(place, distance)| {
                let name =
                    &measured[others().nth(place).expect("the position is within the set")].surveyed.name;
                Nearest { name: name.clone(), distance }
            });
            let of_corpus = measured[at].form.nearest(corpus);
            [of_set, of_corpus.map(|(at, distance)| Nearest { name: names[at].to_owned(), distance })]
        };
        let to_later = |at: usize| -> Vec<f64> {
            measured[at + 1..].iter().map(|other| distance(&measured[at].form, &other.form)).collect()
        };
        let pairs: Vec<Vec<f64>> = (0..measured.len()).into_par_iter().map(to_later).collect();
        Distances { each: (0..measured.len()).into_par_iter().map(near).collect(), pairs: pairs.concat() }
    }
}

pub(super) fn novelty(measured: &[Measured<'_>], distances: &Distances, corpus: &[GameForm]) -> Section {
    let side = |side: usize| -> Vec<f64> {
        distances.each.iter().filter_map(|each| each[side].as_ref()).map(|near| near.distance).collect()
    };
    let (nearest, of_corpus) = (side(0), side(1));
    let near = |distances: &[f64]| Share::yes(distances.iter().map(|distance| *distance < NEAR));
    let forms: BTreeSet<Digest> = measured.iter().map(|game| game.form.digest()).collect();
    let among = |at: usize| {
        let others = corpus.iter().enumerate().filter(|(other, _)| *other != at);
        corpus[at].nearest(others.map(|(_, form)| form)).map(|(_, distance)| distance)
    };
    let among: Vec<f64> = (0..corpus.len()).filter_map(among).collect();
    let unique = Share::new(forms.len() as u64, measured.len() as u64);
    Section::new("novelty", "How new are the games?", "Distances range from 0 (the same rules) to 1.")
        .share("unique", "distinct games, ignoring names and the order of rules", unique)
        .share("near_duplicates", "near-duplicates in the set", near(&nearest))
        .share("near_corpus", "near-duplicates of the corpus", near(&of_corpus))
        .quantiles("nearest", "distance to the most similar other game", &nearest)
        .quantiles("pairs", "distance between any two games", &distances.pairs)
        .quantiles("nearest_corpus", "distance to the most similar corpus game", &of_corpus)
        .quantiles("among_corpus", "for scale: within the corpus", &among)
}
