//! `arcade release`: mints a benchmark.

mod outline;
mod probe;
mod progress;
mod sealed;
mod summary;

use crate::console::{Console, Stopwatch};
use crate::embedded;
use crate::failure::{Answer, Failure};
use crate::input;
use crate::interrupt;
use crate::marks;
use crate::memory::Bytes;
use crate::paths;
use crate::protected;
use crate::shell;
use crate::threads::bound_searches;
pub(crate) use crate::threads::in_pool;
use crate::trusted::warn_of_readers;
pub(crate) use outline::{forecast, left, words as forecast_words};
pub(crate) use progress::ProgressBars;
pub(crate) use sealed::{check_beacon, read as read_secret_file, secret_file};
use serde_json::json;
use snapshots::mint::{JobFolder, JobStore, Minted, Plan, Shard, lay_out, make_jobs};
use snapshots::version::CURRENT;
use snapshots::{
    Draft, HELD, MANIFEST_FILE, MAX_RECIPE, Recipe, RecipeError, Reveal, Secret, check_integrity, follow,
};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
pub(crate) use summary::sign_command;
use summary::{in_short, summary};
use trust::log::is_month;

/// Mints a snapshot of new, verified games and levels from a recipe: the same bytes from the same recipe, always.
///
/// The folder is complete or absent: until everything is minted, there is only `<out>.partial`, from which an
/// interrupted mint resumes with --resume. With --shard, only a slice is made, for `arcade merge`.
///
/// Example: arcade release starter --out my-benchmark
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A recipe's name, or a .toml file; `starter` if not given. With --reveal, the public folder of a sealed release
    #[arg(value_name = "RECIPE")]
    recipe: Option<PathBuf>,
    /// The snapshot's folder: absent or empty; `releases/<name>` if not given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Number of threads (default: all cores). The output is the same for any number
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
    /// Memory for all searches together, such as 4GiB: they wait for each other where they must. The output is the same for any size
    #[arg(long, value_name = "SIZE")]
    memory: Option<Bytes>,
    /// Make only the K-th of N slices
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Resume an interrupted mint
    #[arg(long)]
    resume: bool,
    /// Print what would be minted and its cost, but mint nothing. With --resume, the part that is left
    #[arg(long)]
    dry_run: bool,
    /// The folder of the previous release: nothing that it, or one before it, holds is minted again
    #[arg(long, value_name = "DIR", value_parser = crate::paths::release_parser())]
    parent: Option<PathBuf>,
    /// The secret of a sealed release, as made by --commit
    #[arg(long, value_name = "FILE")]
    secret: Option<PathBuf>,
    /// The value of the beacon that the recipe of a sealed release names, as a JSON file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["commit", "reveal"])]
    beacon: Option<PathBuf>,
    /// Draw a secret for this recipe, write it to the file --out, and print the commitment
    #[arg(long, conflicts_with_all = ["shard", "resume", "dry_run", "secret", "reveal"])]
    commit: bool,
    /// Join a sealed release with its held-back part, this folder, if both match their commitments
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
            ("--secret", self.secret.as_deref()),
            ("--beacon", self.beacon.as_deref()),
            ("--shard", shard.as_deref()),
            ("--out", Some(out)),
        ];
        for (option, value) in options {
            command.extend(value.into_iter().flat_map(|value| [option.into(), value.as_os_str().to_owned()]));
        }
        command.extend(self.limits());
        command.push("--resume".into());
        shell::command(command)
    }

    /// The flags of threads and memory.
    fn limits(&self) -> Vec<OsString> {
        threads_and_memory(self.jobs, self.memory)
    }
}

/// Returns the flags of threads and memory, for a command that resumes.
pub(crate) fn threads_and_memory(jobs: Option<usize>, memory: Option<Bytes>) -> Vec<OsString> {
    let jobs = jobs.map(|jobs| ["--jobs".to_owned(), jobs.to_string()]);
    let memory = memory.map(|memory| ["--memory".to_owned(), memory.to_string()]);
    jobs.into_iter().chain(memory).flatten().map(OsString::from).collect()
}

/// Seconds of one core from which a mint prints how to resume it.
pub(crate) const LONG: f64 = 30.0;

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    bound_searches(args.jobs, args.memory)?;
    if args.commit {
        return sealed::commit(args.recipe(), args.parent.as_deref(), args.out.as_deref(), console);
    }
    if let Some(held) = &args.reveal {
        let what = if args.solutions { Reveal::Solutions } else { Reveal::All };
        return sealed::reveal(args.recipe.as_deref(), held, what, args.out.as_deref(), console);
    }
    args.secret.iter().for_each(|file| warn_of_readers(file, console));
    let secret = args.secret.as_deref().map(sealed::read).transpose()?;
    let mut recipe = find_recipe(args.recipe(), |text| sealed::recipe(text, secret.as_ref()))?;
    if let Some(file) = &args.beacon {
        sealed::take_beacon(&mut recipe, file)?;
    }
    let corpus = embedded::corpus()?;
    match &args.parent {
        Some(parent) => follow(&mut recipe, parent)?,
        None if recipe.parent.is_some() => {
            bail!(
                "the recipe names a parent: give its folder with --parent, so that no content is minted twice"
            );
        }
        None => {}
    }
    let out = match (&args.out, args.shard) {
        (Some(out), _) => out.clone(),
        (None, None) => Path::new("releases").join(&recipe.name),
        (None, Some(_)) => bail!("--shard needs --out: a folder for the shard"),
    };
    protected::check(&out)?;
    if args.dry_run && recipe.seed.is_none() && secret.is_none() {
        return outline::without_secret(&recipe, &corpus, console);
    }
    let plan = Plan::new(&recipe, secret.as_ref(), &corpus)?.with_players(&marks::Players)?;
    check_supply(&plan, console)?;
    let jobs = args.shard.map_or_else(|| plan.jobs().to_vec(), |shard| shard.jobs(&plan));
    if args.resume && complete(&plan, &recipe, args.shard, &out)? {
        let place = out.display().to_string();
        console.document(&json!({ "out": place, "complete": true }))?;
        console.say(format_args!("already complete: {place}"));
        return Ok(true);
    }
    if jobs.is_empty() {
        console.remark("note: there are more shards than jobs: this shard is empty");
    }
    if args.dry_run {
        let asked = outline::Asked { jobs: &jobs, out: &out, resume: args.resume };
        return in_pool(args.jobs, || outline::outline(&plan, &corpus, &asked, console))?;
    }
    // Check the place to write to before minutes of minting.
    let mut draft = if args.resume { Draft::resume(&out) } else { Draft::create(&out) }?;
    match (plan.is_sealed(), args.shard) {
        (true, Some(_)) => draft.keep_secret()?,
        (true, None) => draft.keep_private()?,
        (false, _) => {}
    }
    let minted = mint(args, &plan, &jobs, secret.as_ref(), draft, &out, console);
    minted.map_err(|failure| match failure {
        Failure::Environment(_) => Failure::Environment(anyhow::anyhow!(
            "{failure}\n{}once this is fixed, continue with: {}",
            if has_finished_jobs(&out) { "finished jobs are kept; " } else { "" },
            args.resumed(&out)
        )),
        other => other,
    })
}

/// Refuses a recipe that asks for more games than can be made, and prints a note on one that asks for almost as many.
fn check_supply(plan: &Plan<'_>, console: &Console) -> Result<(), Failure> {
    if let Some(most) = plan.supply()? {
        console.remark(format_args!(
            "note: there are rules for {most} new games at most, and some candidates fail: fewer games may pass than the recipe asks for"
        ));
    }
    Ok(())
}

/// Returns `true` if `out` already holds the result of this plan, or of this shard of it.
fn complete(plan: &Plan<'_>, recipe: &Recipe, shard: Option<Shard>, out: &Path) -> Result<bool, Failure> {
    if let Some(shard) = shard {
        return shard.is_whole(plan, out).map_err(Failure::from);
    }
    let root = if plan.is_sealed() { out.join("public") } else { out.to_owned() };
    if paths::metadata(&root.join(MANIFEST_FILE))?.is_none() {
        return Ok(false);
    }
    let found = check_integrity(&root)?;
    let minted_from: Option<Recipe> = serde_json::from_value(found.manifest.recipe.clone()).ok();
    let minted_by = found.manifest.minted_by();
    Ok(found.problems.is_empty()
        && minted_from.as_ref() == Some(recipe)
        && (minted_by.generation, minted_by.semantics) == (CURRENT.generation, CURRENT.semantics))
}

/// Returns `true` if the unfinished folder of `out` holds the result of a job.
fn has_finished_jobs(out: &Path) -> bool {
    let jobs = Draft::jobs_of(out).and_then(|jobs| fs::read_dir(jobs).ok());
    let is_result = |entry: fs::DirEntry| entry.path().extension().is_some_and(|end| end == "json");
    jobs.is_some_and(|jobs| jobs.flatten().any(is_result))
}

/// Runs the jobs, and makes the shard or the release of them.
fn mint(
    args: &Args,
    plan: &Plan<'_>,
    jobs: &[snapshots::mint::Job],
    secret: Option<&Secret>,
    draft: Draft,
    out: &Path,
    console: &Console,
) -> Answer {
    let digest = plan.digest()?;
    let mut store = JobFolder::open(&draft.jobs(), digest)?;
    if plan.is_sealed() {
        store.keep_secret()?;
    }
    let (cost, _) = forecast(plan, &left(plan, jobs, &store)?, &embedded::corpus()?);
    if cost.median >= LONG {
        console.remark(format_args!("if interrupted, continue with: {}", args.resumed(out)));
    }
    console.remark(format_args!("minting takes {}", forecast_words(cost)));
    interrupt::watch(|| (), format!("interrupted; continue with: {}", args.resumed(out)));
    let bars = ProgressBars::new(console);
    let started = Stopwatch::start();
    in_pool(args.jobs, || make_jobs(plan, jobs, &store, &bars))??;
    bars.finish();
    interrupt::defer();
    if let Some(shard) = args.shard {
        shard.write(plan, &store, &draft)?;
        draft.commit()?;
        let place = out.display().to_string();
        console.document(&json!({ "out": place, "shard": shard.to_string(), "lots": jobs.len() }))?;
        let jobs = crate::counted::count(jobs.len(), "job");
        console.say(format_args!("shard {shard} of `{}`: {jobs}, in {place}", plan.recipe.name));
        if plan.is_sealed() {
            console.say("keep it private: it contains winning episodes");
        }
        let secret = if plan.is_sealed() { " --secret FILE" } else { "" };
        console.say(format_args!("once all shards are made: arcade merge SHARD... --out DIR{secret}"));
        return Ok(true);
    }
    let finished = FinishedMint { plan, secret, store: &store, out };
    finished.publish(draft, Some(started.seconds()), args.jobs, console)
}

/// A release whose jobs are all finished.
pub(crate) struct FinishedMint<'a> {
    pub(crate) plan: &'a Plan<'a>,
    pub(crate) secret: Option<&'a Secret>,
    pub(crate) store: &'a dyn JobStore,
    pub(crate) out: &'a Path,
}

impl FinishedMint<'_> {
    /// Lays the release out, publishes it and reports it.
    pub(crate) fn publish(
        &self,
        draft: Draft,
        seconds: Option<f64>,
        jobs: Option<usize>,
        console: &Console,
    ) -> Answer {
        let is_sealed = self.plan.is_sealed();
        let place = |path: &str| match is_sealed && !path.starts_with(HELD) {
            true => format!("public/{path}"),
            false => path.to_owned(),
        };
        let minted = in_pool(jobs, || {
            let mut write = |path: &str, content: &[u8]| draft.write(&place(path), content);
            lay_out(self.plan, self.secret, self.store, embedded::lockfile(), &mut write)
        })??;
        commit(draft, &minted, place)?;
        console.document(&json!({
            "out": self.out.display().to_string(),
            "root": minted.manifest.root,
            "games": minted.cards,
            "card": minted.card,
            "caveats": self.plan.recipe.caveats(),
        }))?;
        match console.is_quiet() {
            true => console.say(in_short(&minted, self.out)),
            false => console.say(summary(&minted, self.plan.recipe, self.out, seconds).trim_end()),
        }
        Ok(true)
    }
}

/// Completes a draft, which holds the files of the release, by its manifest and its papers; `place` maps their paths.
pub(crate) fn commit(draft: Draft, minted: &Minted, place: impl Fn(&str) -> String) -> Result<(), Failure> {
    draft.write(&place(MANIFEST_FILE), &minted.manifest.to_bytes()?)?;
    for (path, text) in minted.papers() {
        draft.write(&place(&path), text.as_bytes())?;
    }
    Ok(draft.commit()?)
}

/// Returns `true` if a recipe is a file, not the name of one that the binary carries.
fn is_file(recipe: &Path) -> bool {
    recipe.extension().is_some_and(|extension| extension == "toml")
}

/// Finds the recipe that the user names, read by `read`.
pub(crate) fn find_recipe(
    path: &Path,
    read: impl Fn(&str) -> Result<Recipe, RecipeError>,
) -> Result<Recipe, Failure> {
    let name = path.to_string_lossy();
    let (shown, text) = if is_file(path) {
        (name.clone().into_owned(), input::read_text(path, MAX_RECIPE)?)
    } else if let Some(text) = embedded::recipe(&name) {
        (format!("seeds/{name}.toml"), text.to_owned())
    } else {
        let known = embedded::recipe_names();
        let near = engine::nearest(&name, known.iter().map(String::as_str));
        let file = path.with_extension("toml");
        let help = match near {
            _ if file.is_file() => format!("to read your file, name it: {}", shell::quoted(&file)),
            Some(near) if is_month(&name) && is_month(near) => format!(
                "did you mean `{near}`? The recipe of another month is a file of its own: `arcade recipes show {near} > \
                 {file}`, change its `name` and `seed`, and `arcade release {file}`",
                file = file.display()
            ),
            Some(near) => format!("did you mean `{near}`? Or name a .toml file"),
            None => format!("there are {}, or name a .toml file", known.join(", ")),
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
        let line =
            "release my.toml --parent p --secret s --beacon b --shard 1/2 --out o --jobs 2 --memory 2GiB";
        let Line { args } = Line::parse_from(line.split(' '));
        assert_eq!(args.resumed(Path::new("o")), format!("arcade {line} --resume"));
    }
}
