//! `arcade describe`: the rules of a game in plain English, and what kind of game it is.

use crate::console::Console;
use crate::failure::Answer;
use crate::input;
use engine::Analysis;
use engine::describe::Guide;
use serde_json::json;

/// Says in plain English how a game is played, won and lost, what its sprites do, what happens when they meet, and what
/// kind of game it is.
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
    let analysis = Analysis::of(&game);
    let guide = Guide::from_analysis(&analysis);
    console.document(&json!({
        "game": input.source.name,
        "digest": game.digest(),
        "text": guide.to_string(),
        "taxonomy": analysis.taxonomy(),
        "can_win": analysis.can_win(),
        "can_lose": analysis.can_lose(),
    }))?;
    console.say(format_args!("{guide}\nWhat kind of game it is:\n  {}", guide.kind.join("\n  ")));
    Ok(true)
}
