//! The number of threads, and the memory of their searches. No output depends on them.

use crate::console;
use crate::failure::Failure;
use crate::memory::Bytes;
use agents::search::bound_memory;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::sync::Once;
use std::thread::available_parallelism;

/// The most threads of a pool: more would only wait for each other, and starting thousands takes minutes.
const MAX_THREADS: usize = 256;

/// Guards the warning about [`MAX_THREADS`]: a verb may ask for several pools.
static WARNED: Once = Once::new();

/// Starts the threads for verbs without `--jobs`. By default, the library would start as many as `RAYON_NUM_THREADS`
/// says, without a limit.
pub(crate) fn start() -> Result<(), Failure> {
    ThreadPoolBuilder::new().num_threads(usual()).build_global().map_err(failure)
}

/// Runs the work on this number of threads; by default on one for each core.
pub(crate) fn in_pool<T: Send>(jobs: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    if jobs == Some(0) {
        bail!("--jobs takes a number of threads, at least 1");
    }
    if let Some(jobs) = jobs.filter(|&jobs| jobs > MAX_THREADS) {
        WARNED.call_once(|| {
            console::warn(format_args!("--jobs {jobs} exceeds the limit: using {MAX_THREADS} threads"));
        });
    }
    let pool: Result<ThreadPool, _> =
        ThreadPoolBuilder::new().num_threads(jobs.map_or_else(usual, |jobs| jobs.min(MAX_THREADS))).build();
    Ok(pool.map_err(failure)?.install(work))
}

/// Bounds the memory of the searches of this number of threads together, if the user does. Asked before any work begins.
pub(crate) fn bound_searches(jobs: Option<usize>, memory: Option<Bytes>) -> Result<(), Failure> {
    let Some(Bytes(bytes)) = memory else { return Ok(()) };
    let threads = jobs.map_or_else(usual, |jobs| jobs.clamp(1, MAX_THREADS));
    bound_memory(bytes, threads)
        .map_err(|too_little| malformed!("--memory: {too_little}; give more, or fewer threads with --jobs"))
}

/// Returns the number of threads if the user gives none.
fn usual() -> usize {
    #[expect(
        clippy::disallowed_methods,
        reason = "only the number of threads depends on it, and no output on that"
    )]
    let wanted = std::env::var("RAYON_NUM_THREADS").ok();
    let cores = available_parallelism().map_or(1, usize::from);
    bounded(wanted.as_deref(), cores)
}

/// Returns the wanted number if it is sensible, or else a thread for each core.
fn bounded(wanted: Option<&str>, cores: usize) -> usize {
    let wanted =
        wanted.and_then(|text| text.parse().ok()).filter(|wanted| (1..=MAX_THREADS).contains(wanted));
    wanted.unwrap_or(cores).clamp(1, MAX_THREADS)
}

fn failure(error: ThreadPoolBuildError) -> Failure {
    Failure::environment(error, "threads cannot be started")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_sensible_numbers_of_threads_are_honoured() {
        for (wanted, cores, expect) in [
            (None, 2, 2),
            (Some("5"), 2, 5),
            (Some("0"), 2, 2),
            (Some("many"), 2, 2),
            (Some("999999999999"), 2, 2),
            (Some("257"), 4, 4),
            (None, 5000, MAX_THREADS),
        ] {
            assert_eq!(bounded(wanted, cores), expect, "{wanted:?} on {cores} cores");
        }
    }

    #[test]
    fn thread_counts_are_bounded() {
        let threads = in_pool(Some(5000), rayon::current_num_threads).expect("started");
        assert_eq!(threads, MAX_THREADS);
    }
}
