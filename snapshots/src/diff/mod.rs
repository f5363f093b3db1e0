//! Two releases side by side: what is new, kept, changed and gone, how their distributions differ, how far apart their games
//! are ([what each figure means](../../../docs/diff.md)).

mod items;
mod neighbours;
mod shifts;

pub use items::{Change, Changes, Status};
pub use neighbours::{Neighbours, Pair};
pub use shifts::{DEALS, NumberShift, Share, Shift};

use crate::card::Origin;
use crate::released::{Released, ReleasedGame};
use crate::rungs::{RungDifference, differences};
use engine::{Analysis, Digest};
use rayon::prelude::*;
use serde::Serialize;
use validators::{GameForm, GameKind};

/// A release in a line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Side {
    /// Its name.
    pub name: String,
    /// Its root digest.
    pub root: Digest,
    /// Games.
    pub games: usize,
    /// Those of them that a rule generator made.
    pub generated: usize,
    /// Levels.
    pub levels: usize,
    /// The engine's semantics that it was minted under.
    pub semantics: u32,
    /// The generators' version that it was minted under.
    pub generation: u32,
}

/// Two releases compared: the earlier and the later.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diff {
    /// The earlier one.
    pub before: Side,
    /// The later one.
    pub after: Side,
    /// Games by their rules.
    pub games: Changes,
    /// Items: levels with the rules of their games.
    pub items: Changes,
    /// Distributions of what there is one or more of for each game or level.
    pub shifts: Vec<Shift>,
    /// Distributions of numbers.
    pub numbers: Vec<NumberShift>,
    /// How each player of the ladders fares: later less earlier.
    pub rungs: Vec<RungDifference>,
    /// How near the later games are to the earlier ones.
    pub neighbours: Neighbours,
}

/// A game with what is compared of it.
struct Compared<'a> {
    released: &'a ReleasedGame,
    form: GameForm,
    kind: GameKind,
    /// By level: the same for levels that are the same up to names, characters and symmetry.
    levels: Vec<Digest>,
}

impl<'a> Compared<'a> {
    fn of(released: &'a ReleasedGame) -> Compared<'a> {
        Compared {
            form: GameForm::of(&released.game),
            kind: GameKind::of(&Analysis::of(&released.game)),
            levels: items::level_forms(released),
            released,
        }
    }

    fn is_generated(&self) -> bool {
        matches!(self.released.card.origin, Origin::Generated { .. })
    }
}

impl Diff {
    /// Compares two releases; the `closest` nearest pairs of games are listed. Cost: an analysis of each game, its distance to
    /// all others, and some thousand resamples of the games for each figure; seconds for hundreds of games.
    pub fn of(before: &Released, after: &Released, closest: usize) -> Diff {
        let [old, new] =
            [before, after].map(|side| side.games.par_iter().map(Compared::of).collect::<Vec<_>>());
        let cards = |side: &Released| side.games.iter().map(|game| game.card.clone()).collect::<Vec<_>>();
        Diff {
            before: side(before, &old),
            after: side(after, &new),
            games: items::games(&old, &new),
            items: items::items(&old, &new),
            shifts: shifts::shifts(&old, &new),
            numbers: shifts::numbers(&old, &new),
            rungs: differences(&cards(after), &cards(before)),
            neighbours: Neighbours::of(&old, &new, closest),
        }
    }
}

fn side(released: &Released, games: &[Compared<'_>]) -> Side {
    let Released { manifest, .. } = released;
    Side {
        name: manifest.name.clone(),
        root: manifest.root,
        games: games.len(),
        generated: games.iter().filter(|game| game.is_generated()).count(),
        levels: released.levels(),
        semantics: manifest.semantics,
        generation: manifest.generation,
    }
}

#[cfg(test)]
mod tests;
