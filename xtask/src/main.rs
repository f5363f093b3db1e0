//! Chores of the repository, `cargo xtask <chore>`.

#![allow(clippy::print_stdout, reason = "a chore talks to whoever runs it")]

mod bench;
mod course;
mod fidelity;
mod instructions;
mod levels;
mod side_by_side;
mod solve;
mod survey;

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
    Fidelity(fidelity::Args),
    Instructions(instructions::Args),
    SideBySide(side_by_side::Args),
    Solve(solve::Args),
    Survey(survey::Args),
}

fn main() -> anyhow::Result<()> {
    match Args::parse().chore {
        Chore::Bench(args) => bench::run(&args),
        Chore::Fidelity(args) => fidelity::run(&args),
        Chore::Instructions(args) => instructions::run(&args),
        Chore::SideBySide(args) => side_by_side::run(&args),
        Chore::Solve(args) => solve::run(&args),
        Chore::Survey(args) => survey::run(&args),
    }
}
