//! `arcade release`: mints a benchmark.

mod cost;
mod outline;
mod probe;
mod progress;
mod sealed;
mod summary;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::flags::threads;
use crate::input;
use crate::input::embedded;
use crate::input::trusted::warn_of_readers;
use crate::marks;
use crate::paths;
use crate::protected;
use crate::shell;
use base::MessagePath;
pub(crate) use cost::{LONG, forecast, words as forecast_words};
pub(crate) use progress::{ProgressBars, Remarks, Reporter};
pub(crate) use sealed::{check_beacon, read as read_secret_file, secret_file};
use serde_json::json;
use snapshots::mint::{Minted, Shard};
use snapshots::{
    Corpus, DesignPool, Draft, MAX_RECIPE, Order, Outcome, PoolError, Recipe, RecipeError, Reveal, Tools,
    follow,
};
use std::fs;
use std::path::{Path, PathBuf};
pub(crate) use summary::sign_command;
use summary::{in_short, summary};
use trust::log::is_month;

/// Mints a snapshot of new, verified games and levels from a recipe. The same recipe always gives the same bytes.
///
/// The folder is either complete or absent. Until everything is minted, there is only `<out>.partial`, from which an
/// interrupted mint continues with --resume. With --shard, only a slice is made, for `arcade merge`.
///
/// Example: arcade release starter --out my-benchmark
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A recipe's name, or a .toml file [default: starter]. With --reveal, the public folder of a sealed release
    #[arg(value_name = "RECIPE")]
    recipe: Option<PathBuf>,
    /// The snapshot's folder (new or empty) [default: `releases/<name>`]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Make only the K-th of N slices
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Resume an interrupted mint
    #[arg(long)]
    resume: bool,
    /// Print the contents and the cost of the mint, but mint nothing. With --resume, print those of the remaining part
    /// only
    #[arg(long)]
    dry_run: bool,
    /// The previous release's folder. No content of the previous release or an earlier one is minted again
    #[arg(long, value_name = "DIR", value_parser = crate::paths::release_parser())]
    parent: Option<PathBuf>,
    /// The folder of designs, as written by `arcade design`, for a recipe with the section [designs]
    #[arg(long, value_name = "DIR", conflicts_with = "reveal")]
    designs: Option<PathBuf>,
    /// The secret of a sealed release, as written by --commit
    #[arg(long, value_name = "FILE")]
    secret: Option<PathBuf>,
    /// The value of the beacon that the recipe of a sealed release specifies, as a JSON file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["commit", "reveal"])]
    beacon: Option<PathBuf>,
    /// Draw a secret for this recipe, write it to the file --out, and print the commitment
    #[arg(long, conflicts_with_all = ["shard", "resume", "dry_run", "secret", "reveal"])]
    commit: bool,
    /// Join a sealed release with its withheld part in this folder, if both match the commitments
    #[arg(long, value_name = "DIR", conflicts_with_all = ["shard", "resume", "dry_run", "secret", "parent"])]
    reveal: Option<PathBuf>,
    /// Reveal one of the two recorded wins per level, and keep the others sealed (see `arcade docs memory`)
    #[arg(long, requires = "reveal")]
    solutions: bool,
}

impl Args {
    fn recipe(&self) -> &Path {
        self.recipe.as_deref().unwrap_or(Path::new("starter"))
    }

    /// Returns the command that resumes this mint after an interruption.
    fn resumed(&self, out: &Path) -> String {
        let mut command = vec!["release".into(), self.recipe().as_os_str().to_owned()];
        let shard = self.shard.map(|shard| PathBuf::from(shard.to_string()));
        let options = [
            ("--parent", self.parent.as_deref()),
            ("--designs", self.designs.as_deref()),
            ("--secret", self.secret.as_deref()),
            ("--beacon", self.beacon.as_deref()),
            ("--shard", shard.as_deref()),
            ("--out", Some(out)),
        ];
        for (option, value) in options {
            command.extend(value.into_iter().flat_map(|value| [option.into(), value.as_os_str().to_owned()]));
        }
        command.extend(threads::flags());
        command.push("--resume".into());
        shell::command(command)
    }
}

/// The work requested by the flags.
enum Request<'a> {
    /// Draw a secret for the recipe in the given file.
    Commit(&'a Path),
    /// Join the public part of a sealed release with its withheld part.
    Reveal { held: &'a Path, what: Reveal },
    /// Print the public facts of a sealed release without using its secret.
    Facts(Recipe),
    /// Print a mint's contents and cost.
    Outline(Order),
    /// Mint a release.
    Mint(Order),
}

impl Request<'_> {
    fn of<'a>(args: &'a Args, console: &Console) -> Result<Request<'a>, Failure> {
        if args.commit {
            return Ok(Request::Commit(args.recipe()));
        }
        if let Some(held) = &args.reveal {
            let what = if args.solutions { Reveal::Solutions } else { Reveal::All };
            return Ok(Request::Reveal { held, what });
        }
        args.secret.iter().for_each(|file| warn_of_readers(file, console));
        let secret = args.secret.as_deref().map(sealed::read).transpose()?;
        let mut recipe = find_recipe(args.recipe(), |text| Recipe::to_mint(text, secret.as_ref()))?;
        if let Some(file) = &args.beacon {
            sealed::take_beacon(&mut recipe, file)?;
        }
        match &args.parent {
            Some(parent) => follow(&mut recipe, parent)?,
            None if recipe.parent.is_some() => {
                bail!(
                    "the recipe has a parent: pass the parent's folder with --parent, so that no content is minted \
                     twice"
                );
            }
            None => {}
        }
        let out = match (&args.out, args.shard) {
            (Some(out), _) => out.clone(),
            (None, None) => Path::new("releases").join(&recipe.name),
            (None, Some(_)) => bail!("--shard needs --out, the folder of the shard"),
        };
        protected::check(&out)?;
        if args.dry_run && recipe.seed.is_none() && secret.is_none() {
            return Ok(Request::Facts(recipe));
        }
        let order = Order { recipe, secret, out, shard: args.shard, resume: args.resume };
        Ok(if args.dry_run { Request::Outline(order) } else { Request::Mint(order) })
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let request = Request::of(args, console)?;
    let corpus = corpus_with(args.designs.as_deref())?;
    let tools = tools(&corpus);
    match request {
        Request::Commit(recipe) => {
            sealed::commit(recipe, args.parent.as_deref(), args.out.as_deref(), tools, console)
        }
        Request::Reveal { held, what } => {
            sealed::reveal(args.recipe.as_deref(), held, what, args.out.as_deref(), console)
        }
        Request::Facts(recipe) => outline::without_secret(&recipe, tools, console),
        Request::Outline(order) => {
            let prepared = order.prepare(tools, &Remarks(console))?;
            if prepared.is_complete {
                return already_complete(&order, console);
            }
            outline::outline(&prepared, &order, &corpus, console)
        }
        Request::Mint(order) => mint(args, &order, tools, console),
    }
}

/// Returns the embedded corpus, with the designs in a folder.
pub(crate) fn corpus_with(designs: Option<&Path>) -> Result<Corpus, Failure> {
    let designs = designs.map(DesignPool::read).transpose().map_err(|error| match error {
        PoolError::Io { .. } => Failure::Environment(error.into()),
        _ => Failure::malformed(error),
    })?;
    Ok(Corpus { designs, ..embedded::corpus()? })
}

/// Returns the minting tools that this binary provides.
pub(crate) fn tools(corpus: &Corpus) -> Tools<'_> {
    Tools { corpus, lockfile: embedded::lockfile(), players: &marks::Players }
}

fn already_complete(order: &Order, console: &Console) -> Answer {
    let place = order.out.in_message().to_string();
    console.document(&json!({ "out": place, "complete": true }))?;
    console.say(format_args!("already complete: {place}"));
    Ok(true)
}

/// Returns `true` if the unfinished folder for `out` contains at least one job's result.
fn has_finished_jobs(out: &Path) -> bool {
    let jobs = Draft::jobs_of(out).and_then(|jobs| fs::read_dir(jobs).ok());
    let is_result = |entry: fs::DirEntry| entry.path().extension().is_some_and(|end| end == "json");
    jobs.is_some_and(|jobs| jobs.flatten().any(is_result))
}

/// Mints the release or a shard (a part of the release), and reports the result.
fn mint(args: &Args, order: &Order, tools: Tools<'_>, console: &Console) -> Answer {
    let (out, resumed) = (&order.out, args.resumed(&order.out));
    let reporter = Reporter::new(console, tools.corpus, &resumed);
    let prepared = order.prepare(tools, &reporter)?;
    let outcome = prepared.mint(&reporter);
    let outcome = outcome.map_err(|error| match Failure::from(error) {
        failure @ Failure::Environment(_) if reporter.seconds().is_some() => {
            Failure::Environment(anyhow::anyhow!(
                "{failure}\n{}once this is fixed, continue with: {resumed}",
                if has_finished_jobs(out) { "finished jobs are kept; " } else { "" },
            ))
        }
        other => other,
    })?;
    match outcome {
        Outcome::Complete => already_complete(order, console),
        Outcome::Release(minted) => report(&minted, &order.recipe, out, reporter.seconds(), console),
        Outcome::Shard(jobs) => {
            let (shard, place) =
                (args.shard.map_or_else(String::new, |shard| shard.to_string()), out.in_message());
            console.document(&json!({ "out": place.to_string(), "shard": shard, "jobs": jobs }))?;
            let jobs = base::count(jobs, "job");
            console.say(format_args!("shard {shard} of `{}`: {jobs}, in {place}", order.recipe.name));
            if order.secret.is_some() {
                console.say("keep the shard private: it contains winning episodes");
            }
            let secret = if order.secret.is_some() { " --secret FILE" } else { "" };
            let designs = if args.designs.is_some() { " --designs DIR" } else { "" };
            console.say(format_args!(
                "once all shards are made: arcade merge SHARD... --out DIR{designs}{secret}"
            ));
            Ok(true)
        }
    }
}

/// Reports on a release minted into the folder `out`.
pub(crate) fn report(
    minted: &Minted,
    recipe: &Recipe,
    out: &Path,
    seconds: Option<f64>,
    console: &Console,
) -> Answer {
    console.document(&json!({
        "out": paths::in_json(out),
        "root": minted.manifest.root,
        "games": minted.cards,
        "card": minted.card,
        "caveats": recipe.caveats(),
    }))?;
    match console.is_quiet() {
        true => console.say(in_short(minted, out)),
        false => console.say(summary(minted, recipe, out, seconds).trim_end()),
    }
    Ok(true)
}

/// Returns `true` if a recipe is a file rather than the name of an embedded recipe.
fn is_file(recipe: &Path) -> bool {
    recipe.extension().is_some_and(|extension| extension == "toml")
}

/// Finds the recipe specified by the user, and parses it with `read`.
pub(crate) fn find_recipe(
    path: &Path,
    read: impl Fn(&str) -> Result<Recipe, RecipeError>,
) -> Result<Recipe, Failure> {
    let name = path.to_string_lossy();
    let (shown, text) = if is_file(path) {
        (name.clone().into_owned(), input::text::read_text(path, MAX_RECIPE)?)
    } else if let Some(text) = embedded::recipe(&name) {
        (format!("seeds/{name}.toml"), text.to_owned())
    } else {
        let known = embedded::recipe_names();
        let near = engine::nearest(&name, known.iter().map(String::as_str));
        let file = path.with_extension("toml");
        let help = match near {
            _ if file.is_file() => format!("to read your file, pass its path: {}", shell::quoted(&file)),
            Some(near) if is_month(&name) && is_month(near) => format!(
                "did you mean `{near}`? The recipe of another month is a separate file: `arcade recipes show \
                 {near} > {file}`, change its `name` and `seed`, and `arcade release {file}`",
                file = file.in_message()
            ),
            Some(near) => format!("did you mean `{near}`? Or pass a .toml file"),
            None => format!("the recipes are {}; or pass a .toml file", known.join(", ")),
        };
        bail!("no recipe named `{name}`; {help}");
    };
    read(&text).map_err(|error| malformed!("{shown}: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    #[test]
    fn a_resumed_mint_keeps_all_flags() {
        let line = "release my.toml --parent p --secret s --beacon b --shard 1/2 --out o";
        let Line { args } = Line::parse_from(line.split(' '));
        assert_eq!(args.resumed(Path::new("o")), format!("arcade {line} --resume"));
    }
}
