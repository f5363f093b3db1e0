//! `arcade generate levels`: generates new levels for a game.

use super::pretty;
use crate::console::{Console, Stopwatch};
use crate::failure::{Answer, Failure};
use crate::input;
use crate::input::game_input::GameInput;
use crate::protected;
use base::MessagePath;
use base::Seed;
use engine::{Analysis, Game, Level, SpriteType};
use forge::Progress;
use forge::levels::report::{LevelSetReport, Sample};
use forge::levels::{LevelOrder, LevelSet, LevelsError, MadeLevel, Method, make_levels, unconstrained_pool};
use forge::survey::LevelSurvey;
use generators::levels::{Examples, LevelConfig};
use indicatif::ProgressBar;
use serde_json::json;
use snapshots::Draft;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;
use validators::{Criterion, Difficulty, RuleRef};

/// Makes new levels for a game. The same flags give the same bytes, on any number of threads.
///
/// `search` and `evolutionary` levels come with a winning episode. Doing nothing never wins them, and random keys
/// rarely do. `constructive` levels are generated instantly and are not judged, unless you request a property that has
/// to be measured: a difficulty, a length or a rule. The folder contains the game, its new levels, and levels.json with
/// facts about each level; `arcade validate DIR` and `arcade play DIR` accept it directly. The folder is either
/// complete or absent.
///
/// Exit status 0: all requested levels were made. 1: fewer, or none. 2: the game or a flag is malformed.
///
/// Example: arcade generate levels --game hailglass --method search --count 5 --difficulty hard --out new-levels
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, a level beside its game, or the name of a corpus game
    #[arg(long, value_name = "GAME")]
    game: String,
    /// constructive: instant; search: each level improved step by step; evolutionary: an archive of different levels
    #[arg(long, value_name = "METHOD", default_value = "search")]
    method: Method,
    /// Number of levels
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    count: u32,
    /// Text to derive the seeds from
    #[arg(long, value_name = "TEXT", default_value = "levels")]
    seed: String,
    /// Difficulty, as measured by a ladder of players: very_easy, easy, medium, hard, very_hard
    #[arg(long, value_name = "LABEL")]
    difficulty: Option<Difficulty>,
    /// Columns and rows, including the border, such as 12x9. By default, sizes similar to those of the game's
    /// own levels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(usize, usize)>,
    /// Minimum number of ticks in the shortest win found
    #[arg(long, value_name = "TICKS")]
    min_solution: Option<usize>,
    /// A rule that the win must use, given by its two sprites (`box hole`), with the effect if necessary, or
    /// by its line in the InteractionSet, counted from 1. May be repeated
    #[arg(long, value_name = "RULE")]
    uses: Vec<String>,
    /// Exact number of sprites of a type, such as `box=3`. May be repeated
    #[arg(long, value_name = "TYPE=N", value_parser = count)]
    with: Vec<(String, usize)>,
    /// Judge the levels again, and write a report to this folder (new or empty): report.html, report.json, sheet.png
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Load the game as the reference engine does, and tolerate the faults that it tolerates
    #[arg(long)]
    as_reference: bool,
    /// Output folder for the levels (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Parses a board size such as `12x9`.
pub(in crate::verbs::games) fn size(text: &str) -> Result<(usize, usize), String> {
    let sides = text.split_once(['x', 'X']);
    let sides = sides.and_then(|(columns, rows)| Some((columns.parse().ok()?, rows.parse().ok()?)));
    sides.ok_or_else(|| "expected columns and rows with an x between them, such as 12x9".to_owned())
}

/// Parses a type and its number of sprites, such as `box=3`.
fn count(text: &str) -> Result<(String, usize), String> {
    let parts = text
        .split_once('=')
        .and_then(|(name, count)| Some((name.trim().to_owned(), count.trim().parse().ok()?)));
    parts.ok_or_else(|| "expected a sprite type and a number, such as box=3".to_owned())
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let input = input::game(&args.game)?;
    let game = input.compile(args.as_reference)?;
    let examples = input.checked_levels(&game)?;
    let order = order(args, &examples, &game)?;
    // Check the output path before minutes of work.
    let draft = protected::draft(&args.out)?;
    let report_draft = args.report.as_deref().map(protected::draft).transpose()?;
    let bar = Bar(console.progress(u64::from(args.count), "levels"));
    let started = Stopwatch::start();
    let seed = Seed::from_text(&args.seed).child(args.method.name(), 0);
    let made = make_levels(&game, &order, seed, &bar);
    bar.0.finish_and_clear();
    let set = match made {
        Ok(set) => set,
        Err(error @ (LevelsError::NoneAccepted { .. } | LevelsError::NoBoard(_))) => {
            let advice = match error {
                LevelsError::NoBoard(_) => "; request fewer sprites (--with), or larger boards (--size)",
                _ => "",
            };
            console.document(&json!({ "levels": [], "reason": error.to_string() }))?;
            console.remark(format_args!("{}: {error}{advice}", args.game));
            return Ok(false);
        }
        Err(error) => bail!("{}: {error}", args.game),
    };
    write(&draft, &input, &set)?;
    draft.write("levels.json", &pretty(&document(args, &game, &set))?)?;
    draft.commit()?;
    let seconds = started.seconds();
    if let Some(report_draft) = report_draft {
        let bar = console.progress(0, "report");
        report(args, report_draft, &game, &order, &examples, &set, seconds)?;
        bar.finish_and_clear();
    }
    console.document(&document(args, &game, &set))?;
    console.say(summary(args, &set, seconds).trim_end());
    Ok(set.levels.len() == args.count as usize)
}

fn order(args: &Args, examples: &[Level], game: &Game) -> Result<LevelOrder, Failure> {
    let config = Examples::of(game, examples)
        .map_or_else(LevelConfig::default, |examples| LevelConfig::like(Arc::new(examples)));
    let config = match args.size {
        Some((columns, rows)) => LevelConfig { columns: (columns, columns), rows: (rows, rows), ..config },
        None => config,
    };
    let analysis = Analysis::of(game);
    let rule = |text: &String| RuleRef::parse(&analysis, text);
    let uses = args.uses.iter().map(rule).collect::<Result<_, _>>();
    let uses = uses.map_err(|error| malformed!("--uses: {error}"))?;
    let counts = args.with.iter().map(|(name, count)| Ok((stype(game, name)?, *count)));
    let counts = counts.collect::<Result<_, Failure>>()?;
    Ok(LevelOrder {
        difficulty: args.difficulty,
        min_solution: args.min_solution,
        uses,
        ..LevelOrder::new(args.method, args.count, LevelConfig { counts, ..config })
    })
}

fn stype(game: &Game, name: &str) -> Result<SpriteType, Failure> {
    game.sprite_type(name).ok_or_else(|| {
        let near = engine::nearest(name, game.sprite_types().map(|stype| game.name(stype)));
        let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        malformed!("--with: the game has no sprite type `{name}`{help}")
    })
}

/// The number of levels that are generated without a requested difficulty, for comparison.
const POOL: u32 = 60;

/// Judges the levels again, and writes the report on them.
fn report(
    args: &Args,
    draft: Draft,
    game: &Game,
    order: &LevelOrder,
    examples: &[Level],
    set: &LevelSet,
    seconds: f64,
) -> Result<(), Failure> {
    let analysis = Analysis::of(game);
    let seed = Seed::from_text(&args.seed).child("report", 0);
    let survey =
        LevelSurvey::new(&analysis, &order.criteria, seed.child("survey", 0)).map_err(Failure::malformed)?;
    let plain = |levels: &[Level]| levels.iter().map(|level| (level.clone(), None)).collect::<Vec<_>>();
    let levels: Vec<Level> = set.levels.iter().map(|made| made.level.clone()).collect();
    let asked: Vec<_> = levels.iter().map(|level| (level.clone(), args.difficulty)).collect();
    let pool = match args.difficulty {
        Some(_) => unconstrained_pool(game, &order.config, POOL, seed.child("pool", 0))
            .map_err(Failure::malformed)?,
        None => Vec::new(),
    };
    let pool = survey.judge(&plain(&pool));
    // Only levels that meet the criteria are labelled, because the generator chooses from such levels only.
    let fit = pool.iter().filter(|judged| judged.report.passes());
    let pool: Vec<Difficulty> = fit.filter_map(|judged| judged.label()).collect();
    let report = LevelSetReport::of(&Sample {
        analysis: &analysis,
        method: args.method.name(),
        levels: &survey.judge(&asked),
        examples: &survey.judge(&plain(examples)),
        pool: &pool,
        cost: &set.tally,
    });
    let made = (args.game.as_str(), args.method.name(), Some(seconds));
    protected::publish(draft, pages::level_report(&report, &analysis, [&levels, examples], made)?)?;
    Ok(())
}

struct Bar(ProgressBar);

impl Progress for Bar {
    fn looked(&self) {
        self.0.tick();
    }

    fn made(&self, _what: &str) {
        self.0.inc(1);
    }
}

/// Writes the game, its levels and the winning episodes.
fn write(draft: &Draft, input: &GameInput, set: &LevelSet) -> Result<(), Failure> {
    draft.write("game.vgdl", input.source.text.as_bytes())?;
    for (number, made) in set.levels.iter().enumerate() {
        let text = made.level.to_string();
        draft.write(&format!("lvl{number}.txt"), text.as_bytes())?;
        if let Some(witness) = made.report.as_ref().and_then(|report| report.witness.as_ref()) {
            let path = format!("witness/lvl{number}.json");
            draft.write(&path, &pretty(witness)?)?;
        }
    }
    Ok(())
}

/// Returns the machine-readable answer. The same flags give the same bytes.
fn document(args: &Args, game: &Game, set: &LevelSet) -> serde_json::Value {
    let levels: Vec<serde_json::Value> = set.levels.iter().enumerate().map(level).collect();
    json!({
        "game": game.digest(),
        "method": args.method,
        "seed": args.seed,
        "asked": {
            "count": args.count,
            "difficulty": args.difficulty,
            "size": args.size,
            "min_solution": args.min_solution,
            "uses": args.uses,
            "with": args.with,
        },
        "generation": generators::GENERATION,
        "semantics": engine::SEMANTICS,
        "levels": levels,
        "cost": set.tally.level_cost(),
    })
}

fn level((number, made): (usize, &MadeLevel)) -> serde_json::Value {
    let witness = made.report.as_ref().and_then(|report| report.witness.as_ref());
    let optimal = made.report.as_ref().and_then(|report| report.finding(Criterion::Winnable)?.optimal);
    json!({
        "file": format!("lvl{number}.txt"),
        "number": made.number,
        "digest": made.level.digest(),
        "columns": made.level.columns(),
        "rows": made.level.rows(),
        "witness_ticks": witness.map(|witness| witness.actions.len()),
        "optimal_ticks": optimal,
        "difficulty": made.ladder.as_ref().map(|ladder| ladder.difficulty),
        "ease": made.ladder.as_ref().and_then(|ladder| ladder.ease),
        "report": made.report,
    })
}

/// Returns the summary of the generated levels that the terminal shows.
fn summary(args: &Args, set: &LevelSet, seconds: f64) -> String {
    let mut text = String::new();
    for (number, made) in set.levels.iter().enumerate() {
        let _ = writeln!(text, "lvl{number}.txt  {}", remark(&made.level, made));
        for row in made.level.to_string().lines() {
            let _ = writeln!(text, "    {row}");
        }
        text.push('\n');
    }
    let (made, asked, cost) = (set.levels.len(), args.count, &set.tally);
    let (looks, judged, millions) = (cost.looks(), cost.levels_tried, cost.calls as f64 / 1e6);
    let _ = writeln!(
        text,
        "{made} of {asked} levels in {seconds:.1} s; {looks} candidates inspected, {judged} judged; {millions:.1} million forward-model calls"
    );
    let missing = asked as usize - made;
    if !cost.rejections.is_empty() {
        let _ = writeln!(text, "rejected by inspections or judges: {}", cost.reasons());
    }
    if missing > 0 {
        let _ = writeln!(text, "{missing} could not be made: request fewer levels, or use a different seed");
    }
    let out = args.out.in_message();
    let _ = writeln!(text, "in {out}; view: arcade render {out} 0 -o level.png, play: arcade play {out} 0");
    text
}

fn remark(level: &Level, made: &MadeLevel) -> String {
    let size = format!("{}x{}", level.columns(), level.rows());
    let Some(report) = &made.report else { return format!("{size}, not judged") };
    let ticks = report.witness.as_ref().map_or(0, |witness| witness.actions.len());
    let optimal = report.finding(Criterion::Winnable).is_some_and(|finding| finding.optimal.is_some());
    let proved = if optimal { ", proven minimal" } else { "" };
    let hard = made.ladder.as_ref().map_or(String::new(), |ladder| format!("; {}", ladder.difficulty));
    format!("{size}, won in {}{proved}{hard}", base::count(ticks, "tick"))
}
