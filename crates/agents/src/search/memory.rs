//! A limit on the total memory of all systematic searches in the process.
//!
//! The limit is useful if many searches run at the same time. A search that outgrows [`FREE`] waits until enough
//! memory is available for its own limit. All results are therefore the same as without the process-wide limit.

use crate::play::Stopped;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// The number of bytes that each search may use at any time.
const FREE: usize = 64 << 20;
/// The number of bytes that a process uses for purposes other than searches: rules, levels, episodes and results.
const REST: usize = 256 << 20;
/// The number of bytes that the largest typical search needs. See
/// [`SearchLimits::calls`](super::SearchLimits::calls).
const LARGEST: usize = 1 << 30;

/// The memory available to searches that outgrow [`FREE`].
#[derive(Clone, Copy)]
struct Room {
    all: usize,
    left: usize,
}

/// The memory for searches in the whole process, initially unlimited.
static ROOM: Mutex<Option<Room>> = Mutex::new(None);
/// Notified when a search returns its memory.
static GIVEN_BACK: Condvar = Condvar::new();

/// The error for a memory limit that is too small for even one large search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{threads} search threads need at least {} MiB", .least >> 20)]
pub struct TooLittle {
    /// The number of threads that may search at the same time.
    pub threads: usize,
    /// The minimum limit for this number of threads, in bytes.
    pub least: usize,
}

/// Limits this process to about `bytes` bytes of memory. At most `threads` threads are assumed to search at the same
/// time. Searches wait for each other if necessary. No result depends on the limit.
///
/// # Errors
///
/// Returns an error if the limit is too small for one 1 GiB search plus a small search on every thread.
pub fn bound(bytes: usize, threads: usize) -> Result<(), TooLittle> {
    let small = FREE.saturating_mul(threads).saturating_add(REST);
    let least = small.saturating_add(LARGEST - FREE);
    if bytes < least {
        return Err(TooLittle { threads, least });
    }
    let all = bytes - small;
    *ROOM.lock().unwrap_or_else(PoisonError::into_inner) = Some(Room { all, left: all });
    Ok(())
}

/// A memory reservation for one search, which is released on drop.
#[derive(Default)]
pub(super) struct Lease {
    bytes: usize,
    is_held: bool,
}

impl Lease {
    /// Reserves memory for a search that uses `bytes` bytes and may grow to `limit`. Waits for memory if necessary,
    /// unless the search is small or there is no process-wide limit. Returns `false` if the search was stopped while
    /// it waited.
    pub(super) fn grow(&mut self, bytes: usize, limit: usize, stopped: Stopped<'_>) -> bool {
        if self.is_held || bytes <= FREE {
            return true;
        }
        let mut room = ROOM.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            let Some(found) = room.as_mut() else {
                self.is_held = true;
                return true;
            };
            let wanted = limit.saturating_sub(FREE).min(found.all);
            if wanted <= found.left {
                found.left -= wanted;
                *self = Lease { bytes: wanted, is_held: true };
                return true;
            }
            if stopped() {
                return false;
            }
            let waited = GIVEN_BACK.wait_timeout(room, Duration::from_millis(100));
            room = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        if self.is_held {
            let mut room = ROOM.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(room) = room.as_mut() {
                room.left += self.bytes;
            }
            GIVEN_BACK.notify_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// No other test may limit the memory, because the limit applies to the whole process.
    #[test]
    fn large_searches_take_turns() {
        let never = || false;
        let least = TooLittle { threads: 4, least: (256 + 4 * 64 + 960) << 20 };
        assert_eq!(bound(1 << 30, 4), Err(least));
        bound(least.least + (100 << 20), 4).unwrap();
        let (at_once, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|threads| {
            for _ in 0..4 {
                threads.spawn(|| {
                    let mut lease = Lease::default();
                    assert!(lease.grow(FREE, LARGEST, &never), "small ones do not wait");
                    assert!(lease.grow(FREE + 1, LARGEST, &never));
                    assert!(lease.grow(2 * FREE, LARGEST, &never), "it has its room already");
                    most.fetch_max(at_once.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                    std::thread::sleep(Duration::from_millis(5));
                    at_once.fetch_sub(1, Ordering::SeqCst);
                });
            }
        });
        assert_eq!(most.into_inner(), 1);
        let mut first = Lease::default();
        assert!(first.grow(FREE + 1, LARGEST, &never));
        assert!(!Lease::default().grow(FREE + 1, LARGEST, &|| true), "nobody waits who is not waited for");
        drop(first);
        assert!(Lease::default().grow(FREE + 1, usize::MAX, &never), "more than there is: all of it");
        *ROOM.lock().unwrap() = None;
    }
}
