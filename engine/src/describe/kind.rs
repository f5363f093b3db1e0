//! A description of the kind of game.

use super::words::list;
use crate::analysis::{Spatiality, Taxonomy, Time};

/// Returns one sentence for each part of a taxonomy.
pub(super) fn kind(taxonomy: &Taxonomy) -> Vec<String> {
    let time = match taxonomy.time {
        Time::TurnBased => "Turn-based: nothing happens unless you act.",
        Time::RealTime => "Real-time: things happen while you do nothing.",
    };
    let space = match taxonomy.spatiality {
        Spatiality::Fixed => "Space: you stay where you are.",
        Spatiality::Line => "Space: you move along a line.",
        Spatiality::Grid => "Space: you move on a grid.",
        Spatiality::Continuous => "Space: you drift with a velocity.",
        Spatiality::Gravity => "Space: you fall, and the keys change your velocity.",
    };
    let genres: Vec<&str> = taxonomy.genres.iter().map(|genre| genre.name()).collect();
    let genre = match genres[..] {
        [] => "Genre: none of the known ones.".to_owned(),
        _ => format!("Genre: {}.", list(&genres, "and")),
    };
    let chance = if taxonomy.chance { "Chance plays a part." } else { "Chance plays no part." };
    let hidden = if taxonomy.hidden {
        "Not everything that matters is shown."
    } else {
        "Everything that matters is shown."
    };
    vec![genre, time.to_owned(), space.to_owned(), chance.to_owned(), hidden.to_owned()]
}
