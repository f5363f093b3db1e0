//! Game generators: rules, mapping and theme.
//!
//! A game is composed of typed patterns: a way of moving, a goal, threats, obstacles and boons ([`ConstructiveGames`]). A
//! pattern (`pattern.rs`) adds sprite types and rules to a draft (`draft.rs`) and declares the features it gives, needs
//! and bars. The rules about obstacles follow from the bodies of the sprite types (`body.rs`); names come from a theme
//! (`theme.rs`, `themes/`). The draft becomes a syntax tree (`assemble.rs`): no text is concatenated.

mod assemble;
mod body;
mod boons;
mod casting;
mod changes;
mod composition;
mod constructive;
mod draft;
mod edit;
mod effect;
pub(crate) mod english;
mod genome;
mod goals;
mod grafts;
mod kind;
mod masked;
mod mechanics;
mod movement;
mod obstacles;
pub(crate) mod palette;
mod pattern;
mod rethemed;
mod role;
mod shrinking;
mod surface;
mod theme;
mod themes;
mod threats;
mod tree;
mod variation;
mod ways;

pub use constructive::{ConstructiveGames, GameConfig, GeneratedGame};
pub use genome::GameGenome;
pub use kind::Kind;
pub use masked::Masked;
pub use rethemed::Rethemed;
pub use variation::GameVariation;
