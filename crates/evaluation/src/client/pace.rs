//! Limits on concurrent requests, and on requests and tokens per minute.

use super::clock::Clock;
use super::options::ModelOptions;
use std::num::NonZeroU64;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::time::Duration;

/// A rate limiter. It spreads each minute's requests and tokens evenly, which also satisfies servers whose
/// limits are per second.
pub(super) struct Pace {
    clock: Arc<dyn Clock>,
    requests_per_minute: Option<NonZeroU64>,
    tokens_per_minute: Option<NonZeroU64>,
    free: Mutex<usize>,
    freed: Condvar,
    schedule: Mutex<Schedule>,
}

/// The earliest time at which the next request may start, for each limit.
#[derive(Default)]
struct Schedule {
    requests: Duration,
    tokens: Duration,
    server: Duration,
}

const MINUTE: u128 = 60_000_000_000;

/// Returns the time needed for a number of items at the given rate per minute.
fn span(things: u64, per_minute: NonZeroU64) -> Duration {
    let nanoseconds = u128::from(things) * MINUTE / u128::from(per_minute.get());
    Duration::from_nanos(nanoseconds.try_into().unwrap_or(u64::MAX))
}

impl Pace {
    /// Creates a limiter for concurrent requests, and for requests and tokens per minute.
    pub(super) fn new(options: &ModelOptions, clock: Arc<dyn Clock>) -> Pace {
        Pace {
            clock,
            requests_per_minute: options.requests_per_minute,
            tokens_per_minute: options.tokens_per_minute,
            free: Mutex::new(options.concurrency.get()),
            freed: Condvar::new(),
            schedule: Mutex::default(),
        }
    }

    /// Waits until the number of requests in flight is below the limit. A request keeps its slot between
    /// tries, so that an overloaded server receives fewer requests.
    pub(super) fn enter(&self) -> Slot<'_> {
        let free = self.free.lock().expect(NO_PANIC);
        let mut free = self.freed.wait_while(free, |free| *free == 0).expect(NO_PANIC);
        *free -= 1;
        Slot { pace: self }
    }

    /// Waits until a request of about `tokens` tokens may start.
    pub(super) fn wait(&self, tokens: u64) {
        let now = self.clock.elapsed();
        let mut schedule = self.schedule();
        let begin = now.max(schedule.requests).max(schedule.tokens).max(schedule.server);
        if let Some(limit) = self.requests_per_minute {
            schedule.requests = begin.saturating_add(span(1, limit));
        }
        if let Some(limit) = self.tokens_per_minute {
            schedule.tokens = begin.saturating_add(span(tokens, limit));
        }
        drop(schedule);
        if begin > now {
            self.clock.sleep(begin - now);
        }
    }

    /// Corrects the schedule after a request admitted with `expected` tokens turns out to have used `taken`
    /// tokens.
    pub(super) fn correct(&self, expected: u64, taken: u64) {
        if let Some(limit) = self.tokens_per_minute {
            let mut schedule = self.schedule();
            let more = schedule.tokens.saturating_add(span(taken.saturating_sub(expected), limit));
            schedule.tokens = more.saturating_sub(span(expected.saturating_sub(taken), limit));
        }
    }

    /// Delays all requests by the wait that the server requested.
    pub(super) fn delay_all(&self, time: Duration) {
        let until = self.clock.elapsed().saturating_add(time);
        let mut schedule = self.schedule();
        schedule.server = schedule.server.max(until);
    }

    fn schedule(&self) -> MutexGuard<'_, Schedule> {
        self.schedule.lock().expect(NO_PANIC)
    }
}

const NO_PANIC: &str = "nothing panics while it holds this lock";

/// A slot for a request in flight, released on drop.
#[must_use]
pub(super) struct Slot<'a> {
    pace: &'a Pace,
}

impl Drop for Slot<'_> {
    fn drop(&mut self) {
        *self.pace.free.lock().expect(NO_PANIC) += 1;
        self.pace.freed.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroUsize;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::SystemTime;

    /// A clock that advances only during sleep.
    #[derive(Default)]
    struct FakeClock(Mutex<Duration>);

    impl Clock for FakeClock {
        fn elapsed(&self) -> Duration {
            *self.0.lock().unwrap()
        }
        fn date(&self) -> SystemTime {
            SystemTime::UNIX_EPOCH
        }
        fn sleep(&self, time: Duration) {
            *self.0.lock().unwrap() += time;
        }
    }

    fn pace(requests: Option<u64>, tokens: Option<u64>) -> (Pace, Arc<FakeClock>) {
        let clock = Arc::new(FakeClock::default());
        let limit = |limit: Option<u64>| limit.and_then(NonZeroU64::new);
        let options = ModelOptions {
            concurrency: NonZeroUsize::MIN,
            requests_per_minute: limit(requests),
            tokens_per_minute: limit(tokens),
            ..ModelOptions::new("")
        };
        (Pace::new(&options, clock.clone()), clock)
    }

    #[test]
    fn requests_are_spread_over_the_minute() {
        let (pace, clock) = pace(Some(30), None);
        (0..4).for_each(|_| pace.wait(1_000_000));
        assert_eq!(clock.elapsed(), Duration::from_secs(6));
    }

    #[test]
    fn tokens_are_spread_over_the_minute() {
        let (pace, clock) = pace(None, Some(6000));
        pace.wait(500);
        pace.wait(500);
        assert_eq!(clock.elapsed(), Duration::from_secs(5));
        pace.correct(500, 600);
        pace.wait(500);
        assert_eq!(clock.elapsed(), Duration::from_secs(11));
        pace.correct(500, 100);
        pace.wait(0);
        assert_eq!(clock.elapsed(), Duration::from_secs(12));
    }

    #[test]
    fn a_requested_wait_delays_all_requests() {
        let (pace, clock) = pace(None, None);
        pace.wait(1);
        assert_eq!(clock.elapsed(), Duration::ZERO);
        pace.delay_all(Duration::from_secs(9));
        pace.delay_all(Duration::from_secs(3));
        pace.wait(1);
        assert_eq!(clock.elapsed(), Duration::from_secs(9));
    }

    #[test]
    fn concurrency_is_bounded() {
        let options = ModelOptions { concurrency: NonZeroUsize::new(2).unwrap(), ..ModelOptions::new("") };
        let pace = Pace::new(&options, Arc::new(FakeClock::default()));
        let (inside, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..6 {
                scope.spawn(|| {
                    for _ in 0..50 {
                        let _slot = pace.enter();
                        most.fetch_max(inside.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                        std::thread::yield_now();
                        inside.fetch_sub(1, Ordering::SeqCst);
                    }
                });
            }
        });
        assert!(most.into_inner() <= 2);
    }
}
