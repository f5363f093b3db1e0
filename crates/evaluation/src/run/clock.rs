//! The duration of decisions, which is recorded beside the results but is never part of them.

use std::time::{Duration, Instant};

pub(crate) struct Stopwatch(Instant);

impl Stopwatch {
    #[expect(clippy::disallowed_methods, reason = "times are recorded, and nothing is decided by them")]
    pub(crate) fn start() -> Stopwatch {
        Stopwatch(Instant::now())
    }

    /// Returns the time since the start.
    pub(crate) fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }

    /// Returns the time since the start in milliseconds, to the microsecond.
    pub(crate) fn milliseconds(&self) -> f64 {
        self.0.elapsed().as_micros() as f64 / 1000.0
    }
}
