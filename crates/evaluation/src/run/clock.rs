//! Measures the duration of decisions. Durations are recorded with the results, but do not affect them.

use std::time::{Duration, Instant};

pub(crate) struct Stopwatch(Instant);

impl Stopwatch {
    #[expect(clippy::disallowed_methods, reason = "times are recorded, but no decision depends on them")]
    pub(crate) fn start() -> Stopwatch {
        Stopwatch(Instant::now())
    }

    /// Returns the time since the start.
    pub(crate) fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }

    /// Returns the time since the start in milliseconds, with a resolution of one microsecond.
    pub(crate) fn milliseconds(&self) -> f64 {
        self.0.elapsed().as_micros() as f64 / 1000.0
    }
}
