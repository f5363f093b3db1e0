//! `cargo xtask survey`: measures the levels of the constructive generator, game by game.

mod judged;
mod table;

use crate::levels::load;
use agents::PortfolioConfig;
use anyhow::{Context, bail};
use cpu_time::ThreadTime;
use engine::{Analysis, Level, Seed};
use generators::Generator;
use generators::levels::{ConstructiveLevels, Examples, LevelConfig, LevelSimilarity};
use judged::{Judge, Judged};
use rayon::prelude::*;
use render::{Looks, Style};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use table::Row;

/// Makes levels for every game of a folder with the constructive generator and measures them: made, winnable with a
/// witness, won by doing nothing or at random, complete, of the size and cover of the game's own levels, fast,
/// different.
///
/// Example: cargo xtask survey --games corpora --count 5 --png sheets
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of game folders, each with game.txt or game.vgdl and lvl*.txt; several may be given
    #[arg(long, value_name = "DIR", required = true)]
    games: Vec<PathBuf>,
    /// Only these games
    #[arg(long, value_name = "NAME")]
    game: Vec<String>,
    /// Levels for each game
    #[arg(long, value_name = "N", default_value_t = 20)]
    count: u64,
    /// Difficulty from 0.0, the easiest, to 1.0, the hardest
    #[arg(long, value_name = "D", default_value_t = LevelConfig::default().difficulty)]
    difficulty: f64,
    /// Forward-model calls for the witness of a level; 0: levels are not solved
    #[arg(long, value_name = "CALLS", default_value_t = 1_500_000)]
    budget: u64,
    /// Episodes of doing nothing, and of random play, for a level
    #[arg(long, value_name = "N", default_value_t = 20)]
    plays: u64,
    /// Text that all seeds are derived from
    #[arg(long, value_name = "TEXT", default_value = "survey")]
    seed: String,
    /// Learn nothing from the games' own levels
    #[arg(long)]
    unlearnt: bool,
    /// Measure the games' own levels instead
    #[arg(long)]
    own: bool,
    /// Threads; all cores if not given. Changes no result
    #[arg(long, value_name = "N", default_value_t = 0)]
    jobs: usize,
    /// One line per level
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Folder for a contact sheet of each game
    #[arg(long, value_name = "DIR")]
    png: Option<PathBuf>,
}

/// A game with its own levels.
struct Subject {
    name: String,
    analysis: Analysis,
    own: Vec<Level>,
}

/// A level, or the reason why there is none, with the milliseconds that making it took.
struct Made {
    level: Result<Level, String>,
    milliseconds: f64,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let subjects = subjects(args)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build()?;
    let mut rows = Vec::new();
    let mut csv = String::from(Judged::HEAD);
    println!("{}", Row::HEAD);
    for subject in &subjects {
        let made: Vec<Made> = if args.own {
            let own = subject.own.iter().cloned();
            own.map(|level| Made { level: Ok(level), milliseconds: 0.0 }).collect()
        } else {
            make(subject, args)
        };
        let config = PortfolioConfig { budget: args.budget, ..PortfolioConfig::default() };
        let likeness = LevelSimilarity::of(&subject.analysis);
        let judge = Judge {
            analysis: &subject.analysis,
            likeness: &likeness,
            own: &subject.own,
            config,
            plays: args.plays,
            seed: Seed::from_text(&args.seed).child(&subject.name, 0),
        };
        let judged: Vec<Judged> = pool.install(|| {
            made.par_iter().enumerate().map(|(number, made)| judge.judge(number, made)).collect()
        });
        let known = subject.own.iter().filter(|_| !args.own).map(|own| likeness.digest(own));
        let row = Row::of(&subject.name, &made, &judged, &known.collect::<Vec<_>>());
        println!("{row}");
        rows.push(row);
        for (number, judged) in judged.iter().enumerate() {
            csv.push_str(&judged.line(&subject.name, number));
        }
        if let Some(folder) = &args.png {
            draw(subject, &made, &judged, folder)?;
        }
    }
    println!("{}", Row::together(&rows));
    if let Some(path) = &args.csv {
        fs::write(path, csv).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

fn subjects(args: &Args) -> anyhow::Result<Vec<Subject>> {
    let mut folders: Vec<PathBuf> = Vec::new();
    for games in &args.games {
        for entry in fs::read_dir(games).with_context(|| games.display().to_string())? {
            folders.push(entry?.path());
        }
    }
    folders.sort();
    let mut subjects = Vec::new();
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if args.game.is_empty() || args.game.contains(&name) {
            let (game, own) = load(&folder)?;
            subjects.push(Subject { name, analysis: Analysis::of(&game), own });
        }
    }
    if subjects.is_empty() {
        bail!("no such game in the folders named by --games");
    }
    Ok(subjects)
}

/// Makes the levels of one game on one thread, so that the time is that of one level.
fn make(subject: &Subject, args: &Args) -> Vec<Made> {
    let own = if args.unlearnt { &[] } else { &subject.own[..] };
    let examples = Examples::of(subject.analysis.game(), own);
    let like = examples.map_or_else(LevelConfig::default, |examples| LevelConfig::like(Arc::new(examples)));
    let config = LevelConfig { difficulty: args.difficulty, ..like };
    let seed = Seed::from_text(&args.seed).child(&subject.name, 1);
    let generator = match ConstructiveLevels::new(subject.analysis.game(), config) {
        Ok(generator) => generator,
        Err(error) => {
            println!("{}: {error}", subject.name);
            return Vec::new();
        }
    };
    let one = |number: u64| {
        let clock = ThreadTime::now();
        let level = generator.generate(seed.child("level", number)).map_err(|error| error.to_string());
        Made { level, milliseconds: clock.elapsed().as_secs_f64() * 1000.0 }
    };
    (0..args.count).map(one).collect()
}

/// The number of levels in a row of a sheet.
const COLUMNS: usize = 5;
/// The longer side of a level on a sheet, in pixels.
const SIDE: u32 = 300;

fn draw(subject: &Subject, made: &[Made], judged: &[Judged], folder: &Path) -> anyhow::Result<()> {
    let game = subject.analysis.game();
    let looks = Looks::of(&subject.analysis);
    let mut entries = Vec::new();
    for (number, (made, judged)) in made.iter().zip(judged).enumerate() {
        let Ok(level) = &made.level else { continue };
        let state = game.start(level, Seed::from_text("picture"));
        let picture = render::picture(&looks, &state, &Style::bare(20))?;
        entries.push((picture, format!("{number}: {}", judged.caption())));
    }
    if entries.is_empty() {
        return Ok(());
    }
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let path = folder.join(format!("{}.png", subject.name));
    let bytes = render::png(&render::sheet(&entries, COLUMNS, SIDE)?)?;
    fs::write(&path, bytes).with_context(|| path.display().to_string())
}
