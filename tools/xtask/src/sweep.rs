//! `cargo xtask sweep` runs all tests, including the slow ones, with every case of the randomised tests.

use anyhow::{Context, bail};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// Runs all tests at full size. Randomised tests run every case with a fresh seed. The mints and recorded
/// episodes that an ordinary run skips are included.
///
/// Takes about an hour on two cores. `--seed` repeats a failure.
///
/// Example: cargo xtask sweep --seed 1764000000
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Seed of the randomised tests [default: the time]
    #[arg(long, value_name = "TEXT")]
    seed: Option<String>,
    /// Factor for the number of random games compared with and without a schedule
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    times: usize,
}

/// The environment variable that the tests read (`tests::sweep::VARIABLE`).
const VARIABLE: &str = "ARCADE_SWEEP";
/// The environment variable that contains the factor for the number of random games (`tests::sweep::TIMES`).
const TIMES: &str = "ARCADE_SWEEP_TIMES";

#[expect(
    clippy::disallowed_methods,
    reason = "the seed of a sweep is the current time; it is printed, and --seed repeats a sweep"
)]
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()).to_string();
    let seed = args.seed.clone().unwrap_or_else(now);
    println!("sweep with seed {seed}");
    let status = Command::new("cargo")
        .args(["test", "--workspace", "--locked", "--no-fail-fast"])
        .env(VARIABLE, &seed)
        .env(TIMES, args.times.to_string())
        .env("PROPTEST_CASES", "10000")
        .status()
        .context("cargo test")?;
    if !status.success() {
        bail!("a test failed; repeat it with `{VARIABLE}={seed} cargo test` and its name");
    }
    Ok(())
}
