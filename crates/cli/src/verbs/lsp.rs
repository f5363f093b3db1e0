//! `arcade lsp`: a language server for editors.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use std::io::{self, BufReader, IsTerminal};

/// Runs a language server for games and levels on standard input and output; editors start it.
///
/// It tells the problems of *.vgdl and game.txt files while they are written, and those of the lvlN.txt files beside a
/// game, and offers repairs, explanations, completions, renaming and formatting. `arcade docs lsp` has the settings of
/// editors.
///
/// Example: hx --health vgdl, after setting command = "arcade" and args = ["lsp"]
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Changes nothing; for editors that name the transport: there is no other
    #[arg(long)]
    stdio: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let Args { stdio: _ } = args;
    if io::stdin().is_terminal() {
        console.remark(
            "editors start this command and talk to it; `arcade docs lsp` has their settings. Press Ctrl-D \
             to stop it",
        );
    }
    let input = BufReader::new(io::stdin());
    editor::lsp::serve(input, io::stdout())
        .map_err(|error| Failure::environment(error, "the connection to the editor failed"))
}
