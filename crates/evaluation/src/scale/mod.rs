//! Scales for difficulty and ability across releases
//! ([docs/explanation/scale.md](../../../../docs/explanation/scale.md)). The modules read and write the file
//! `scale.json`, and collect the episodes used to estimate a scale.

mod choice;
mod file;
mod person;
mod played;
mod timeline;

pub use choice::{AdaptiveChoice, AdaptiveStep, Plan, PlannedErrors, ScaledLevels, Target};
pub use file::{Estimate, ExamineeEntry, GameEntry, LevelEntry, MonthEntry, SCALE_FORMAT, ScaleFile, Span};
pub use person::{ErrorParts, MonthAbility, PersonAbility, Refusal, abilities};
pub use played::{PersonPlays, played};
pub use timeline::{Change, Timeline, TimelineMonth, TimelinePlayer};
