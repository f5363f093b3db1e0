//! The `arcade` binary. Each subcommand has its own module. All other code is in the library crates.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "doc comments on arguments become the help text, including brackets"
)]

#[macro_use]
mod failure;

mod book;
mod ceilings;
mod console;
mod diagnostics;
mod flags;
mod input;
mod interrupt;
mod marks;
mod paths;
mod protected;
mod shell;
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
/// Exit status: 0 yes or done; 1 the answer is no; 2 malformed input; 3 environment failure (I/O, network, disk
/// full); 128 + signal if interrupted, such as 130 for Ctrl-C.
#[derive(Parser)]
#[command(name = "arcade", version = version::version(), propagate_version = true, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
    /// Print one JSON document and nothing else on standard output
    #[arg(long, global = true)]
    json: bool,
    /// Print only the shortest answer, without progress or warnings
    #[arg(short, long, global = true)]
    quiet: bool,
    #[command(flatten)]
    limits: flags::threads::Limits,
}

/// Declares the subcommands, grouped and ordered as in the help. Each entry contains the variant and the
/// module with its `Args` and `run`. The short help lists subcommands after `more` by name only.
macro_rules! verbs {
    ($($group:literal in $folder:ident {
        $($verb:ident: $module:ident),* $(,)?; more $($(#[$attribute:meta])* $rare:ident: $other:ident),* $(,)?
    })*) => {
        #[derive(Subcommand)]
        enum Verb {
            $($($verb(Box<verbs::$folder::$module::Args>),)* $($(#[$attribute])* $rare(Box<verbs::$folder::$other::Args>),)*)*
        }

        /// The help groups. Each group has a title, the number of subcommands that the short help describes,
        /// and the number of subcommands that it lists by name only.
        const GROUPS: &[(&str, usize, usize)] =
            &[$(($group, [$(stringify!($verb)),*].len(), [$(stringify!($rare)),*].len())),*];

        fn answer(Cli { verb, limits, .. }: &Cli, console: &Console) -> Answer {
            // The guard of a player (its supervising process) runs without a thread pool.
            if !matches!(verb, Verb::PlayerGuard(_)) {
                limits.apply()?;
            }
            match verb {
                $($(Verb::$verb(args) => verbs::$folder::$module::run(args, console),)*)*
                $($(Verb::$rare(args) => verbs::$folder::$other::run(args, console),)*)*
            }
        }
    };
}

verbs! {
    "Make games" in games {
        New: new,
        Play: play,
        Validate: validate,
        Generate: generate,
        Studio: studio;
        more
        Stream: stream,
        Design: design,
        Describe: describe,
        Render: render,
        Fmt: fmt,
        Lsp: lsp,
    }
    "Publish benchmarks" in releases {
        Recipes: recipes,
        Release: release,
        Verify: verify,
        Regenerate: regenerate,
        Trust: trust;
        more
        Merge: merge,
        Diff: diff,
        Export: export,
        Gallery: gallery,
    }
    "Evaluate players" in players {
        Evaluate: evaluate,
        Report: report,
        Study: study;
        more
        Run: run,
        Mailbox: mailbox,
        WorldModel: world_model,
        ServePlayer: serve_player,
        #[command(hide = true)]
        PlayerGuard: player_guard,
    }
    "This program" in program {
        Docs: docs;
        more
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
    ExitCode::from(console.finish(answer(&cli, &console)))
}
