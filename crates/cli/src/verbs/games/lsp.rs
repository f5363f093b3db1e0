//! `arcade lsp`: a language server for editors.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use std::io::{self, BufReader, IsTerminal};

/// Runs a language server for games and levels on standard input and output; editors start it.
///
/// It reports the problems in *.vgdl and game.txt files, and in the lvlN.txt files beside a game, while they are edited. It
/// offers fixes, explanations, completions, renaming and formatting. `arcade docs lsp` has the settings for editors.
///
/// Example: hx --health vgdl, after setting command = "arcade" and args = ["lsp"]
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Has no effect; accepted for editors that specify the transport, which is always standard input and output
    #[arg(long)]
    stdio: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let Args { stdio: _ } = args;
    if io::stdin().is_terminal() {
        console.remark(
            "editors start this command and communicate with it; `arcade docs lsp` lists the settings for \
             editors. Press Ctrl-D to stop",
        );
    }
    let input = BufReader::new(io::stdin());
    editor::lsp::serve(input, io::stdout())
        .map_err(|error| Failure::environment(error, "the connection to the editor failed"))
}
