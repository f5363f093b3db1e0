//! Tests of requests to the server from its page, from other pages and from other programs.

mod client;
mod games;
mod judged;
mod security;
mod shown;
mod verdicts;
