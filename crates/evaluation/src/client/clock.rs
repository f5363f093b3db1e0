//! The client's only source of time.

use std::time::{Duration, Instant, SystemTime};

/// A source of time. Tests provide a clock that advances on command.
pub trait Clock: Send + Sync {
    /// Returns the time since a fixed moment. The returned time never decreases.
    fn elapsed(&self) -> Duration;

    /// Returns the current date, for comparison with the dates that servers send.
    fn date(&self) -> SystemTime;

    /// Blocks for the given time.
    fn sleep(&self, time: Duration);
}

/// The clock of this machine.
#[derive(Debug)]
pub struct SystemClock {
    start: Instant,
}

impl SystemClock {
    /// Creates a clock whose elapsed time starts at zero now.
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
