//! The sizes and seeds of randomised tests.
//!
//! An ordinary run uses a tenth of the cases, with fixed seeds. `cargo xtask sweep` uses all cases, with a
//! fresh seed that it prints and passes in [`VARIABLE`]. Tests that call [`many_cases`] multiply the number
//! of cases by [`TIMES`].

use base::Seed;

/// The environment variable that requests a sweep. Its value is the sweep's seed.
pub const VARIABLE: &str = "ARCADE_SWEEP";

/// The environment variable that contains the factor for [`many_cases`].
pub const TIMES: &str = "ARCADE_SWEEP_TIMES";

/// Returns the number of [`cases`], multiplied by [`TIMES`] in a sweep.
///
/// # Panics
///
/// Panics if the factor is not a number.
pub fn many_cases(full: usize) -> usize {
    let times = fresh().and_then(|_| std::env::var_os(TIMES)?.into_string().ok());
    cases(full) * times.map_or(1, |times| times.parse().expect("a number of times"))
}

/// Returns the number of cases to run, given the number of cases in a full sweep.
pub fn cases(full: usize) -> usize {
    if fresh().is_some() { full } else { full.div_ceil(10) }
}

/// Returns the seed for a randomised test: the same in every ordinary run, and different in every sweep.
pub fn seed(purpose: &str) -> Seed {
    match fresh() {
        Some(text) => Seed::from_text(&text).child(purpose, 0),
        None => Seed::from_text(purpose),
    }
}

/// Returns `true` during a sweep.
pub fn is_full() -> bool {
    fresh().is_some()
}

fn fresh() -> Option<String> {
    std::env::var_os(VARIABLE)?.into_string().ok()
}
