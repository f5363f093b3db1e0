//! The verbs, one file each: flags, behaviour and output.

pub(crate) mod calibrate;
pub(crate) mod clean;
pub(crate) mod completions;
pub(crate) mod conformance;
pub(crate) mod describe;
pub(crate) mod diff;
pub(crate) mod docs;
pub(crate) mod evaluate;
pub(crate) mod export;
pub(crate) mod fmt;
pub(crate) mod generate;
pub(crate) mod mailbox;
pub(crate) mod man;
pub(crate) mod merge;
pub(crate) mod play;
pub(crate) mod player_guard;
pub(crate) mod recipes;
pub(crate) mod regenerate;
pub(crate) mod release;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod scale;
pub(crate) mod serve_player;
pub(crate) mod validate;
pub(crate) mod verify;
