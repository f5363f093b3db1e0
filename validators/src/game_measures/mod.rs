//! Measures and kinds of a game: the axes of archives of games, and lines of the report on their generators.

mod coupling;
mod families;
mod futures;
mod guards;
mod kinds;
mod play;
mod regret;

pub use coupling::Coupling;
pub use families::{ClassFamily, EffectFamily};
pub use futures::{FUTURES, SIGHT};
pub use guards::Guards;
pub use kinds::{AvatarKind, ChanceKind, GameKind, GoalKind};
pub use play::PlayMeasures;
pub(crate) use play::mechanics;
pub use regret::Regret;
