//! `arcade generate`: generates new games, or new levels for an existing game.

mod games;
mod levels;

pub(super) use levels::size;

use crate::console::Console;
use crate::failure::{Answer, Failure};

/// Makes new games, or new levels for a hand-made or generated game.
///
/// Examples: arcade generate games --count 5 --out new-games,
/// arcade generate levels --game hailglass --count 5 --out new-levels
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    Games(Box<games::Args>),
    Levels(Box<levels::Args>),
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    match &args.what {
        What::Games(args) => games::run(args, console),
        What::Levels(args) => levels::run(args, console),
    }
}

/// Returns formatted JSON, for people and programs.
pub(super) fn pretty(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    let mut text = serde_json::to_vec_pretty(value)
        .map_err(|error| Failure::environment(error, "the result cannot be written as JSON"))?;
    text.push(b'\n');
    Ok(text)
}
