//! `cargo xtask survey` surveys the levels that the constructive generator creates for each game.

use super::folders;
use super::missing::missing;
use crate::levels::{load, name_of};
use anyhow::{Context, bail};
use base::Seed;
use cpu_time::ThreadTime;
use engine::{Analysis, Level};
use forge::Tally;
use forge::levels::report::{LevelSetReport, Sample};
use forge::survey::LevelSurvey;
use generators::Generator;
use generators::levels::{ConstructiveLevels, Examples, LevelConfig};
use render::{Looks, Style};
use report::{Share, Table, TableCell};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use validators::{Criteria, Criterion, CriterionSet};

/// Generates levels for every game in a folder with the constructive generator, and judges the levels as
/// `arcade generate levels --report` does.
///
/// The report shows whether the levels are winnable with a witness, and whether they are won by doing nothing
/// or at random. It also shows whether they are similar in size and cover to the game's own levels, are
/// generated quickly, and differ from each other.
///
/// Example: cargo xtask survey --games corpora --count 5 --png sheets
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of game folders, each with game.txt or game.vgdl and lvl*.txt; may be given more than once
    #[arg(long, value_name = "DIR", required = true)]
    games: Vec<PathBuf>,
    /// Only these games
    #[arg(long, value_name = "NAME")]
    game: Vec<String>,
    /// Number of levels per game
    #[arg(long, value_name = "N", default_value_t = 20)]
    count: u64,
    /// Difficulty from 0.0, the easiest, to 1.0, the hardest
    #[arg(long, value_name = "D", default_value_t = LevelConfig::default().difficulty)]
    difficulty: f64,
    /// Forward-model calls for the witness of a level; with 0, levels are not solved
    #[arg(long, value_name = "CALLS", default_value_t = 1_500_000)]
    budget: u64,
    /// Number of episodes of doing nothing, and of random play, per level
    #[arg(long, value_name = "N", default_value_t = 20)]
    plays: u32,
    /// Text from which all seeds are derived
    #[arg(long, value_name = "TEXT", default_value = "survey")]
    seed: String,
    /// Learn nothing from the games' own levels
    #[arg(long)]
    unlearnt: bool,
    /// Judge the games' own levels instead
    #[arg(long)]
    own: bool,
    /// Number of threads, or 0 for all cores. Does not affect the results
    #[arg(long, value_name = "N", default_value_t = 0)]
    jobs: usize,
    /// Folder for one table per game, with one line per level
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
    /// Folder for one contact sheet per game
    #[arg(long, value_name = "DIR")]
    png: Option<PathBuf>,
}

/// The columns with fractions, each with its section and key in the report on levels.
const SHARES: [(&str, &str, &str); 7] = [
    ("solved", "solvability", "solved"),
    ("impossible", "solvability", "impossible"),
    ("unknown", "solvability", "unknown"),
    ("not for nothing", "triviality", "both_levels"),
    ("well-formed", "validity", "well_formed"),
    ("unique", "diversity", "unique"),
    ("copies", "novelty", "copies"),
];

/// The measures for which new levels should lie within the range of the game's own levels.
const FIT: [&str; 3] = ["columns", "rows", "cover"];

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build()?;
    let shares = SHARES.map(|(name, ..)| name);
    let columns =
        [&["game", "levels", "made", "whole"][..], &shares, &FIT, &["maximum ms", "missing"]].concat();
    let note = "Percentages of the levels that were made; columns, rows and cover: within the range of \
                the game's own levels.";
    let mut table = Table::new("survey", "Levels from the constructive generator", note, &columns);
    let (mut games, mut sums) = (0, vec![[0, 0]; SHARES.len() + FIT.len()]);
    for folder in args.games.iter().map(|games| folders(games)).collect::<Result<Vec<_>, _>>()?.concat() {
        let name = name_of(&folder);
        if !args.game.is_empty() && !args.game.contains(&name) {
            continue;
        }
        games += 1;
        let (game, own) = load(&folder)?;
        let analysis = Analysis::of(&game);
        let (made, milliseconds) =
            if args.own { (own.clone(), 0.0) } else { make(&name, &analysis, &own, args)? };
        let report = pool.install(|| judge(&name, &analysis, &made, &own, args))?;
        let lacks: Vec<Vec<String>> = made.iter().map(|level| missing(&analysis, level)).collect();
        let whole = lacks.iter().filter(|names| names.is_empty()).count() as u64;
        let shares = SHARES.iter().map(|(_, section, key)| report.set.share(section, key));
        let shares: Vec<Option<Share>> = shares.chain(FIT.iter().map(|name| within(&report, name))).collect();
        for (sum, share) in sums.iter_mut().zip(&shares) {
            *sum = share.map_or(*sum, |share| [sum[0] + share.count, sum[1] + share.of]);
        }
        let percent = shares.iter().map(|share| percent(share.map(|share| share.share())));
        let asked = if args.own { own.len() } else { args.count as usize };
        let head = [
            TableCell::text(&*name),
            TableCell::Count(asked as u64),
            TableCell::Count(made.len() as u64),
            TableCell::Count(whole),
        ];
        let lacking: BTreeSet<String> = lacks.into_iter().flatten().collect();
        let lacking = lacking.into_iter().collect::<Vec<_>>().join(", ");
        let tail = [TableCell::number(milliseconds, 1), TableCell::text(lacking)];
        table.push(head.into_iter().chain(percent).chain(tail).collect());
        if let (Some(folder), Some(levels)) = (&args.csv, report.set.tables.last()) {
            write(folder, &format!("{name}.csv"), levels.to_csv().as_bytes())?;
        }
        if let Some(folder) = &args.png {
            draw(&name, &analysis, &made, &report, folder)?;
        }
    }
    if games == 0 {
        bail!("the folders given by --games do not contain this game");
    }
    let all = sums.iter().map(|&[count, of]| percent((of > 0).then(|| count as f64 / of as f64)));
    let head = [
        TableCell::text(format!("{games} games")),
        TableCell::Missing,
        TableCell::Missing,
        TableCell::Missing,
    ];
    table.push(head.into_iter().chain(all).chain([TableCell::Missing, TableCell::text("")]).collect());
    print!("{}", table.to_markdown());
    Ok(())
}

/// Returns the fraction of new levels for which a measure lies within the range of the game's own levels.
fn within(report: &LevelSetReport, measure: &str) -> Option<Share> {
    report.fits.iter().find(|fit| fit.measure == measure).map(|fit| fit.within)
}

fn percent(share: Option<f64>) -> TableCell {
    TableCell::number(share.map(|share| 100.0 * share), 0)
}

/// Returns the levels generated for one game, and the maximum time that one of them took, in milliseconds.
/// Uses one thread, so that the time covers a single level.
fn make(name: &str, analysis: &Analysis, own: &[Level], args: &Args) -> anyhow::Result<(Vec<Level>, f64)> {
    let own = if args.unlearnt { &[] } else { own };
    let examples = Examples::of(analysis.game(), own);
    let like = examples.map_or_else(LevelConfig::default, |examples| LevelConfig::like(Arc::new(examples)));
    let config = LevelConfig { difficulty: args.difficulty, ..like };
    let seed = Seed::from_text(&args.seed).child(name, 1);
    let (mut levels, mut most) = (Vec::new(), 0.0);
    match ConstructiveLevels::new(analysis.game(), config) {
        Ok(generator) => {
            for number in 0..args.count {
                let clock = ThreadTime::now();
                let level = generator.generate(seed.child("level", number));
                most = f64::max(most, clock.elapsed().as_secs_f64() * 1000.0);
                match level {
                    Ok(level) => levels.push(level),
                    Err(error) => println!("{name}, level {number}: {error}"),
                }
            }
        }
        Err(error) => println!("{name}: {error}"),
    }
    Ok((levels, most))
}

/// Returns the report on the generated levels.
fn judge(
    name: &str,
    analysis: &Analysis,
    made: &[Level],
    own: &[Level],
    args: &Args,
) -> anyhow::Result<LevelSetReport> {
    let ask = [Criterion::WellFormed, Criterion::NotIdle, Criterion::NotRandom, Criterion::Winnable];
    let ask = if args.budget == 0 { &ask[..3] } else { &ask[..] };
    let criteria = Criteria {
        ask: CriterionSet::of(ask),
        budget: args.budget.max(1),
        idle_plays: args.plays,
        random_plays: args.plays,
        ..Criteria::default()
    };
    let seed = Seed::from_text(&args.seed).child(name, 0);
    let survey = LevelSurvey::new(analysis, &criteria, seed)?.without_ladder();
    let judge = |levels: &[Level]| {
        survey.judge(&levels.iter().map(|level| (level.clone(), None)).collect::<Vec<_>>())
    };
    let levels = judge(made);
    let examples = if args.own { Vec::new() } else { judge(own) };
    let sample = Sample {
        analysis,
        method: "constructive",
        levels: &levels,
        examples: &examples,
        pool: &[],
        cost: &Tally::default(),
    };
    Ok(LevelSetReport::of(&sample))
}

/// The number of levels per row of a contact sheet.
const COLUMNS: usize = 5;
/// The length of a level's longer side on a contact sheet, in pixels.
const SIDE: u32 = 300;

fn draw(
    name: &str,
    analysis: &Analysis,
    made: &[Level],
    report: &LevelSetReport,
    folder: &Path,
) -> anyhow::Result<()> {
    let looks = Looks::of(analysis);
    let mut entries = Vec::new();
    for (number, (level, row)) in made.iter().zip(&report.levels).enumerate() {
        let state = analysis.game().start(level, Seed::from_text("picture"));
        let picture = render::picture(&looks, &state, &Style::bare(20))?;
        entries.push((picture, format!("{number}: {}", row.remark(false))));
    }
    if entries.is_empty() {
        return Ok(());
    }
    write(folder, &format!("{name}.png"), &render::png(&render::sheet(&entries, COLUMNS, SIDE)?)?)
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let path = folder.join(name);
    fs::write(&path, bytes).with_context(|| path.display().to_string())
}
