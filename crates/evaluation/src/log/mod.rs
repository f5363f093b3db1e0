//! The log of an episode, with one event per line, appended as the event happens.

mod event;
mod journal;

pub use event::{Event, Reply, ReplyClass, SCHEMA, Status, decisions, without_times};
pub(crate) use journal::NEXT_STEP;
pub use journal::{Journal, read};
