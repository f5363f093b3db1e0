//! The subcommands under "Evaluate players" in the help.

pub(crate) mod evaluate;
pub(crate) mod mailbox;
pub(crate) mod player_guard;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod serve_player;
pub(crate) mod study;
pub(crate) mod world_model;
