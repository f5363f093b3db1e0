//! `arcade generate`: new levels for a game.

mod levels;

use crate::console::Console;
use crate::failure::Answer;

/// Makes new levels for a game, hand-made or generated.
///
/// Example: arcade generate levels --game hailglass --count 5 --out new-levels
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    Levels(Box<levels::Args>),
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    match &args.what {
        What::Levels(args) => levels::run(args, console),
    }
}
