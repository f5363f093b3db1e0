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

use crate::GenerateError;
use crate::kernels::has_movers;
use engine::{Analysis, Game, syntax};
use english::{capital, headline, one};

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

impl GeneratedGame {
    /// Describes a finished game under its own names. The summary and the goal follow from the rules, and the title
    /// from the name of the game's folder. The comments are removed, because they might reveal a solution.
    ///
    /// # Errors
    /// Returns an error if the rules do not compile without their comments.
    pub fn finished(
        game: &Game,
        folder: &str,
        patterns: Vec<String>,
    ) -> Result<GeneratedGame, GenerateError> {
        let bare = surface::without_comments(game.description().clone());
        let rules = Game::from_source(&syntax::print(&bare)).map_err(|problems| {
            GenerateError::Unsuitable(format!("it does not compile without comments: {problems}"))
        })?;
        let analysis = Analysis::of(&rules);
        let kind = Kind::of(&analysis);
        Ok(GeneratedGame {
            title: headline(&folder.replace('-', " ")),
            summary: format!("{}.", capital(&one(&blurb::hero(&analysis)))),
            goal: blurb::goal(&analysis),
            real_time: has_movers(rules.description()),
            kind,
            patterns,
            rules,
        })
    }
}
