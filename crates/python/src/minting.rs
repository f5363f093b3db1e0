//! Mints releases, like `arcade release` and `arcade merge`. Results are returned as JSON, in the format of
//! the command line.

use crate::corpus::corpus;
use crate::errors::{failed, invalid};
use crate::interrupt::interruptible;
use base::{Digest, Seed};
use evaluation::reference::{ReferencePlayer, ReferencePlays, SEED};
use include_dir::{Dir, include_dir};
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use serde_json::json;
use snapshots::marks::{MarkPlayers, MarksPart, Wins};
use snapshots::mint::{Minted, Shard, Shards};
use snapshots::{Corpus, CorpusGame, Order, Outcome, Recipe, Tools, follow, read_secret};
use std::path::{Path, PathBuf};

static SEEDS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../seeds");
static LOCKFILE: &[u8] = include_bytes!("../../../Cargo.lock");

/// Returns the text of the embedded recipe with the given name; `None` if there is no such recipe.
#[pyfunction]
pub(crate) fn recipe(name: &str) -> Option<&'static str> {
    SEEDS.get_file(format!("{name}.toml"))?.contents_utf8()
}

/// Mints a release, or its part (shard) `K/N`, from the text of its recipe.
#[pyfunction]
#[pyo3(signature = (recipe, out, *, parent = None, secret = None, shard = None, resume = false, jobs = None))]
#[allow(clippy::too_many_arguments, reason = "each option of `arcade release` is an argument")]
pub(crate) fn mint(
    py: Python<'_>,
    recipe: String,
    out: PathBuf,
    parent: Option<PathBuf>,
    secret: Option<PathBuf>,
    shard: Option<&str>,
    resume: bool,
    jobs: Option<usize>,
) -> PyResult<String> {
    let shard: Option<Shard> = shard.map(str::parse).transpose().map_err(invalid)?;
    interruptible(py, move |interrupt| {
        let secret = secret.as_deref().map(read_secret).transpose().map_err(failed)?;
        let mut recipe = Recipe::to_mint(&recipe, secret.as_ref()).map_err(failed)?;
        match &parent {
            Some(parent) => follow(&mut recipe, parent).map_err(failed)?,
            None if recipe.parent.is_some() => {
                return Err(failed("the recipe has a parent: pass the parent's folder"));
            }
            None => {}
        }
        let order = Order { recipe, secret, out, shard, resume };
        let corpus = hand_written()?;
        match in_pool(jobs, || order.mint(tools(&corpus), interrupt))?.map_err(failed)? {
            Outcome::Complete => Ok(json!({ "out": order.out, "complete": true }).to_string()),
            Outcome::Shard(jobs) => {
                let shard = order.shard.map(|shard| shard.to_string());
                Ok(json!({ "out": order.out, "shard": shard, "jobs": jobs }).to_string())
            }
            Outcome::Release(minted) => Ok(document(&minted, &order.recipe, &order.out)),
        }
    })
}

/// Merges a release's shards, which are its separately minted parts.
#[pyfunction]
#[pyo3(signature = (shards, out, *, secret = None, jobs = None))]
pub(crate) fn merge(
    py: Python<'_>,
    shards: Vec<PathBuf>,
    out: PathBuf,
    secret: Option<PathBuf>,
    jobs: Option<usize>,
) -> PyResult<String> {
    interruptible(py, move |_| {
        let secret = secret.as_deref().map(read_secret).transpose().map_err(failed)?;
        let shards = Shards::open(&shards).map_err(failed)?;
        let corpus = hand_written()?;
        let merge = || shards.merge(secret.as_ref(), &out, tools(&corpus));
        let minted = in_pool(jobs, merge)?.map_err(failed)?;
        Ok(document(&minted, shards.recipe(), &out))
    })
}

/// Describes a release as JSON, in the format of the command line.
fn document(minted: &Minted, recipe: &Recipe, out: &Path) -> String {
    let (root, games, card) = (minted.manifest.root, &minted.cards, &minted.card);
    json!({ "out": out, "root": root, "games": games, "card": card, "caveats": recipe.caveats() }).to_string()
}

/// Returns the tools required for minting.
fn tools(corpus: &Corpus) -> Tools<'_> {
    Tools { corpus, lockfile: Digest::of(LOCKFILE), players: &Players }
}

/// The reference players whose results a release stores, by the names that `arcade evaluate --player` accepts.
#[derive(Debug)]
struct Players;

impl MarkPlayers for Players {
    fn check(&self, player: &str) -> Result<(), String> {
        player.parse::<ReferencePlayer>().map(drop)
    }

    fn play(&self, game: &str, levels: &[String], asked: &MarksPart) -> Result<Vec<Wins>, String> {
        let plays =
            ReferencePlays { seed: Seed::from_text(SEED), runs: asked.plays, max_steps: asked.max_steps };
        plays.of_game(game, levels, &asked.players, asked.commits.iter().map(|commit| commit.name()))
    }
}

/// Returns the corpus of hand-written games.
fn hand_written() -> PyResult<Corpus> {
    let game = |(name, source, levels, card): (String, String, Vec<String>, String)| {
        CorpusGame::read(name, source, levels, &card).map_err(failed)
    };
    Ok(Corpus { games: corpus().into_iter().map(game).collect::<PyResult<_>>()?, designs: None })
}

/// Runs `work` on a pool with the given number of threads. The default is one thread per core.
fn in_pool<T: Send>(jobs: Option<usize>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = ThreadPoolBuilder::new().num_threads(jobs.unwrap_or(0)).build().map_err(failed)?;
    Ok(pool.install(work))
}
