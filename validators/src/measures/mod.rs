//! Measures of games, levels and play, for archive axes and report lines.

pub(crate) mod comparison;
pub(crate) mod demand;
mod families;
mod futures;
mod guards;
mod kinds;
pub(crate) mod ladder;
pub(crate) mod level;
mod play;
mod rule_ref;

pub use demand::{Commitment, DeadEnds, Deception, Demand, TIERS, Tier, TierBounds, shorter_win};
pub use families::{ClassFamily, EffectFamily};
pub use futures::{FUTURES, SIGHT};
pub use guards::Guards;
pub use kinds::{AvatarKind, ChanceKind, GameKind, GoalKind};
pub use ladder::{Difficulty, Ladder, LadderConfig, PlayerResult, Rate, UnknownDifficulty};
pub(crate) use level::{EDGE, Mean, actions, pushes_of};
pub use level::{FORESIGHT, Measures, SkillGap, is_guard, mcts_rate, used_rules};
pub use play::PlayMeasures;
pub(crate) use play::mechanics;
pub use rule_ref::{RuleRef, RuleRefError};
