//! The client's only source of time.

use std::time::{Duration, Instant, SystemTime};

/// A source of time. Tests provide a clock that advances on command.
pub trait Clock: Send + Sync {
    /// Returns the time since a fixed moment. Successive results never decrease.
    fn elapsed(&self) -> Duration;

    /// Returns the current date, for comparison with dates sent by servers.
    fn date(&self) -> SystemTime;

    /// Blocks for the given time.
    fn sleep(&self, time: Duration);
}

/// The machine's system clock.
#[derive(Debug)]
pub struct SystemClock {
    start: Instant,
}

impl SystemClock {
    /// Creates a clock that starts at zero.
    #[expect(
        clippy::disallowed_methods,
        reason = "waits and latencies are reported, but never affect an action"
    )]
    pub fn start() -> SystemClock {
        SystemClock { start: Instant::now() }
    }
}

impl Clock for SystemClock {
    fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    #[expect(clippy::disallowed_methods, reason = "a server may state as a date how long to wait")]
    fn date(&self) -> SystemTime {
        SystemTime::now()
    }

    fn sleep(&self, time: Duration) {
        std::thread::sleep(time);
    }
}
