//! The time source of the client, which reads clocks nowhere else.

use std::time::{Duration, Instant, SystemTime};

/// A clock. Tests provide their own, which advances on command.
pub trait Clock: Send + Sync {
    /// Returns the time since a fixed moment, which never decreases.
    fn elapsed(&self) -> Duration;

    /// Returns the date, for comparison with the dates of servers.
    fn date(&self) -> SystemTime;

    /// Blocks for the given time.
    fn sleep(&self, time: Duration);
}

/// The machine's clock.
#[derive(Debug)]
pub struct SystemClock {
    start: Instant,
}

impl SystemClock {
    /// Creates a clock that starts now.
    #[expect(clippy::disallowed_methods, reason = "waits and latencies are told, and decide no action")]
    pub fn start() -> SystemClock {
        SystemClock { start: Instant::now() }
    }
}

impl Clock for SystemClock {
    fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    #[expect(clippy::disallowed_methods, reason = "a server may say until when to wait as a date")]
    fn date(&self) -> SystemTime {
        SystemTime::now()
    }

    fn sleep(&self, time: Duration) {
        std::thread::sleep(time);
    }
}
