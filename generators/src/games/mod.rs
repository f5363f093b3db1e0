//! Games as text: kinds, nouns in English, and twins under other names.
//!
//! Games themselves are composed of kernels ([`crate::kernels`]). A rethemed game has names by the use of its types
//! (`casting.rs`) from a scene ([`crate::kernels`]); a masked one has names that say nothing.

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
    /// The rules, compiled from their printed text as those of frozen games are, without warnings.
    pub rules: Game,
    /// The title, in the terms of the game's own scene.
    pub title: String,
    /// The contents of the game, in a few sentences.
    pub summary: String,
    /// The instructions for winning, in one sentence.
    pub goal: String,
    /// The kind of game.
    pub kind: Kind,
    /// `true` if something moves even when the player does not act.
    pub real_time: bool,
    /// The kernel, its variants, the grafts and the scene.
    pub patterns: Vec<String>,
}
