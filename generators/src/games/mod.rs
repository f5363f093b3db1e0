//! Games as text: their kinds, English nouns, and twins with different names.
//!
//! Games themselves are composed from kernels ([`crate::kernels`]). A rethemed game takes its names from a scene,
//! according to its types' roles (`casting.rs`). A masked game's names have no meaning.

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
    /// The rules. The rules are compiled without warnings from their printed text, like the rules of frozen games.
    pub rules: Game,
    /// The title, in the terms of the game's scene.
    pub title: String,
    /// A summary of the game in a few sentences.
    pub summary: String,
    /// The instructions for winning, in one sentence.
    pub goal: String,
    /// The kind of game.
    pub kind: Kind,
    /// `true` if sprites move even while the player does nothing.
    pub real_time: bool,
    /// The kernel, its variants and the scene.
    pub patterns: Vec<String>,
}
