//! An episode's log, with one event per line. Each event is appended when it happens.

mod event;
mod journal;

pub use event::{Event, Reply, ReplyClass, SCHEMA, Status, decisions, without_times};
pub(crate) use journal::NEXT_STEP;
pub use journal::{Journal, read};
