//! The server as its page, other pages and other programs meet it.

mod client;
mod games;
mod judged;
mod security;
mod shown;
mod verdicts;
