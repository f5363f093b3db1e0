//! `arcade study`: compares months and models across several evaluations.

mod calibrate;
mod contamination;
mod scale;
mod timeline;
mod well;

use crate::console::Console;
use crate::failure::Answer;

/// Compares players over months, and tests whether they have seen a release.
///
/// `calibrate` puts the levels of releases on one scale, `scale` places players on it, and `timeline` shows the months on one page
/// (`arcade docs scale`). `contamination` tests whether players have seen the games of a sealed release (`arcade docs memory`).
/// `well` measures how many new games a chain of months can still invent (`arcade docs well`).
///
/// Examples: arcade study calibrate releases/2026-11 --out scales/2026-11,
/// arcade study scale results/a-model --scale scales/2026-11/scale.json
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    Calibrate(Box<calibrate::Args>),
    Scale(scale::Args),
    Timeline(timeline::Args),
    Contamination(contamination::Args),
    Well(well::Args),
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    match &args.what {
        What::Calibrate(args) => calibrate::run(args, console),
        What::Scale(args) => scale::run(args, console),
        What::Timeline(args) => timeline::run(args, console),
        What::Contamination(args) => contamination::run(args, console),
        What::Well(args) => well::run(args, console),
    }
}
