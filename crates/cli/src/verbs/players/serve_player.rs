//! `arcade serve-player`: serves a player of known strength through a chat completions API, only on this
//! machine.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::shell;
use evaluation::serve::{PromptPlayer, Server};
use serde_json::json;
use std::path::Path;

/// Answers OpenAI-compatible chat completion requests on 127.0.0.1 with a player that knows only the prompt, until the
/// command is stopped. The player is `random`, `reflex` (which takes the shortest way, according to the board and the
/// rules in the prompt) or `planner:NAME[:CALLS]` (which plans from the position in the prompt, if the prompt is
/// complete). The first line of output contains the base URL.
///
/// Example: arcade serve-player --player reflex --port 8090
#[derive(clap::Args)]
pub(crate) struct Args {
    /// random, reflex, or planner:NAME[:CALLS]
    #[arg(long, value_name = "NAME")]
    player: String,
    /// The port; 0 selects any free port
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let player: PromptPlayer = args.player.parse().map_err(Failure::malformed)?;
    let name = player.to_string();
    let is_planner = matches!(player, PromptPlayer::Planner(_));
    let server = Server::bind(player, args.port)
        .map_err(|error| Failure::environment(error, "the server cannot be started"))?;
    console.line(&json!({"base_url": server.base_url(), "port": server.address().port(), "model": name}));
    let words = ["evaluate", "GAME", "--model", &name, "--base-url", &server.base_url()].map(str::to_owned);
    // A planner can read only rules in VGDL.
    let rules = if is_planner { " --rules vgdl" } else { "" };
    console.remark(format_args!(
        "serving at {} until this process is stopped; evaluate it: {}{rules}",
        server.base_url(),
        shell::command(words.iter().map(Path::new))
    ));
    server.run().map_err(|error| Failure::environment(error, "the server has stopped"))?;
    Ok(true)
}
