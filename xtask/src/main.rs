//! Chores of the repository, `cargo xtask <chore>`.

#![allow(clippy::print_stdout, reason = "a task prints for its user")]

mod bench;
mod course;
#[cfg(feature = "content")]
mod fidelity;
mod instructions;
mod levels;
mod solve;
#[cfg(feature = "content")]
mod survey;
mod sweep;

use clap::{Parser, Subcommand};

/// Development tasks of the repository.
#[derive(Parser)]
#[command(name = "xtask")]
struct Args {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    Bench(bench::Args),
    #[cfg(feature = "content")]
    Fidelity(fidelity::Args),
    Instructions(instructions::Args),
    #[cfg(feature = "content")]
    SideBySide(survey::side_by_side::Args),
    Solve(solve::Args),
    #[cfg(feature = "content")]
    Survey(survey::levels::Args),
    Sweep(sweep::Args),
}

fn main() -> anyhow::Result<()> {
    match Args::parse().chore {
        Chore::Bench(args) => bench::run(&args),
        #[cfg(feature = "content")]
        Chore::Fidelity(args) => fidelity::run(&args),
        Chore::Instructions(args) => instructions::run(&args),
        #[cfg(feature = "content")]
        Chore::SideBySide(args) => survey::side_by_side::run(&args),
        Chore::Solve(args) => solve::run(&args),
        #[cfg(feature = "content")]
        Chore::Survey(args) => survey::levels::run(&args),
        Chore::Sweep(args) => sweep::run(&args),
    }
}
