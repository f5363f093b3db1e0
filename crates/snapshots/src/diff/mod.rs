//! A comparison of two releases: new, kept, changed and removed games, differences in distributions, and
//! distances between games ([the meaning of each figure](../../../../docs/how-to/diff.md)).

mod items;
mod neighbours;
mod shifts;
mod verdict;

pub use items::{Change, Changes, Status};
pub use neighbours::{Neighbours, Pair};
pub use shifts::{DEALS, NumberShift, Share, Shift, Unmeasured};
pub use verdict::Order;

use crate::card::rungs::{RungDifference, differences};
use crate::released::{Released, ReleasedGame};
use crate::sections::marks::{MarkDifference, mark_differences};
use base::Digest;
use engine::Analysis;
use forge::card::Origin;
use rayon::prelude::*;
use serde::Serialize;
use validators::{GameForm, GameKind};

/// A summary of a release.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Side {
    /// The release's name.
    pub name: String,
    /// The release's root digest.
    pub root: Digest,
    /// The root digest of the previous release; `None` for the first release in its chain.
    pub parent: Option<Digest>,
    /// The number of games.
    pub games: usize,
    /// The number of games created by a rule generator.
    pub generated: usize,
    /// The number of levels.
    pub levels: usize,
    /// The version of the engine semantics under which the release was minted.
    pub semantics: u32,
    /// The generation of the generators that minted the release.
    pub generation: u32,
}

/// The comparison of an earlier and a later release.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diff {
    /// The comparison in one sentence, covering difficulty, returning levels and nearest games.
    pub verdict: String,
    /// The order of the two releases, according to the parents and ancestors that they state.
    pub order: Order,
    /// The earlier release.
    pub before: Side,
    /// The later release.
    pub after: Side,
    /// The changes in the games, compared by rules.
    pub games: Changes,
    /// The changes in the items. An item is a level with its game's rules.
    pub items: Changes,
    /// The changes in the distributions of labels. Each game or level has one or more labels.
    pub shifts: Vec<Shift>,
    /// The changes in the distributions of numbers.
    pub numbers: Vec<NumberShift>,
    /// The change in the results of each reference player on the ladder: later minus earlier.
    pub rungs: Vec<RungDifference>,
    /// The change in each reference result that both releases contain; empty if the recipes request no
    /// reference results.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<MarkDifference>,
    /// The distances from the later games to the earlier games.
    pub neighbours: Neighbours,
}

/// A game, with the data needed for the comparison.
struct Compared<'a> {
    released: &'a ReleasedGame,
    form: GameForm,
    kind: GameKind,
    /// One digest per level. Levels that differ only in names, characters and board symmetry have the same digest.
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
    /// Compares two releases, and lists the nearest `closest` pairs of games.
    ///
    /// Cost: an analysis of each game, its distance to all others, and about a thousand resamples of the games for
    /// each figure. A comparison of releases with hundreds of games takes seconds.
    pub fn of(before: &Released, after: &Released, closest: usize) -> Diff {
        let [old, new] =
            [before, after].map(|side| side.games.par_iter().map(Compared::of).collect::<Vec<_>>());
        let cards = |side: &Released| side.games.iter().map(|game| game.card.clone()).collect::<Vec<_>>();
        let mut diff = Diff {
            verdict: String::new(),
            order: Order::of(&before.manifest, &after.manifest),
            before: side(before, &old),
            after: side(after, &new),
            games: items::games(&old, &new),
            items: items::items(&old, &new),
            shifts: shifts::shifts(&old, &new),
            numbers: shifts::numbers(&old, &new),
            rungs: differences(&cards(after), &cards(before)),
            marks: marks(before, after),
            neighbours: Neighbours::of(&old, &new, closest),
        };
        diff.verdict = verdict::verdict(&diff);
        diff
    }
}

fn marks(before: &Released, after: &Released) -> Vec<MarkDifference> {
    let both = after.marks.as_ref().zip(before.marks.as_ref());
    both.map_or_else(Vec::new, |(after, before)| mark_differences(after, before))
}

fn side(released: &Released, games: &[Compared<'_>]) -> Side {
    let Released { manifest, .. } = released;
    Side {
        name: manifest.name.clone(),
        root: manifest.root,
        parent: manifest.parent,
        games: games.len(),
        generated: games.iter().filter(|game| game.is_generated()).count(),
        levels: released.levels(),
        semantics: manifest.semantics,
        generation: manifest.generation,
    }
}

#[cfg(test)]
mod tests;
