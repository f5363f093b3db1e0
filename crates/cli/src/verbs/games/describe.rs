//! `arcade describe`: a game's rules in plain English, its kind, and a level's provable properties.

use crate::console::Console;
use crate::diagnostics::Named;
use crate::failure::{Answer, Failure};
use crate::input;
use base::Digest;
use engine::Analysis;
use engine::describe::{self, Guide};
use serde::Serialize;
use serde_json::json;

/// Describes in plain English how a game is played, won and lost, what its sprites do, what happens when they meet, and what kind
/// of game it is. With a level, also describes how much of it you can reach and which goals are out of reach.
///
/// Example: arcade describe hailglass 0
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, a level beside its game, or the name of a corpus game
    #[arg(value_name = "GAME")]
    game: String,
    /// A level file, or the number of one of the game's own levels
    #[arg(value_name = "LEVEL")]
    level: Option<String>,
    /// Load the game as the reference engine does, and tolerate the faults that it tolerates
    #[arg(long)]
    as_reference: bool,
}

/// A level's provable properties.
#[derive(Serialize)]
struct Prospects {
    level: String,
    digest: Digest,
    text: Vec<String>,
    can_win: bool,
    can_lose: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let input = input::game(&args.game)?;
    let named = match &args.level {
        Some(name) => Some(input.level(name)?),
        None => input.asked()?,
    };
    let game = input.compile(args.as_reference)?;
    let analysis = Analysis::of(&game);
    let prospects = named.map(|named| prospects(&analysis, &named)).transpose()?;
    let guide = Guide::from_analysis(&analysis);
    console.document(&json!({
        "game": input.source.name,
        "digest": game.digest(),
        "text": guide.to_string(),
        "taxonomy": analysis.taxonomy(),
        "can_win": analysis.can_win(),
        "can_lose": analysis.can_lose(),
        "level": prospects,
    }))?;
    console.say(format_args!("{guide}\nKind of game:\n  {}", guide.kind.join("\n  ")));
    if let Some(Prospects { level, text, .. }) = prospects {
        console.say(format_args!("\nProven about {level}:\n  {}", text.join("\n  ")));
    }
    Ok(true)
}

fn prospects(analysis: &Analysis, named: &Named) -> Result<Prospects, Failure> {
    let level = named.level(analysis.game())?;
    let reach = analysis.reach(&level);
    Ok(Prospects {
        level: named.name.clone(),
        digest: level.digest(),
        text: describe::level(analysis, &level, &reach),
        can_win: reach.can_win(),
        can_lose: reach.can_lose(),
    })
}
