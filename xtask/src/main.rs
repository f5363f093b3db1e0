//! Chores of the repository, `cargo xtask <chore>`.

#![allow(clippy::print_stdout, reason = "a chore talks to whoever runs it")]

mod bench;

use clap::{Parser, Subcommand};

/// Chores of the repository.
#[derive(Parser)]
#[command(name = "xtask")]
struct Args {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    Bench(bench::Args),
}

fn main() -> anyhow::Result<()> {
    match Args::parse().chore {
        Chore::Bench(args) => bench::run(&args),
    }
}
