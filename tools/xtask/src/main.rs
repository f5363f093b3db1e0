//! The development tasks of the repository, `cargo xtask <task>`.

#![allow(clippy::print_stdout, reason = "a task prints for its user")]

mod agreement;
mod bench;
mod boards_alike;
mod conformance;
mod episode_run;
mod fidelity;
mod instructions;
mod inventions;
mod judging;
mod kernels;
mod levels;
mod simulate;
mod solve;
mod survey;
mod sweep;

use clap::{Parser, Subcommand};

/// Development tasks of the repository.
#[derive(Parser)]
#[command(name = "xtask")]
struct Args {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    Agreement(agreement::Args),
    Bench(bench::Args),
    BoardsAlike(boards_alike::Args),
    Conformance(conformance::Args),
    Fidelity(fidelity::Args),
    Instructions(instructions::Args),
    Judging(judging::Args),
    Inventions(inventions::Args),
    Kernels(kernels::Args),
    Simulate(simulate::Args),
    SideBySide(survey::side_by_side::Args),
    Solve(solve::Args),
    Survey(survey::levels::Args),
    Sweep(sweep::Args),
}

fn main() -> anyhow::Result<()> {
    match Args::parse().task {
        Task::Agreement(args) => agreement::run(&args),
        Task::Bench(args) => bench::run(&args),
        Task::BoardsAlike(args) => boards_alike::run(&args),
        Task::Conformance(args) => conformance::run(&args),
        Task::Fidelity(args) => fidelity::run(&args),
        Task::Instructions(args) => instructions::run(&args),
        Task::Judging(args) => judging::run(&args),
        Task::Inventions(args) => inventions::run(&args),
        Task::Kernels(args) => kernels::run(&args),
        Task::Simulate(args) => simulate::run(&args),
        Task::SideBySide(args) => survey::side_by_side::run(&args),
        Task::Solve(args) => solve::run(&args),
        Task::Survey(args) => survey::levels::run(&args),
        Task::Sweep(args) => sweep::run(&args),
    }
}
