//! `cargo xtask agreement` prints random inputs for the functions in `statistics`, with their results.
//! `tools/scripts/agreement.py` compares the results with those of other libraries.

mod scale;

use base::{Sampler, Seed};
use serde_json::{Value, json};
use statistics::{
    Power, Stratum, Z95, benjamini_hochberg, cohens_h, correlation_p, difference, fisher, paired_over_games,
    pearson, quantile, rate_over_games, spearman, stratified, student_p, student_quantile, welch, wilson,
};

/// Prints random inputs of the statistical functions used in reports, with their results, as one line of JSON
/// per input.
///
/// The same seed gives the same lines.
///
/// With --scale, prints simulated months with their calibration, for tools/scripts/scale.py.
///
/// Example: cargo xtask agreement | python3 tools/scripts/agreement.py
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Total number of inputs
    #[arg(long, value_name = "N", default_value_t = 5000)]
    cases: u64,
    /// Seed
    #[arg(long, value_name = "TEXT", default_value = "agreement")]
    seed: String,
    /// Print the calibration of a scale instead
    #[arg(long, conflicts_with = "cases")]
    scale: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let seed = Seed::from_text(&args.seed);
    if args.scale {
        println!("{}", scale::calibration(seed.sampler().bits())?);
        return Ok(());
    }
    for case in 0..args.cases {
        let mut draws = seed.child("case", case).sampler();
        let functions: [fn(&mut Sampler) -> Value; 14] = [
            of_wilson,
            of_difference,
            of_fisher,
            of_stratified,
            of_correction,
            of_cohens_h,
            of_quantile,
            of_welch,
            of_pearson,
            of_spearman,
            of_student,
            of_power,
            of_rate_over_games,
            of_paired_over_games,
        ];
        println!("{}", functions[(case % functions.len() as u64) as usize](&mut draws));
    }
    Ok(())
}

/// Draws an integer from 0 to `most` inclusive.
fn up_to(draws: &mut Sampler, most: u64) -> u64 {
    draws.below(most as usize + 1) as u64
}

/// Draws a fraction from the range 0..1.
fn share(draws: &mut Sampler) -> f64 {
    draws.unit()
}

/// Draws a number of successes and a number of trials, which is at least one.
fn counts(draws: &mut Sampler) -> (u64, u64) {
    let trials = 1 + up_to(draws, 60);
    (up_to(draws, trials), trials)
}

/// Draws a list of numbers. In half of the lists, many numbers are equal.
fn numbers(draws: &mut Sampler, count: u64) -> Vec<f64> {
    let coarse = draws.below(2) == 0;
    (0..count).map(|_| if coarse { up_to(draws, 6) as f64 } else { share(draws) * 20.0 - 5.0 }).collect()
}

fn of_wilson(draws: &mut Sampler) -> Value {
    let (won, of) = counts(draws);
    let found = wilson(won, of, Z95);
    json!({ "function": "wilson", "input": [won, of], "output": [found.low, found.high] })
}

fn of_difference(draws: &mut Sampler) -> Value {
    let ((a, m), (b, n)) = (counts(draws), counts(draws));
    let found = difference([a, b], [m, n], Z95);
    json!({ "function": "difference", "input": [a, m, b, n], "output": [found.low, found.high] })
}

fn of_fisher(draws: &mut Sampler) -> Value {
    let ((a, m), (b, n)) = (counts(draws), counts(draws));
    json!({ "function": "fisher", "input": [a, m, b, n], "output": fisher([a, b], [m, n]) })
}

fn of_stratified(draws: &mut Sampler) -> Value {
    let strata: Vec<[u64; 4]> = (0..1 + up_to(draws, 9))
        .map(|_| {
            let [m, n] = [1 + up_to(draws, 8), 1 + up_to(draws, 8)];
            [up_to(draws, m), m, up_to(draws, n), n]
        })
        .collect();
    let of = |[a, m, b, n]: &[u64; 4]| Stratum { successes: [*a, *b], trials: [*m, *n] };
    let found = stratified(&strata.iter().map(of).collect::<Vec<Stratum>>());
    let ratio = found.odds_ratio.filter(|ratio| ratio.is_finite());
    json!({ "function": "stratified", "input": strata, "output": [found.p, ratio] })
}

fn of_correction(draws: &mut Sampler) -> Value {
    let count = 1 + up_to(draws, 40);
    let p: Vec<f64> = (0..count).map(|_| share(draws) * share(draws)).collect();
    json!({ "function": "benjamini_hochberg", "input": p, "output": benjamini_hochberg(&p) })
}

fn of_cohens_h(draws: &mut Sampler) -> Value {
    let [p, q] = [share(draws), share(draws)];
    json!({ "function": "cohens_h", "input": [p, q], "output": cohens_h(p, q) })
}

fn of_quantile(draws: &mut Sampler) -> Value {
    let count = 1 + up_to(draws, 40);
    let (values, at) = (numbers(draws, count), share(draws));
    json!({ "function": "quantile", "input": [values, at], "output": quantile(&values, at) })
}

fn of_welch(draws: &mut Sampler) -> Value {
    let [m, n] = [2 + up_to(draws, 20), 2 + up_to(draws, 20)];
    let (ours, theirs) = (numbers(draws, m), numbers(draws, n));
    let found = welch(&ours, &theirs).map(|test| [test.t, test.df, test.p]);
    json!({ "function": "welch", "input": [ours, theirs], "output": found })
}

fn pairs(draws: &mut Sampler) -> Vec<(f64, f64)> {
    let count = 4 + up_to(draws, 30);
    let (x, y) = (numbers(draws, count), numbers(draws, count));
    x.into_iter().zip(y).collect()
}

fn of_pearson(draws: &mut Sampler) -> Value {
    let pairs = pairs(draws);
    let found = pearson(&pairs).map(|r| [Some(r), correlation_p(r, pairs.len())]);
    json!({ "function": "pearson", "input": pairs, "output": found })
}

fn of_spearman(draws: &mut Sampler) -> Value {
    let pairs = pairs(draws);
    let found = spearman(&pairs).map(|r| [Some(r), correlation_p(r, pairs.len())]);
    json!({ "function": "spearman", "input": pairs, "output": found })
}

fn of_student(draws: &mut Sampler) -> Value {
    let (t, df) = (share(draws) * 12.0 - 6.0, 1.0 + share(draws) * 150.0);
    let p = 0.0001 + 0.9998 * share(draws);
    json!({ "function": "student", "input": [t, df, p], "output": [student_p(t, df), student_quantile(p, df)] })
}

fn of_power(draws: &mut Sampler) -> Value {
    let (trials, power) = (1 + up_to(draws, 500), 0.5 + 0.49 * share(draws));
    let found = Power { alpha: 0.05, power }.detectable_h(trials);
    json!({ "function": "power", "input": [trials, power], "output": found })
}

fn of_rate_over_games(draws: &mut Sampler) -> Value {
    let games: Vec<(u64, u64)> = (0..2 + up_to(draws, 40)).map(|_| counts(draws)).collect();
    let found =
        rate_over_games(&games, 0.95).map(|it| [it.rate, it.effective, it.interval.low, it.interval.high]);
    json!({ "function": "rate_over_games", "input": games, "output": found })
}

fn of_paired_over_games(draws: &mut Sampler) -> Value {
    let games: Vec<[f64; 2]> = (0..2 + up_to(draws, 40)).map(|_| [share(draws), share(draws)]).collect();
    let found =
        paired_over_games(&games, 0.95).map(|it| [it.difference, it.p, it.interval.low, it.interval.high]);
    json!({ "function": "paired_over_games", "input": games, "output": found })
}
