//! One scale of difficulty and ability over releases ([docs/explanation/scale.md](../../../../docs/explanation/scale.md)): the examinees, the
//! file `scale.json`, and the results that it is made from.

mod choice;
mod examinees;
mod file;
mod person;
mod played;
mod timeline;

pub use choice::{AdaptiveChoice, AdaptiveStep, Plan, PlannedErrors, ScaledLevels, Target};
pub use examinees::{EXAMINEES, Examinee, examinee_named};
pub use file::{Estimate, ExamineeEntry, GameEntry, LevelEntry, MonthEntry, SCALE_FORMAT, ScaleFile, Span};
pub use person::{ErrorParts, MonthAbility, PersonAbility, Refusal, abilities};
pub use played::{PersonPlays, played};
pub use timeline::{Change, Timeline, TimelineMonth, TimelinePlayer};
