//! The size and the seeds of randomised tests.
//!
//! An ordinary run takes a tenth of the cases, from fixed seeds; `cargo xtask sweep` takes all of them, from a fresh seed, which it
//! puts into [`VARIABLE`] and prints. Those tests that ask for [`many_cases`] take as many times more as it says.

use base::Seed;

/// The environment variable that asks for a sweep; its value is the seed.
pub const VARIABLE: &str = "ARCADE_SWEEP";

/// The environment variable with the factor of [`many_cases`].
pub const TIMES: &str = "ARCADE_SWEEP_TIMES";

/// Returns [`cases`], in a sweep as many times as [`TIMES`] says.
///
/// # Panics
///
/// If that is no number.
pub fn many_cases(full: usize) -> usize {
    let times = fresh().and_then(|_| std::env::var_os(TIMES)?.into_string().ok());
    cases(full) * times.map_or(1, |times| times.parse().expect("a number of times"))
}

/// Returns the number of cases to run, of those in a full sweep.
pub fn cases(full: usize) -> usize {
    if fresh().is_some() { full } else { full.div_ceil(10) }
}

/// Returns the seed of a randomised test: the same in every ordinary run, another one in every sweep.
pub fn seed(purpose: &str) -> Seed {
    match fresh() {
        Some(text) => Seed::from_text(&text).child(purpose, 0),
        None => Seed::from_text(purpose),
    }
}

/// Returns `true` in a sweep.
pub fn is_full() -> bool {
    fresh().is_some()
}

fn fresh() -> Option<String> {
    std::env::var_os(VARIABLE)?.into_string().ok()
}
