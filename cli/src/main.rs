//! The `arcade` binary: one file per verb, everything else in the library crates.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "comments on arguments are the words of the help, brackets and all"
)]

#[macro_use]
mod failure;

mod conformance;
mod console;
mod counted;
mod diagnostics;
mod embedded;
mod episodes;
mod evaluation_report;
mod input;
mod interrupt;
mod manual;
mod page;
mod paths;
mod play;
mod protected;
mod set_report;
mod shell;
mod threads;
mod usage;
mod verbs;
mod version;
mod whole_file;

use clap::{Parser, Subcommand};
use console::Console;
use failure::Answer;
use std::ffi::OsString;
use std::process::ExitCode;

/// Mints verified benchmarks of new arcade games, and checks them.
///
/// Exit status: 0 yes or done; 1 the answer is no; 2 the question is malformed; 3 environment failure (I/O, network, disk full).
#[derive(Parser)]
#[command(name = "arcade", version = version::version(), propagate_version = true, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
    /// One JSON document on standard output, nothing else there
    #[arg(long, global = true)]
    json: bool,
    /// No progress, no remarks
    #[arg(short, long, global = true)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Verb {
    Release(verbs::release::Args),
    Merge(verbs::merge::Args),
    Regenerate(verbs::regenerate::Args),
    Verify(verbs::verify::Args),
    Validate(verbs::validate::Args),
    Generate(verbs::generate::Args),
    Run(verbs::run::Args),
    Evaluate(Box<verbs::evaluate::Args>),
    ServePlayer(verbs::serve_player::Args),
    #[command(hide = true)]
    PlayerGuard(verbs::player_guard::Args),
    Report(verbs::report::Args),
    Diff(verbs::diff::Args),
    Export(verbs::export::Args),
    Play(verbs::play::Args),
    Render(verbs::render::Args),
    Describe(verbs::describe::Args),
    Fmt(verbs::fmt::Args),
    Conformance(verbs::conformance::Args),
    Clean(verbs::clean::Args),
    Recipes(verbs::recipes::Args),
    Docs(verbs::docs::Args),
    Completions(verbs::completions::Args),
    Man(verbs::man::Args),
}

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let cli = match usage::parse(&arguments) {
        Ok(cli) => cli,
        Err(status) => return ExitCode::from(status),
    };
    let console = Console::new(cli.json, cli.quiet);
    ExitCode::from(console.finish(answer(cli.verb, &console)))
}

fn answer(verb: Verb, console: &Console) -> Answer {
    if let Verb::PlayerGuard(args) = &verb {
        verbs::player_guard::run(args) // without a pool of threads
    }
    threads::start()?;
    match verb {
        Verb::Release(args) => verbs::release::run(&args, console),
        Verb::Merge(args) => verbs::merge::run(&args, console),
        Verb::Regenerate(args) => verbs::regenerate::run(&args, console),
        Verb::Verify(args) => verbs::verify::run(&args, console),
        Verb::Validate(args) => verbs::validate::run(&args, console),
        Verb::Generate(args) => verbs::generate::run(&args, console),
        Verb::Run(args) => verbs::run::run(&args, console),
        Verb::Evaluate(args) => verbs::evaluate::run(&args, console),
        Verb::ServePlayer(args) => verbs::serve_player::run(&args, console),
        Verb::PlayerGuard(_) => unreachable!("it has run above"),
        Verb::Report(args) => verbs::report::run(&args, console),
        Verb::Diff(args) => verbs::diff::run(&args, console),
        Verb::Export(args) => verbs::export::run(&args, console),
        Verb::Play(args) => verbs::play::run(&args, console),
        Verb::Render(args) => verbs::render::run(&args, console),
        Verb::Describe(args) => verbs::describe::run(&args, console),
        Verb::Fmt(args) => verbs::fmt::run(&args, console),
        Verb::Conformance(args) => verbs::conformance::run(&args, console),
        Verb::Clean(args) => verbs::clean::run(&args, console),
        Verb::Recipes(args) => verbs::recipes::run(&args, console),
        Verb::Docs(args) => verbs::docs::run(&args, console),
        Verb::Completions(args) => verbs::completions::run(&args, console),
        Verb::Man(args) => verbs::man::run(&args, console),
    }
}
