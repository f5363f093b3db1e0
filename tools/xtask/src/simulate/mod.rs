//! `cargo xtask simulate` measures three properties of reports: how often intervals contain the true value,
//! how often tests err, and whether the stated power is correct.

mod memory;
mod scale;

use rayon::prelude::*;
use report::{Table, TableCell};
use statistics::simulation::{Episodes, Simulation};
use statistics::{Design, Spread};

/// Simulates evaluations under the model of `arcade evaluate --dry-run`, and prints tables in Markdown.
///
/// The same seed gives the same tables. At the default size, each of the first three tables takes about a minute on
/// two cores. The tables about the scale (link, ability, drift, adaptive) take 15 to 25 minutes each on one core.
///
/// Example: cargo xtask simulate coverage --trials 1000
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The question to answer
    #[arg(value_enum)]
    question: Question,
    /// Number of simulated evaluations per figure [default: 4000; 50 to 200 for the scale, which has many players]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    trials: Option<u64>,
    /// Seed
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Question {
    /// Coverage of nominal 95% intervals of win rates
    Coverage,
    /// False positives: equal players reported as different
    Comparisons,
    /// Power: different players reported as different, as stated and as simulated
    Power,
    /// Players that replay published solutions: how often exact tests of memory flag them
    Memory,
    /// The scale: errors of a month's position relative to the month before
    Link,
    /// The scale: errors and coverage of abilities
    Ability,
    /// The scale: a drift of difficulty for readers, as measured with anchors
    Drift,
    /// The scale: the number of episodes that an adaptive choice of levels needs
    Adaptive,
}

impl Args {
    /// Returns the number of simulated evaluations per figure in the first three tables.
    fn evaluations(&self) -> u64 {
        self.trials.unwrap_or(4000)
    }
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let table = match args.question {
        Question::Coverage => coverage(args),
        Question::Comparisons => comparisons(args),
        Question::Power => power(args),
        Question::Memory => memory::memory(args),
        Question::Link => scale::link(args),
        Question::Ability => scale::ability(args),
        Question::Drift => scale::drift(args),
        Question::Adaptive => scale::adaptive(args),
    };
    print!("{}", table.to_markdown());
    Ok(())
}

/// Returns one table row per case in `cases`. The rows are computed in parallel, each with its own random-number
/// stream.
fn rows<T: Copy + Sync>(
    args: &Args,
    cases: &[T],
    row: impl Fn(T, u64) -> Vec<TableCell> + Sync,
) -> Vec<Vec<TableCell>> {
    cases.par_iter().enumerate().map(|(at, case)| row(*case, args.seed * 1_000_003 + at as u64)).collect()
}

fn share(value: f64) -> TableCell {
    TableCell::number(value, 3)
}

fn coverage(args: &Args) -> Table {
    let mut cases = Vec::new();
    for rate in [0.07, 0.2, 0.5, 0.9] {
        cases.extend([6, 12, 18, 30, 60, 120].map(|games| (rate, games)));
    }
    let note = format!(
        "{} evaluations each, of 5 levels per game and 5 runs per level; standard deviation of games 1.3, \
         of levels 1.0 logit.",
        args.evaluations()
    );
    let columns =
        ["true win rate", "games", "over games (reports)", "bootstrap of games", "episodes as independent"];
    let mut table = Table::new("coverage", "Coverage of nominal 95% intervals", &note, &columns);
    table.rows = rows(args, &cases, |(rate, games), seed| {
        let spread = Spread { matches: 0.0, ..Spread::default() };
        let design = Design { games, levels: 5, runs: 5 };
        let found = Simulation::new(design, spread, seed).coverage(rate, args.evaluations());
        let (rate, games) = (TableCell::number(rate, 2), TableCell::Count(games));
        vec![rate, games, share(found.over_games), share(found.bootstrap), share(found.episodes)]
    });
    table
}

fn comparisons(args: &Args) -> Table {
    let mut cases = Vec::new();
    for (matches, episodes) in [
        (0.0, Episodes::Independent),
        (0.7, Episodes::Independent),
        (1.2, Episodes::Independent),
        (0.0, Episodes::Copies),
        (1.2, Episodes::Copies),
    ] {
        for rate in [0.07, 0.5] {
            cases.extend([6, 18, 60].map(|games| (matches, episodes, rate, games)));
        }
    }
    let note = format!(
        "{} pairs of equal players each, on 5 levels per game, with 5 runs per level; the match of player \
         and game in logits.",
        args.evaluations()
    );
    let columns =
        ["match", "episodes", "win rate", "games", "paired over games (reports)", "exact, within levels"];
    let mut table = Table::new("comparisons", "Equal players distinguished at 5%", &note, &columns);
    table.rows = rows(args, &cases, |(matches, episodes, rate, games), seed| {
        let spread = Spread { matches, ..Spread::default() };
        let design = Design { games, levels: 5, runs: 5 };
        let found = Simulation::new(design, spread, seed).detections([rate; 2], episodes, args.evaluations());
        let kind = match episodes {
            Episodes::Independent => "independent",
            Episodes::Copies => "copies of the first",
        };
        let (over, within) = (share(found.over_games), share(found.within_levels));
        let (matches, rate) = (TableCell::number(matches, 1), TableCell::number(rate, 2));
        vec![matches, TableCell::text(kind), rate, TableCell::Count(games), over, within]
    });
    table
}

fn power(args: &Args) -> Table {
    let designs = [(6, 5, 5), (6, 5, 1), (18, 5, 3), (30, 5, 1), (30, 1, 5), (60, 1, 1), (120, 5, 1)];
    let mut cases = Vec::new();
    for (games, levels, runs) in designs {
        let design = Design { games, levels, runs };
        for base in [0.1, 0.3] {
            for power in [0.5, 0.8] {
                let other = design.detectable(base, Spread::default(), 0.05, power);
                cases.extend(other.map(|other| (design, [other, base])));
            }
        }
    }
    let note = format!(
        "{} pairs of players each; standard deviation of games 1.3, of levels 1.0, of the match of player and game 0.9 logit.",
        args.evaluations()
    );
    let columns = ["games", "levels", "runs", "episodes", "win rate", "against", "stated power", "simulated"];
    let mut table = Table::new("power", "Power at 5%, stated and simulated", &note, &columns);
    table.rows = rows(args, &cases, |(design, rates), seed| {
        let stated = design.power(rates, Spread::default(), 0.05);
        let mut simulation = Simulation::new(design, Spread::default(), seed);
        let found = simulation.detections(rates, Episodes::Independent, args.evaluations());
        let Design { games, levels, runs } = design;
        let sizes = [games, levels, runs, design.episodes()].map(TableCell::Count);
        let rates = rates.map(|rate| TableCell::number(rate, 2));
        sizes.into_iter().chain(rates).chain([share(stated), share(found.over_games)]).collect()
    });
    table
}
