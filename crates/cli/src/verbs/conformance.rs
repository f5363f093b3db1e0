//! `arcade conformance`: comparison of this engine with the reference.

use crate::conformance::{Difference, Trace, compare};
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::{self, GameInput};
use engine::{Chance, Game, Outcome};
use itertools::Itertools;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Replays recorded traces of the reference engine and compares every field of every tick.
///
/// Prints the first divergence of every differing episode; the last line is `identical: N of M episodes`.
///
/// Example: arcade conformance --games gvgai/games --traces gvgai/traces --game zelda
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of games: a folder per game, with game.txt (or game.vgdl) and lvl0.txt …, or NAME.txt and NAME_lvl0.txt …
    #[arg(long, value_name = "DIR")]
    games: PathBuf,
    /// Folder with one folder of traces per game: *.jsonl.gz
    #[arg(long, value_name = "DIR")]
    traces: PathBuf,
    /// Only this game; may be given several times
    #[arg(long = "game", value_name = "NAME")]
    only: Vec<String>,
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
    /// The reason why the episode could not be played at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    difference: Option<Difference>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let traces = find_traces(args)?;
    let names = traces.iter().map(|(game, _)| game).dedup();
    let games = names.map(|name| Ok((name, load_game(&args.games, name)?)));
    let games = games.collect::<Result<BTreeMap<_, _>, Failure>>()?;
    let bar = console.progress(traces.len() as u64, "replaying");
    let outcomes: Vec<_> = traces
        .par_iter()
        .map(|(name, path)| replay(args, &games[name], name, path))
        .inspect(|_| bar.inc(1))
        .collect();
    bar.finish_and_clear();

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
    for episode in &report.differing {
        console.say(format_args!("{}: differs", episode.trace));
        if let Some(refused) = &episode.refused {
            console.say(format_args!("  {refused}"));
        }
        if let Some(difference) = &episode.difference {
            console.say(difference.to_string().trim_end());
        }
    }
    console.document(&report)?;
    console.say(format_args!("identical: {} of {} episodes", report.identical, report.episodes));
    Ok(report.identical == report.episodes)
}

/// Returns game and path of every trace, sorted.
fn find_traces(args: &Args) -> Result<Vec<(String, PathBuf)>, Failure> {
    let mut names = input::sorted_entries(&args.traces)?;
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
            let mut files = input::sorted_entries(&folder)?;
            files.retain(|path| [".jsonl.gz", ".jsonl"].iter().any(|end| name_of(path).ends_with(end)));
            traces.extend(files.into_iter().map(|path| (game.clone(), path)));
        }
    }
    if traces.is_empty() {
        let folder = args.traces.display();
        bail!("{folder}: no trace in it; expected <game>/*.jsonl.gz");
    }
    Ok(traces)
}

/// A game with its rules, or the reason why it does not compile.
struct Subject {
    input: GameInput,
    game: Result<Game, String>,
}

/// Returns the game of that name: a folder, or a file with its levels beside it.
fn load_game(games: &Path, name: &str) -> Result<Subject, Failure> {
    let places =
        [name.to_owned(), format!("{name}.vgdl"), format!("{name}.txt")].map(|name| games.join(name));
    let Some(place) = places.iter().find(|place| place.exists()) else {
        bail!("{}: no folder or file of the game `{name}`, but there are traces of it", games.display());
    };
    let input = input::game(&place.display().to_string())?;
    let game = Game::from_source_as_reference(&input.source.text).map_err(|problems| {
        let first = problems.0.first().map_or(String::new(), |first| first.message.clone());
        format!("{} does not load; the first problem of {}: {first}", input.source.name, problems.0.len())
    });
    Ok(Subject { input, game })
}

/// Returns the ticks played and, if the engine differs, the episode's entry in the report.
fn replay(
    args: &Args,
    subject: &Subject,
    name: &str,
    path: &Path,
) -> Result<(usize, Option<Episode>), Failure> {
    let trace = Trace::read(path).map_err(|error| malformed!("{}: {error}", path.display()))?;
    let shown = path.strip_prefix(&args.traces).unwrap_or(path).display().to_string();
    let refused =
        |why: String| Ok((0, Some(Episode { trace: shown.clone(), refused: Some(why), difference: None })));
    if trace.header.game != name {
        bail!("{}: a trace of `{}` in the folder of `{name}`", path.display(), trace.header.game);
    }
    // A game that the reference could not load must not load here either, or must stop before it starts.
    let broken = trace.header.engine_error.is_some();
    let game = match &subject.game {
        Ok(game) => game,
        Err(_) if broken => return Ok((0, None)),
        Err(why) => return refused(why.clone()),
    };
    let named = subject.input.numbered_level(trace.header.level as usize)?;
    let level = match game.level(&named.text) {
        Ok(level) => level,
        Err(_) if broken => return Ok((0, None)),
        Err(problems) => return refused(format!("{} does not load: {problems}", named.name)),
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
