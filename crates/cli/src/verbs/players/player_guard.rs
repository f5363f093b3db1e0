//! `arcade player-guard`: supervises a player's program for `arcade evaluate`. The subcommand is not intended
//! for direct use.

use crate::console::Console;
use crate::failure::Answer;
use std::ffi::OsString;
use std::path::PathBuf;

/// Runs a player's program, and stops it when `arcade evaluate` has ended.
#[derive(clap::Args)]
#[command(hide = true)]
pub(crate) struct Args {
    /// The folder in which the program runs, removed at the end
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// The program and its arguments
    #[arg(value_name = "COMMAND", required = true, last = true)]
    command: Vec<OsString>,
}

/// Returns a guard's command line, which runs the current program even if its file has been replaced in the
/// meantime. It is empty on non-Unix systems, or if the program cannot be found.
pub(crate) fn command() -> Vec<OsString> {
    let own = PathBuf::from("/proc/self/exe");
    let program = if own.exists() { Some(own) } else { std::env::current_exe().ok() };
    match program.filter(|_| cfg!(unix)) {
        Some(program) => vec![program.into(), "player-guard".into()],
        None => Vec::new(),
    }
}

/// Exits the process and never returns.
pub(crate) fn run(args: &Args, _: &Console) -> Answer {
    #[cfg(unix)]
    {
        let (program, arguments) = args.command.split_first().expect("the parser requires a command");
        std::process::exit(evaluation::player::process::guard(&args.folder, program, arguments))
    }
    #[cfg(not(unix))]
    {
        let _ = (&args.folder, &args.command);
        std::process::exit(i32::from(crate::failure::MALFORMED))
    }
}
