//! Tests of the `arcade` binary, run the way users run it.

mod altered_rows;
mod arcade;
mod begin;
mod contamination;
mod design;
mod evaluate;
#[cfg(feature = "parquet")]
mod export;
mod generate;
mod generate_games;
mod layout;
mod log;
mod lsp;
mod mailbox;
mod marks;
mod pictures;
mod regenerate;
mod release;
mod report;
mod scale;
mod sealed;
mod served;
#[path = "../../../evaluation/tests/it/server.rs"]
mod server;
mod shards;
mod stream;
mod studio;
mod tracks;
mod trust;
mod usage;
mod validate;
mod well;
mod world_model;
