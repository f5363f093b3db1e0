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
mod marks;
mod memory;
mod numbers;
mod page;
mod paths;
mod play;
mod protected;
mod set_report;
mod shell;
mod threads;
mod timeline;
mod trusted;
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
/// Exit status: 0 yes or done; 1 the answer is no; 2 the question is malformed; 3 environment failure (I/O, network, disk full);
/// 128 + signal interrupted, such as 130 for Ctrl-C.
#[derive(Parser)]
#[command(name = "arcade", version = version::version(), propagate_version = true, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
    /// One JSON document on standard output, nothing else there
    #[arg(long, global = true)]
    json: bool,
    /// No progress, no remarks, and the shortest answer
    #[arg(short, long, global = true)]
    quiet: bool,
}

/// Declares the verbs in one place, in the groups and the order of the help: the variant, and the module with its `Args` and
/// `run`.
macro_rules! verbs {
    ($($group:literal { $($(#[$attribute:meta])* $verb:ident: $module:ident),* $(,)? })*) => {
        #[derive(Subcommand)]
        enum Verb { $($($(#[$attribute])* $verb(Box<verbs::$module::Args>),)*)* }

        /// The groups of the help, each with the number of its verbs.
        const GROUPS: &[(&str, usize)] = &[$(($group, [$(stringify!($verb)),*].len())),*];

        fn answer(verb: &Verb, console: &Console) -> Answer {
            // The guard of a player runs without a pool of threads.
            if !matches!(verb, Verb::PlayerGuard(_)) {
                threads::start()?;
            }
            match verb { $($(Verb::$verb(args) => verbs::$module::run(args, console),)*)* }
        }
    };
}

verbs! {
    "Make games" {
        New: new,
        Studio: studio,
        Play: play,
        Validate: validate,
        Generate: generate,
        Describe: describe,
        Render: render,
        Fmt: fmt,
        Lsp: lsp,
    }
    "Publish benchmarks" {
        Recipes: recipes,
        Release: release,
        Merge: merge,
        Verify: verify,
        Regenerate: regenerate,
        Keygen: keygen,
        Keys: keys,
        Sign: sign,
        Log: log,
        Diff: diff,
        Export: export,
        Gallery: gallery,
    }
    "Evaluate players" {
        Evaluate: evaluate,
        Report: report,
        Run: run,
        Mailbox: mailbox,
        ServePlayer: serve_player,
        #[command(hide = true)]
        PlayerGuard: player_guard,
        Calibrate: calibrate,
        Scale: scale,
        Timeline: timeline,
        Contamination: contamination,
    }
    "This program" {
        Docs: docs,
        Conformance: conformance,
        Clean: clean,
        Completions: completions,
        Man: man,
    }
}

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let cli = match usage::parse(&arguments) {
        Ok(cli) => cli,
        Err(status) => return ExitCode::from(status),
    };
    let console = Console::new(cli.json, cli.quiet);
    ExitCode::from(console.finish(answer(&cli.verb, &console)))
}
