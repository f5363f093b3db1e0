//! `arcade merge`: merges a release's shards, which are its separately minted parts.

use crate::console::Console;
use crate::failure::Answer;
use crate::input::trusted::warn_of_readers;
use crate::protected;
use crate::verbs::releases::release::{corpus_with, read_secret_file, report, tools};
use snapshots::mint::Shards;
use std::path::PathBuf;

/// Joins the shards of a release. The result is bit-for-bit identical to the snapshot of an unsharded mint.
///
/// Example: arcade merge shard1 shard2 shard3 shard4 --out releases/medium
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folders of all shards, in any order
    #[arg(value_name = "SHARD", required = true)]
    shards: Vec<PathBuf>,
    /// The snapshot's folder (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The folder of designs, for a recipe with the section [designs]
    #[arg(long, value_name = "DIR")]
    designs: Option<PathBuf>,
    /// The secret of a sealed release
    #[arg(long, value_name = "FILE")]
    secret: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    protected::check(&args.out)?;
    let shards = Shards::open(&args.shards)?;
    let corpus = corpus_with(args.designs.as_deref())?;
    args.secret.iter().for_each(|file| warn_of_readers(file, console));
    let secret = args.secret.as_deref().map(read_secret_file).transpose()?;
    let minted = shards.merge(secret.as_ref(), &args.out, tools(&corpus))?;
    report(&minted, shards.recipe(), &args.out, None, console)
}
