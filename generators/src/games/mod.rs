//! The texts of games, the kinds of games, and copies of games under different names.
//!
//! The games themselves are composed from hand-written designs ([`crate::kernels`]). The names in a rethemed game come
//! from a scene (a set of nouns and sentences) and fit the roles of the types (`casting.rs`). The names in a masked
//! game have no meaning.

pub(crate) mod blurb;
mod casting;
pub(crate) mod english;
mod kind;
mod lock;
mod masked;
pub(crate) mod palette;
mod push;
mod rethemed;
mod surface;
mod yard;

pub use kind::Kind;
pub use lock::LockRules;
pub use masked::Masked;
pub use push::PushRules;
pub use rethemed::Rethemed;
pub use yard::YardRules;

use engine::Game;

/// A game with its description in prose.
#[derive(Clone, Debug)]
pub struct GeneratedGame {
    /// The rules. Like the rules of frozen games, they were compiled without warnings from their printed text.
    pub rules: Game,
    /// The title, in the terms of the game's theme.
    pub title: String,
    /// A summary of the game in a few sentences.
    pub summary: String,
    /// The instructions for winning, in one sentence.
    pub goal: String,
    /// The kind of game.
    pub kind: Kind,
    /// `true` if sprites move even while the player does nothing.
    pub real_time: bool,
    /// The sources of the generated game, such as `kernel/one-spark`: the hand-written design, its variants, and the
    /// scene that supplies the nouns.
    pub patterns: Vec<String>,
}
