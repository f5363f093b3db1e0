//! Language models behind chat-completion APIs.
//!
//! [`connect()`] creates a [`Model`] from the user's options. The model is a client for servers with the
//! OpenAI, Anthropic or Gemini API. The client retries after transient failures, respects caps, rates and a
//! limit on concurrent requests, and caches answers if caching is enabled. `docs/reference/models.md`
//! describes how each kind of failure is counted.

mod cache;
mod chat;
mod clock;
mod connect;
mod fault;
mod http;
mod key;
mod options;
mod pace;
mod provider;
mod remote;
mod spec;
mod spending;

pub use chat::{
    ChatError, ChatErrorKind, ChatMessage, ChatReply, ChatRequest, Decoding, Failure, Finish, Model, Role,
    Usage,
};
pub use clock::{Clock, SystemClock};
pub use connect::{Connection, ModelSettings, connect, connect_with, price, settings};
pub use options::{ModelOptions, OnFailure};
pub(crate) use provider::Content;
pub use provider::Provider;
pub use spec::{ModelSpec, Server};
pub use spending::caps::{Caps, Limits, Spent};
pub use spending::estimate::{Batch, Estimate};
pub use spending::prices::{Price, Prices, Usd};
