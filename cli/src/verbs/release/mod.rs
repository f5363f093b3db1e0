//! `arcade release`: mints a benchmark.

mod bars;
mod sealed;

use crate::console::{Console, Stopwatch};
use crate::embedded;
use crate::failure::{Answer, Failure};
use crate::input;
pub(crate) use crate::threads::in_pool;
use crate::verbs::verify::failure;
pub(crate) use bars::Bars;
pub(crate) use sealed::read as read_secret_file;
use serde_json::json;
use snapshots::card::{Card, Origin};
use snapshots::mint::{Lot, LotFolder, MintError, Minted, Plan, Shard, Shelf, lay_out, make_lots};
use snapshots::{Draft, HELD, MANIFEST_FILE, MAX_RECIPE, Recipe, Secret, check_vacant, follow};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Mints a snapshot of new, verified games and levels from a recipe: the same bytes from the same recipe, always.
///
/// The folder is complete or absent: until everything is minted, nothing is there but `<out>.partial`, from which an
/// interrupted mint goes on with --resume. With --shard, only a slice is made, for `arcade merge`.
///
/// Example: arcade release starter --out my-benchmark
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A recipe's name, or a .toml file; with --reveal, the public folder of a sealed release
    #[arg(value_name = "RECIPE", default_value = "starter")]
    recipe: String,
    /// The snapshot's folder: absent or empty; `releases/<name>` if not given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; all cores if not given. Changes no byte
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
    /// Make the K-th of N slices only
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Go on where an interrupted mint stopped
    #[arg(long)]
    resume: bool,
    /// Say what would be minted, and what it would cost; mint nothing
    #[arg(long)]
    dry_run: bool,
    /// The folder of the release before: nothing that it, or one before it, holds is minted again
    #[arg(long, value_name = "DIR")]
    parent: Option<PathBuf>,
    /// The secret of a sealed release, as --commit made it
    #[arg(long, value_name = "FILE")]
    secret: Option<PathBuf>,
    /// Draw a secret for this recipe, write it to the file --out, and say what to commit to
    #[arg(long, conflicts_with_all = ["shard", "resume", "dry_run", "secret", "reveal", "parent"])]
    commit: bool,
    /// Join a sealed release with the part that was held back, this folder, if both are what was committed to
    #[arg(long, value_name = "DIR", conflicts_with_all = ["shard", "resume", "dry_run", "secret", "parent"])]
    reveal: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.commit {
        return sealed::commit(&args.recipe, args.out.as_deref(), console);
    }
    if let Some(held) = &args.reveal {
        return sealed::reveal(Path::new(&args.recipe), held, args.out.as_deref(), console);
    }
    let mut recipe = find_recipe(&args.recipe)?;
    let corpus = embedded::corpus()?;
    let secret = args.secret.as_deref().map(sealed::read).transpose()?;
    match &args.parent {
        Some(parent) => follow(&mut recipe, parent).map_err(|error| match error {
            snapshots::AncestryError::Snapshot(error) => failure(error),
            other => Failure::Malformed(other.into()),
        })?,
        None if recipe.parent.is_some() => {
            let help =
                "the recipe names a parent: give its folder with --parent, so that nothing is minted twice";
            return Err(Failure::malformed(help));
        }
        None => {}
    }
    let out = match (&args.out, args.shard) {
        (Some(out), _) => out.clone(),
        (None, None) => Path::new("releases").join(&recipe.name),
        (None, Some(_)) => return Err(Failure::malformed("--shard needs --out: a folder for the shard")),
    };
    if args.dry_run && recipe.seed.is_none() && secret.is_none() {
        return sealed::outline(&recipe, console);
    }
    let plan = Plan::new(&recipe, secret.as_ref(), &corpus).map_err(mint_failure)?;
    let lots = args.shard.map_or_else(|| plan.lots().to_vec(), |shard| shard.lots(&plan));
    if args.dry_run {
        check_vacant(&out).map_err(failure)?;
        return outline(&plan, &lots, &recipe, &out, console);
    }
    // Before minutes of minting: is there a place to write to?
    let draft = if args.resume { Draft::resume(&out) } else { Draft::create(&out) }.map_err(failure)?;
    if plan.is_sealed() {
        draft.keep_private().map_err(failure)?;
    }
    let digest = plan.digest().map_err(failure)?;
    let shelf = LotFolder::open(&draft.lots(), digest).map_err(failure)?;
    let bars = Bars::new(console);
    let started = Stopwatch::start();
    in_pool(args.jobs, || make_lots(&plan, &lots, &shelf, &bars))?.map_err(mint_failure)?;
    bars.finish();
    if let Some(shard) = args.shard {
        shard.write(&plan, &shelf, &draft).map_err(mint_failure)?;
        draft.commit().map_err(failure)?;
        console.document(&json!({ "out": out, "shard": shard.to_string(), "lots": lots.len() }))?;
        console.say(format_args!(
            "shard {shard} of `{}`: {} lots, in {}",
            recipe.name,
            lots.len(),
            out.display()
        ));
        console.say(format_args!("when all shards are there: arcade merge SHARD... --out DIR"));
        return Ok(true);
    }
    let finished = Finished { plan: &plan, secret: secret.as_ref(), shelf: &shelf, out: &out };
    finished.publish(draft, Some(started.seconds()), args.jobs, console)
}

/// A release all of whose lots are made.
pub(crate) struct Finished<'a> {
    pub(crate) plan: &'a Plan<'a>,
    pub(crate) secret: Option<&'a Secret>,
    pub(crate) shelf: &'a dyn Shelf,
    pub(crate) out: &'a Path,
}

impl Finished<'_> {
    /// Lays the release out, publishes it and tells of it.
    pub(crate) fn publish(
        &self,
        draft: Draft,
        seconds: Option<f64>,
        jobs: Option<usize>,
        console: &Console,
    ) -> Answer {
        let is_sealed = self.plan.is_sealed();
        let minted = in_pool(jobs, || {
            let mut write = |path: &str, content: &[u8]| match (is_sealed, path.starts_with(HELD)) {
                (true, false) => draft.write(&format!("public/{path}"), content),
                _ => draft.write(path, content),
            };
            lay_out(self.plan, self.secret, self.shelf, embedded::lockfile(), &mut write)
        })?
        .map_err(mint_failure)?;
        let manifest = minted.manifest.to_bytes().map_err(failure)?;
        let path = if is_sealed { format!("public/{MANIFEST_FILE}") } else { MANIFEST_FILE.to_owned() };
        draft.write(&path, &manifest).map_err(failure)?;
        for (path, text) in minted.papers() {
            let path = if is_sealed { format!("public/{path}") } else { path };
            draft.write(&path, text.as_bytes()).map_err(failure)?;
        }
        draft.commit().map_err(failure)?;
        console.document(&json!({
            "out": self.out,
            "root": minted.manifest.root,
            "games": minted.cards,
            "card": minted.card,
        }))?;
        console.say(summary(&minted, self.out, seconds).trim_end());
        Ok(true)
    }
}

/// What would be minted.
fn outline(plan: &Plan<'_>, lots: &[Lot], recipe: &Recipe, out: &Path, console: &Console) -> Answer {
    let (old, new) = (&recipe.corpus, &recipe.generated);
    let seconds = plan.seconds(lots);
    let minutes = seconds / 60.0;
    let lots: Vec<String> = lots.iter().map(|&lot| plan.name(lot)).collect();
    console.document(&json!({ "recipe": recipe, "out": out, "lots": lots, "core_minutes": minutes }))?;
    console.say(format_args!("recipe `{}`: {}", recipe.name, recipe.description.trim()));
    console.say(format_args!("would mint {} new games of {} levels", new.games, new.levels));
    console.say(format_args!("and {} new levels for each of {} corpus games", old.levels, old.games));
    if !recipe.difficulty.is_empty() {
        let shares = plan.histogram().into_iter().map(|(label, levels)| format!("{label} {levels}"));
        console
            .say(format_args!("with levels of each difficulty: {}", shares.collect::<Vec<_>>().join(", ")));
    }
    let goals = recipe.goal_quotas().into_iter().map(|(goal, quota)| (goal.name(), quota));
    let avatars = recipe.avatar_quotas().into_iter().map(|(avatar, quota)| (avatar.name(), quota));
    let quotas: Vec<String> =
        goals.chain(avatars).map(|(name, (least, most))| format!("{name} {least} to {most}")).collect();
    if !quotas.is_empty() {
        console.say(format_args!("with games of each kind: {}", quotas.join(", ")));
    }
    console.say(format_args!("chosen from the candidates of {} lots", lots.len()));
    match seconds < 60.0 {
        true => console.say(format_args!("in about {seconds:.0} seconds of one core")),
        false => console.say(format_args!("in about {minutes:.0} minutes of one core")),
    }
    console.say(format_args!("into {}", out.display()));
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

pub(crate) fn mint_failure(error: MintError) -> Failure {
    match error {
        MintError::Snapshot(error) => failure(error),
        other => Failure::Malformed(other.into()),
    }
}

/// What was minted, for a person.
fn summary(minted: &Minted, out: &Path, seconds: Option<f64>) -> String {
    let Minted { manifest, cards, card } = minted;
    let tally = &card.tally;
    let levels: usize = cards.iter().map(|card| card.levels.len()).sum();
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{}: {} games, {levels} levels, every one with a winning episode\n",
        manifest.name,
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
    if let Some(board) = showpiece(minted, out) {
        let _ = writeln!(text, "\n{board}");
    }
    for bin in card.planned.iter().filter(|_| !card.planned.is_empty()) {
        let _ = writeln!(text, "{}: {} (planned {} to {})", bin.name, bin.there, bin.least, bin.most);
    }
    let _ = writeln!(
        text,
        "\n{}{} games and {} levels tried for {} and {levels}; {:.1} million forward-model calls",
        seconds.map_or(String::new(), |seconds| format!("{seconds:.0} s; ")),
        tally.games_tried,
        tally.levels_tried,
        cards.len(),
        tally.calls as f64 / 1e6,
    );
    if !tally.rejections.is_empty() {
        let _ = writeln!(text, "turned down: {}", tally.reasons());
    }
    let _ = writeln!(text, "\nroot {}\nin   {}", manifest.root, out.display());
    match manifest.commitment {
        None => {
            let _ = writeln!(text, "check it:       arcade verify {}", out.display());
            let _ = writeln!(text, "mint it again:  arcade regenerate {}", out.display());
        }
        Some(_) => {
            let (public, held) = (out.join("public"), out.join("held"));
            let _ = writeln!(text, "publish now:    {}", public.display());
            let _ = writeln!(text, "keep to yourself until it is revealed: {}", held.display());
        }
    }
    text
}

/// One new level, as text: something to look at.
fn showpiece(minted: &Minted, out: &Path) -> Option<String> {
    let new = |card: &&Card| matches!(card.origin, Origin::Generated { .. });
    let card = minted.cards.iter().find(new).or_else(|| minted.cards.first())?;
    let last = card.levels.last()?;
    let root = if minted.manifest.commitment.is_some() { out.join("public") } else { out.to_owned() };
    let board = std::fs::read_to_string(root.join("games").join(&card.id).join(&last.file)).ok()?;
    let rows: Vec<String> = board.lines().map(|row| format!("    {row}")).collect();
    Some(format!("  {}, level {}:\n{}", card.title, card.levels.len() - 1, rows.join("\n")))
}
