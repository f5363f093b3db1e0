//! Conversations that a player cannot answer.

/// The error for a conversation that a player cannot answer. The message states the missing information and
/// the next step.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unanswerable(pub String);
