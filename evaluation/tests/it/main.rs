//! Evaluations from prompts to tables, against scripted servers and players.

mod boards;
mod games;
mod misbehaving_servers;
mod prompts;
mod runs;
mod scores;
mod served;
mod server;
mod walk;
