//! `arcade describe`: the rules of a game in plain English.

use crate::console::Console;
use crate::failure::Answer;
use crate::input;
use serde_json::json;

/// Says in plain English how a game is played, won and lost, what its sprites do, and what happens when they meet.
///
/// Example: arcade describe hailglass
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, or the name of a corpus game
    #[arg(value_name = "GAME")]
    game: String,
    /// Load the game as the reference engine does: overlook faults that it overlooks
    #[arg(long)]
    as_reference: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let input = input::game(&args.game)?;
    let game = input.compile(args.as_reference)?;
    let text = engine::describe(&game);
    console.document(&json!({ "game": input.source.name, "digest": game.digest(), "text": text }))?;
    console.say(text.trim_end());
    Ok(true)
}
