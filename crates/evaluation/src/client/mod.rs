//! Language models behind chat-completion APIs.
//!
//! [`connect()`] creates a [`Model`] from the user's options. The model is a client for a server with the API
//! of OpenAI, Anthropic or Gemini. The client retries after transient failures, respects caps, rates and a
//! limit on concurrent requests, and caches answers if the user enables the cache. `docs/reference/models.md`
//! describes how each kind of failure is counted.

mod cache;
mod caps;
mod chat;
mod clock;
mod connect;
mod estimate;
mod fault;
mod key;
mod pace;
mod prices;
mod provider;
mod remote;
mod spec;
mod wire;

pub use caps::{Caps, Limits, Spent};
pub use chat::{
    ChatError, ChatErrorKind, ChatMessage, ChatReply, ChatRequest, Decoding, Failure, Finish, Model, Role,
    Usage,
};
pub use clock::{Clock, SystemClock};
pub use connect::{Connection, ModelOptions, ModelSettings, connect, connect_with, price, settings};
pub use estimate::{Batch, Estimate};
pub use prices::{Price, Prices, Usd};
pub(crate) use provider::Content;
pub use provider::Provider;
pub use spec::{ModelSpec, Server};
