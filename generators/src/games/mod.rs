//! Game generators: rules, mapping and fiction.
//!
//! A game is composed of typed patterns: a way of moving, a goal, threats, obstacles and boons ([`ConstructiveGames`]). A
//! pattern (`pattern.rs`) adds sprite types and rules to a draft (`draft.rs`) and says what it brings, needs and rules
//! out. What stops whom follows from the bodies of the sprite types (`body.rs`); what they are called from a fiction
//! (`theme.rs`, `themes/`). The draft is laid out as a syntax tree (`assemble.rs`): no text is pasted together.

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
mod english;
mod genome;
mod goals;
mod grafts;
mod kind;
mod masked;
mod mechanics;
mod movement;
mod naming;
mod obstacles;
mod palette;
mod pattern;
mod retold;
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
pub use retold::Retold;
pub use variation::GameVariation;
