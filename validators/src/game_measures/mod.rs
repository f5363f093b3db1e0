//! What a game is like, in numbers and kinds: the axes of archives of games, and lines of the report on their generators.

mod families;

pub use families::{ClassFamily, EffectFamily};
