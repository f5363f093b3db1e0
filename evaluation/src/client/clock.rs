//! Time as the client needs it, and the only place of the client that reads a clock.

use std::time::{Duration, Instant, SystemTime};

/// Time that passes. Tests bring their own, which passes when it is told to.
pub trait Clock: Send + Sync {
    /// Time since a fixed moment; it never goes back.
    fn elapsed(&self) -> Duration;

    /// The date, which a server's dates are compared with.
    fn date(&self) -> SystemTime;

    /// Returns when this time has passed.
    fn sleep(&self, time: Duration);
}

/// The machine's clock.
#[derive(Debug)]
pub struct SystemClock {
    start: Instant,
}

impl SystemClock {
    /// A clock that counts from now.
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
