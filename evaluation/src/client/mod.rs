//! Language models behind chat completions.

mod chat;

pub use chat::{
    ChatError, ChatErrorKind, ChatMessage, ChatReply, ChatRequest, Decoding, Failure, Finish, Model, Role,
    Usage,
};
