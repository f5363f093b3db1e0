//! `arcade release`: mints a benchmark.

use crate::console::{Console, Stopwatch};
use crate::embedded;
use crate::failure::{Answer, Failure};
use crate::input;
use crate::verbs::verify::failure;
use indicatif::ProgressBar;
use serde_json::json;
use snapshots::card::{Card, Origin};
use snapshots::mint::{self, MintError, Minted, Progress};
use snapshots::{Draft, MANIFEST_FILE, MAX_RECIPE, Recipe};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Mints a snapshot of new, verified games and levels from a recipe: the same bytes from the same recipe, always.
///
/// The folder is complete or absent: until everything is minted, nothing is there but `<out>.partial`.
///
/// Example: arcade release starter --out my-benchmark
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A recipe's name, or a .toml file
    #[arg(value_name = "RECIPE", default_value = "starter")]
    recipe: String,
    /// The snapshot's folder: absent or empty; `releases/<name>` if not given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; all cores if not given. Changes no byte
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
    /// Say what would be minted, and mint nothing
    #[arg(long)]
    dry_run: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let recipe = find_recipe(&args.recipe)?;
    let corpus = embedded::corpus()?;
    let out = args.out.clone().unwrap_or_else(|| Path::new("releases").join(&recipe.name));
    if args.dry_run {
        let Recipe { corpus: old, generated: new, .. } = &recipe;
        console.document(&json!({ "recipe": recipe, "out": out }))?;
        console.say(format_args!("recipe `{}`: {}", recipe.name, recipe.description.trim()));
        console.say(format_args!("would mint {} new games of {} levels", new.games, new.levels));
        console.say(format_args!("and {} new levels for each of {} corpus games", old.levels, old.games));
        console.say(format_args!("into {}", out.display()));
        return Ok(true);
    }
    mint::check(&recipe, &corpus).map_err(mint_failure)?;
    // Before minutes of minting: is there a place to write to?
    let draft = Draft::create(&out).map_err(failure)?;
    let bars = Bars::new(console);
    let started = Stopwatch::start();
    let minted = in_pool(args.jobs, || mint::mint(&recipe, &corpus, embedded::lockfile(), &bars))?
        .map_err(mint_failure)?;
    bars.finish();
    fill(&draft, &minted)?;
    draft.commit().map_err(failure)?;
    let seconds = started.seconds();
    console.document(&json!({
        "out": out,
        "root": minted.manifest.root,
        "games": minted.cards,
        "tally": minted.tally,
    }))?;
    console.say(summary(&recipe, &out, &minted, seconds).trim_end());
    Ok(true)
}

fn find_recipe(name: &str) -> Result<Recipe, Failure> {
    let path = Path::new(name);
    let (shown, text) = if path.extension().is_some_and(|extension| extension == "toml") {
        (name.to_owned(), input::read_text(path, MAX_RECIPE)?)
    } else if let Some(text) = embedded::recipe(name) {
        (format!("seeds/{name}.toml"), text.to_owned())
    } else {
        let known = embedded::recipe_names();
        let near = engine::nearest(name, known.iter().map(String::as_str));
        let help = near.map_or_else(
            || format!("there are {}", known.join(", ")),
            |near| format!("did you mean `{near}`?"),
        );
        return Err(Failure::malformed(format!("no recipe named `{name}`; {help}, or name a .toml file")));
    };
    Recipe::from_toml(&text).map_err(|error| Failure::malformed(format!("{shown}: {error}")))
}

fn mint_failure(error: MintError) -> Failure {
    match error {
        MintError::Snapshot(error) => failure(error),
        other => Failure::Malformed(other.into()),
    }
}

/// Runs on so many threads.
pub(crate) fn in_pool<T: Send>(jobs: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    if jobs == Some(0) {
        return Err(Failure::malformed("--jobs takes a number of threads, at least 1"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.unwrap_or(0)).build();
    let pool = pool.map_err(|error| Failure::surroundings(error, "threads cannot be started"))?;
    Ok(pool.install(work))
}

/// Writes a minted release to a folder: complete or absent.
pub(crate) fn write(out: &Path, minted: &Minted) -> Result<(), Failure> {
    let draft = Draft::create(out).map_err(failure)?;
    fill(&draft, minted)?;
    draft.commit().map_err(failure)
}

fn fill(draft: &Draft, minted: &Minted) -> Result<(), Failure> {
    for (path, content) in &minted.files {
        draft.write(path, content).map_err(failure)?;
    }
    let manifest = minted.manifest.to_bytes().map_err(failure)?;
    draft.write(MANIFEST_FILE, &manifest).map_err(failure)
}

/// Progress on the terminal.
pub(crate) struct Bars {
    bar: ProgressBar,
}

impl Bars {
    pub(crate) fn new(console: &Console) -> Bars {
        Bars { bar: console.progress(0, "minting") }
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Bars {
    fn begin(&self, places: usize) {
        self.bar.set_length(places as u64);
    }

    fn tried(&self, place: &str, passed: bool) {
        if !passed {
            self.bar.set_message(format!("{place}: next candidate"));
        }
    }

    fn filled(&self, card: &Card) {
        self.bar.set_message(card.title.clone());
        self.bar.inc(1);
    }
}

/// What was minted, for a person.
fn summary(recipe: &Recipe, out: &Path, minted: &Minted, seconds: f64) -> String {
    let Minted { manifest, cards, tally, .. } = minted;
    let levels: usize = cards.iter().map(|card| card.levels.len()).sum();
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{}: {} games, {levels} levels, every one with a winning episode\n",
        recipe.name,
        cards.len()
    );
    let width = cards.iter().map(|card| card.title.chars().count()).max().unwrap_or(0);
    for card in cards {
        let origin = match card.origin {
            Origin::Generated { .. } => "new game",
            Origin::Corpus { .. } => "new levels",
        };
        let ticks: Vec<String> = card.levels.iter().map(|level| level.witness_ticks.to_string()).collect();
        let _ = writeln!(
            text,
            "  {:<width$}  {:<18} {origin:<11} won in {} ticks",
            card.title,
            card.kind,
            ticks.join(", ")
        );
        let _ = writeln!(text, "  {:<width$}  {}", "", card.goal);
    }
    if let Some(board) = showpiece(minted) {
        let _ = writeln!(text, "\n{board}");
    }
    let _ = writeln!(
        text,
        "\n{:.0} s; {} games and {} levels tried for {} and {levels}; {:.1} million forward-model calls",
        seconds,
        tally.games_tried,
        tally.levels_tried,
        cards.len(),
        tally.calls as f64 / 1e6,
    );
    if !tally.rejections.is_empty() {
        let _ = writeln!(text, "turned down: {}", tally.reasons());
    }
    let _ = writeln!(text, "\nroot {}\nin   {}", manifest.root, out.display());
    let _ = writeln!(text, "check it:       arcade verify {}", out.display());
    let _ = writeln!(text, "mint it again:  arcade regenerate {}", out.display());
    text
}

/// One new level, as text: something to look at.
fn showpiece(minted: &Minted) -> Option<String> {
    let new = |card: &&Card| matches!(card.origin, Origin::Generated { .. });
    let card = minted.cards.iter().find(new).or_else(|| minted.cards.first())?;
    let last = card.levels.last()?;
    let path = format!("games/{}/{}", card.id, last.file);
    let (_, content) = minted.files.iter().find(|(known, _)| *known == path)?;
    let board = String::from_utf8_lossy(content);
    let rows: Vec<String> = board.lines().map(|row| format!("    {row}")).collect();
    Some(format!("  {}, level {}:\n{}", card.title, card.levels.len() - 1, rows.join("\n")))
}
