//! `cargo xtask conformance` compares this engine with the reference engine.

mod compare;
mod trace;

use anyhow::{Context, bail};
use compare::{Difference, compare};
use engine::{Chance, Game, Outcome, layout};
use itertools::Itertools;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use trace::Trace;

/// Replays recorded traces of the reference engine, and compares every field of every tick.
///
/// Prints the first divergence of every episode that differs. The last line is `identical: N of M episodes`.
///
/// Example: cargo xtask conformance --games gvgai/games --traces gvgai/traces --game zelda
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of games: a folder per game, with game.txt (or game.vgdl) and lvl0.txt …, or NAME.txt and NAME_lvl0.txt …
    #[arg(long, value_name = "DIR")]
    games: PathBuf,
    /// Folder with one folder of traces per game: *.jsonl.gz
    #[arg(long, value_name = "DIR")]
    traces: PathBuf,
    /// Only this game; may be given more than once
    #[arg(long = "game", value_name = "NAME")]
    only: Vec<String>,
    /// Print one JSON document instead
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    identical: usize,
    episodes: usize,
    ticks: usize,
    differing: Vec<Episode>,
}

#[derive(Serialize)]
struct Episode {
    trace: String,
    /// The reason why the episode could not be played, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    difference: Option<Difference>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let traces = find_traces(args)?;
    let names = traces.iter().map(|(game, _)| game).dedup();
    let games = names.map(|name| Ok((name, Subject::read(&args.games, name)?)));
    let games = games.collect::<anyhow::Result<BTreeMap<_, _>>>()?;
    let outcomes: Vec<_> =
        traces.par_iter().map(|(name, path)| replay(args, &games[name], name, path)).collect();

    let mut report = Report { identical: 0, episodes: traces.len(), ticks: 0, differing: Vec::new() };
    for outcome in outcomes {
        match outcome? {
            (ticks, None) => {
                report.identical += 1;
                report.ticks += ticks;
            }
            (_, Some(episode)) => report.differing.push(episode),
        }
    }
    match args.json {
        true => println!("{}", serde_json::to_string_pretty(&report)?),
        false => say(&report),
    }
    if report.identical < report.episodes {
        bail!("{} of {} episodes differ", report.differing.len(), report.episodes);
    }
    Ok(())
}

fn say(report: &Report) {
    for episode in &report.differing {
        println!("{}: differs", episode.trace);
        if let Some(refused) = &episode.refused {
            println!("  {refused}");
        }
        if let Some(difference) = &episode.difference {
            println!("{}", difference.to_string().trim_end());
        }
    }
    println!("identical: {} of {} episodes", report.identical, report.episodes);
}

/// Returns all traces, sorted. Each trace is identified by the name of its game and its path.
fn find_traces(args: &Args) -> anyhow::Result<Vec<(String, PathBuf)>> {
    let mut names = sorted_entries(&args.traces)?;
    names.retain(|path| path.is_dir());
    let name_of = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    for wanted in &args.only {
        if !names.iter().any(|path| name_of(path) == *wanted) {
            let known: Vec<String> = names.iter().map(|path| name_of(path)).collect();
            let near = engine::nearest(wanted, known.iter().map(String::as_str));
            let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            bail!("{} has no game `{wanted}`{help}", args.traces.display());
        }
    }
    let mut traces = Vec::new();
    for folder in names {
        let game = name_of(&folder);
        if args.only.is_empty() || args.only.contains(&game) {
            let mut files = sorted_entries(&folder)?;
            files.retain(|path| [".jsonl.gz", ".jsonl"].iter().any(|end| name_of(path).ends_with(end)));
            traces.extend(files.into_iter().map(|path| (game.clone(), path)));
        }
    }
    if traces.is_empty() {
        let folder = args.traces.display();
        bail!("{folder}: contains no traces; expected <game>/*.jsonl.gz");
    }
    Ok(traces)
}

/// Returns a folder's entries, sorted by name.
fn sorted_entries(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read `{}`", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    paths.sort();
    Ok(paths)
}

/// Reads a game file as text.
fn read(path: &Path) -> anyhow::Result<String> {
    fs::read_to_string(path).with_context(|| format!("cannot read `{}`", path.display()))
}

/// A game with its compiled rules, or the reason why the game does not compile.
struct Subject {
    source: PathBuf,
    game: Result<Game, String>,
}

impl Subject {
    /// Reads the game with the given name, which is either a folder or a file with its levels in the same
    /// folder.
    fn read(games: &Path, name: &str) -> anyhow::Result<Subject> {
        let places =
            [name.to_owned(), format!("{name}.vgdl"), format!("{name}.txt")].map(|name| games.join(name));
        let Some(place) = places.iter().find(|place| place.exists()) else {
            bail!(
                "{}: no folder or file of the game `{name}`, but there are traces of this game",
                games.display()
            );
        };
        let source = match place.is_dir() {
            true => {
                let names = file_names(place)?;
                let found = layout::games(names.iter().map(String::as_str));
                let [game] = &found[..] else {
                    bail!("{}: contains {} games, but should contain one", place.display(), found.len())
                };
                place.join(&game.source)
            }
            false => place.clone(),
        };
        let game = Game::from_source_as_reference(&read(&source)?).map_err(|problems| {
            let first = problems.0.first().map_or(String::new(), |first| first.message.clone());
            format!("{} does not load; the first problem of {}: {first}", source.display(), problems.0.len())
        });
        Ok(Subject { source, game })
    }

    /// Returns the path of the file of the given level.
    fn level(&self, number: usize) -> anyhow::Result<PathBuf> {
        let names = file_names(self.source.parent().unwrap_or(Path::new(".")))?;
        let own = self.source.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let levels = layout::levels(own, names.iter().map(String::as_str));
        match levels.into_iter().find(|(known, _)| *known == number) {
            Some((_, name)) => Ok(self.source.with_file_name(name)),
            None => bail!("{}: there is no level {number}", self.source.display()),
        }
    }
}

/// Returns the names of the files in a folder.
fn file_names(folder: &Path) -> anyhow::Result<Vec<String>> {
    let files = sorted_entries(folder)?.into_iter().filter(|path| !path.is_dir());
    Ok(files.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect())
}

/// Replays a trace. Returns the number of ticks played and, if the engine differs from the trace, the
/// episode's entry in the report.
fn replay(
    args: &Args,
    subject: &Subject,
    name: &str,
    path: &Path,
) -> anyhow::Result<(usize, Option<Episode>)> {
    let trace = Trace::read(path).map_err(|error| anyhow::anyhow!("{}: {error}", path.display()))?;
    let shown = path.strip_prefix(&args.traces).unwrap_or(path).display().to_string();
    let refused =
        |why: String| Ok((0, Some(Episode { trace: shown.clone(), refused: Some(why), difference: None })));
    if trace.header.game != name {
        bail!("{}: a trace of `{}` in the folder of `{name}`", path.display(), trace.header.game);
    }
    // A game that the reference could not load must also fail to load in this engine, or stop before it
    // starts.
    let broken = trace.header.engine_error.is_some();
    let game = match &subject.game {
        Ok(game) => game,
        Err(_) if broken => return Ok((0, None)),
        Err(why) => return refused(why.clone()),
    };
    let file = subject.level(trace.header.level as usize)?;
    let level = match game.level(&read(&file)?) {
        Ok(level) => level,
        Err(_) if broken => return Ok((0, None)),
        Err(problems) => return refused(format!("{} does not load: {problems}", file.display())),
    };
    if broken {
        return match game.start_with(&level, Chance::from_java(trace.header.seed)).outcome() {
            Outcome::Stopped(_) => Ok((0, None)),
            _ => refused("the reference could not load the level".to_owned()),
        };
    }
    let difference = compare(game, &level, &trace);
    let episode =
        difference.map(|found| Episode { trace: shown.clone(), refused: None, difference: Some(found) });
    Ok((trace.ticks.len(), episode))
}
