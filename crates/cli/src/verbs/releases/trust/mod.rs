//! `arcade trust`: manages keys, signed roots and the public log.

mod keygen;
mod keys;
mod log;
mod sign;

use crate::console::Console;
use crate::failure::Answer;

/// Makes keys, signs releases, and keeps a public log of them.
///
/// Readers check a signed release with `arcade verify --key`. `arcade docs trust` has the steps for publishers.
///
/// Examples: arcade trust keygen ada,
/// arcade trust sign releases/2027-01 --secret ada.key
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    Keygen(keygen::Args),
    Keys(keys::Args),
    Sign(Box<sign::Args>),
    Log(log::Args),
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    match &args.what {
        What::Keygen(args) => keygen::run(args, console),
        What::Keys(args) => keys::run(args, console),
        What::Sign(args) => sign::run(args, console),
        What::Log(args) => log::run(args, console),
    }
}
