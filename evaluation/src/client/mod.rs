//! Language models behind chat completions.
//!
//! [`connect()`] makes a [`Model`] of what a user asks for: a server that speaks the protocol of OpenAI, Anthropic or
//! Gemini. It waits and tries again where that may help, keeps within caps, rates and a number of requests at once, and
//! remembers answers if it is asked to. `docs/models.md` tells how each kind of failure is counted.

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
pub use provider::Provider;
pub use spec::{ModelSpec, Server};
