//! How far apart two games are by their rules, whatever they are called and in whichever order they are written
//! ([what was measured](../../../docs/novelty.md)).

mod colours;
mod graph;
mod kernel;
mod labelling;

use engine::{Digest, Game};
use graph::RuleGraph;
use kernel::Features;

/// The rules of a game without names, symbols, colours and order: two games are the same game in another dress if their
/// forms have the same [`digest`](GameForm::digest).
///
/// Of a game's text these do not count: the names of sprite types and what they look like; which characters levels are
/// written in (but which types are placed together does); the order of lines, and of partners on a line; whether a
/// parameter is inherited, written, or written though it is the default; types of which there are no sprites, where they
/// only stand above others, have no class of their own; lines that are not enabled; `wall` and `avatar`, if neither the
/// file declares them nor a rule names them. Games whose rules run in another order can play differently and yet share
/// a form: they are one game to whoever counts games.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GameForm {
    digest: Digest,
    features: Features,
}

/// Games that are nearer to each other than this are duplicates: the same rules with other numbers or in another fiction.
pub const NEAR: f64 = 0.3;

impl GameForm {
    /// The form of a game. Cost: some milliseconds, no forward-model calls.
    pub fn of(game: &Game) -> GameForm {
        let graph = RuleGraph::of(game);
        let digest = Digest::of(labelling::canonical(&graph).as_bytes());
        GameForm { digest, features: Features::of(&graph) }
    }

    /// Equal for games that are the same but for what does not count. Different rules never share one. The converse holds
    /// but for games in which many types look alike that are not: see the source of `labelling`.
    pub fn digest(&self) -> Digest {
        self.digest
    }

    /// The index and the distance of the nearest of some forms; the first of several. Cost: O(rules) each.
    pub fn nearest<'a>(&self, forms: impl IntoIterator<Item = &'a GameForm>) -> Option<(usize, f64)> {
        let apart = forms.into_iter().map(|form| distance(self, form)).enumerate();
        apart.reduce(|best, next| if next.1 < best.1 { next } else { best })
    }

    /// Whether the two are duplicates: nearer than [`NEAR`].
    pub fn is_near(&self, other: &GameForm) -> bool {
        distance(self, other) < NEAR
    }
}

/// How far apart the rules of two games are, from 0 (equal forms) to 1 (nothing in common). Symmetric, and the triangle
/// inequality holds. Cost: O(rules).
pub fn distance(one: &GameForm, two: &GameForm) -> f64 {
    one.features.distance(&two.features)
}
